"""Linear equations of motion along nodes, y' = A(t) y + B(t), by collocation.

Lobatto IIIA with five stages, of eighth order: a step has nodes at its ends, its middle, and between. Legendre's
coefficients of y' on these nodes tell the error: where they fall as those of a smooth motion do, by the same factor
from the second to the fourth as from there to the sixth and eighth, the eighth is what the step leaves out. Source:
Hairer, Wanner, Solving ODEs II, IV.5.
"""

from __future__ import annotations

import numpy as np

from mbsd.compiling.jit import kernel

NODES = 4
"""Nodes of a step, without its end."""
PLACES = np.array([0.0, 0.5 - np.sqrt(21.0) / 14, 0.5, 0.5 + np.sqrt(21.0) / 14, 1.0])
"""Nodes, as parts of a step."""
_POWERS = np.linalg.inv(np.vander(PLACES, increasing=True))
"""(power, node) of the polynomials that are 1 at a node and 0 at the others."""
WEIGHTS = (PLACES[1:, None] ** np.arange(1, 6) / np.arange(1, 6)) @ _POWERS
"""(4, 5) integrals of these from the start to each other node."""
_LEGENDRE = np.polynomial.legendre.legvander(2 * PLACES - 1, 4)
SECOND, FOURTH = np.linalg.inv(_LEGENDRE)[[2, 4]]
"""(5,) what makes Legendre's second and fourth coefficients of values at the nodes."""


def carried(
    t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray, slight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """y (4 d + 1, k, c) at nodes t (s) of d steps from ``begun`` (k, c), and the error that each adds, (d,).

    a (4 d + 1, k, k), b (4 d + 1, k, c). Errors are parts of the largest y, or of ``slight`` (k, c) if that is more.
    """
    out = np.zeros(b.shape)
    out[0] = begun
    chain(_steps(t, a, b), out)
    rates = a @ out + b
    rates /= np.maximum(np.abs(out).max(axis=0), slight)
    at = np.arange(0, len(t) - 1, NODES)[:, None] + np.arange(NODES + 1)
    second, fourth = (np.einsum("n,dnkc->dkc", weights, rates[at]) for weights in (SECOND, FOURTH))
    second, fourth = (np.abs(part).max(axis=(1, 2), initial=0.0) for part in (second, fourth))
    fall = np.minimum(fourth / np.maximum(second, 1e-300), 1.0)
    return out, (t[NODES::NODES] - t[:-1:NODES]) * fourth * fall**2


def _steps(t: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """What makes the other nodes of every step of its start: (d, 4, k, k + c), a matrix and what is added."""
    k, c = b.shape[1:]
    h = (t[NODES::NODES] - t[:-1:NODES])[:, None, None, None]
    at = np.arange(0, len(t) - 1, NODES)[:, None] + np.arange(NODES + 1)
    own, given = a[at], b[at]
    matrix = -h[..., None] * WEIGHTS[:, 1:, None, None] * own[:, None, 1:]
    matrix = matrix.transpose(0, 1, 3, 2, 4).reshape(len(h), NODES * k, NODES * k) + np.eye(NODES * k)
    side = np.zeros((len(h), NODES, k, k + c))
    side[..., :k] = np.eye(k) + h * WEIGHTS[:, 0, None, None] * own[:, None, 0]
    side[..., k:] = h * np.einsum("in,dnkc->dikc", WEIGHTS, given)
    return np.linalg.solve(matrix, side.reshape(len(h), NODES * k, k + c)).reshape(side.shape)


@kernel
def chain(maps, out):
    """Fill out (4 d + 1, k, c) from its first entry by maps (d, 4, k, k + c) of every step's start."""
    k = out.shape[1]
    for step in range(maps.shape[0]):
        for node in range(maps.shape[1]):
            for i in range(k):
                for c in range(out.shape[2]):
                    value = maps[step, node, i, k + c]
                    for j in range(k):
                        value += maps[step, node, i, j] * out[4 * step, j, c]
                    out[4 * step + 1 + node, i, c] = value
