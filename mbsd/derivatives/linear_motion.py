"""Linear equations of motion along nodes, s'' = A(t) (s, s') + B(t), by collocation of y = (s, s').

Lobatto IIIA with nine stages: a step has nodes at its ends, its middle, and between. At ends of steps it is of order
16; inside, where the polynomial of y' is integrated, of tenth. Legendre's coefficients of y' on the nodes tell the
error: where they fall as those of a smooth motion do, by the same factor from the fourth to the eighth as from there
on, the tenth is what the step leaves out inside. Source: Hairer, Wanner, Solving ODEs II, IV.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from mbsd.compiling.jit import kernel

NODES = 8
"""Nodes of a step, without its end."""
PLACES = np.concatenate([[0.0], 0.5 + 0.5 * roots_jacobi(NODES - 1, 1.0, 1.0)[0], [1.0]])
"""Nodes, as parts of a step."""
_COEFFICIENTS = np.linalg.inv(legendre.legvander(2 * PLACES - 1, NODES))
"""(order, node) Legendre's coefficients of values at the nodes."""
_INTEGRALS = 0.5 * legendre.legint(_COEFFICIENTS, lbnd=-1)
"""(order, node) those of their integral from the start, as parts of a step."""


def weights_at(places: np.ndarray) -> np.ndarray:
    """(R, 9) weights of the values at the nodes in the integral from the start to places (R,), parts of a step."""
    return legendre.legvander(2 * places - 1, NODES + 1) @ _INTEGRALS


WEIGHTS = weights_at(PLACES[1:])
"""(8, 9) those to each other node."""
TWICE = (WEIGHTS[:, None, 1:] * WEIGHTS.T[None]).reshape(-1, NODES)
"""(8 * 9, 8) weights (i n, j) in double integrals: to node i, of what is the integral to node j of a rate at node n."""
HALFWAY, LAST = _COEFFICIENTS[[NODES // 2, NODES]]
"""(9,) what makes Legendre's fourth and eighth coefficients of values at the nodes."""


@dataclass
class Carried:
    """y along d steps of nine nodes."""

    t: np.ndarray
    """(8 d + 1,) nodes (s)."""
    y: np.ndarray
    """(8 d + 1, k, c), k = 2 f, as rates, y'."""
    rates: np.ndarray
    errors: np.ndarray
    """(d,) what each step adds, as part of the largest y."""

    def at(self, times: np.ndarray) -> np.ndarray:
        """(R, k, c) y at times (R,) (s)."""
        edges = self.t[::NODES]
        step = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(edges) - 2)
        length = edges[step + 1] - edges[step]
        weights = length[:, None] * weights_at((times - edges[step]) / length)
        return self.y[NODES * step] + np.einsum("rn,rnkc->rkc", weights, self.rates[_nodes_of(step)])


def carried(t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray, slight: np.ndarray) -> Carried:
    """y at nodes t (8 d + 1,) (s) from ``begun`` (2 f, c), and beyond.

    a (8 d + 1, f, 2 f), b (8 d + 1, f, c). Errors are parts of the largest y, or of ``slight`` (2 f, c)
    if that is more.
    """
    out = np.zeros((len(t), *begun.shape))
    out[0] = begun
    chain(_steps(t, a, b), out)
    rates = np.concatenate([out[:, b.shape[1] :], a @ out + b], axis=1)
    parts = rates / np.maximum(np.abs(out).max(axis=0), slight)
    at = _nodes_of(np.arange((len(t) - 1) // NODES))
    halfway, last = (np.einsum("n,dnkc->dkc", weights, parts[at]) for weights in (HALFWAY, LAST))
    halfway, last = (np.abs(part).max(axis=(1, 2), initial=0.0) for part in (halfway, last))
    fall = np.minimum(last / np.maximum(halfway, 1e-300), 1.0)
    return Carried(t, out, rates, (t[NODES::NODES] - t[:-1:NODES]) * last * fall**1.5)


def _nodes_of(steps: np.ndarray) -> np.ndarray:
    """(d, 9) the nodes of steps (d,)."""
    return NODES * steps[:, None] + np.arange(NODES + 1)


def _steps(t: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """What makes the other nodes of every step of its start: (d, 8, 2 f, 2 f + c), a matrix and what is added.

    Solved for s' at the nodes, of which s is the integral.
    """
    f, c = b.shape[1:]
    h = (t[NODES::NODES] - t[:-1:NODES])[:, None, None, None]
    at = _nodes_of(np.arange(len(h)))
    of_s, of_rate, given = a[at][..., :f], a[at][..., f:], b[at]
    inner = (TWICE @ of_s[:, 1:].reshape(len(h), NODES, f * f)).reshape(len(h), NODES, NODES + 1, f, f)
    matrix = np.eye(NODES * f) - (
        (h[..., None] ** 2 * inner[:, :, 1:] + h[..., None] * WEIGHTS[:, 1:, None, None] * of_rate[:, None, 1:])
        .transpose(0, 1, 3, 2, 4)
        .reshape(len(h), NODES * f, NODES * f)
    )
    side = np.empty((len(h), NODES, f, 2 * f + c))
    side[..., :f] = h * np.einsum("in,dnkl->dikl", WEIGHTS, of_s)
    side[..., f : 2 * f] = np.eye(f) + h * WEIGHTS[:, 0, None, None] * of_rate[:, None, 0] + h**2 * inner[:, :, 0]
    side[..., 2 * f :] = h * np.einsum("in,dnkc->dikc", WEIGHTS, given)
    rates = np.linalg.solve(matrix, side.reshape(len(h), NODES * f, 2 * f + c)).reshape(side.shape)
    places = h * np.einsum("ij,djkc->dikc", WEIGHTS[:, 1:], rates)
    places[..., :f] += np.eye(f)
    places[..., f : 2 * f] += h * WEIGHTS[:, 0, None, None] * np.eye(f)
    return np.concatenate([places, rates], axis=2)


@kernel
def chain(maps, out):
    """Fill out (s d + 1, k, c) from its first entry by maps (d, s, k, k + c) of every step's start."""
    k, nodes = out.shape[1], maps.shape[1]
    for step in range(maps.shape[0]):
        for node in range(nodes):
            for i in range(k):
                for c in range(out.shape[2]):
                    value = maps[step, node, i, k + c]
                    for j in range(k):
                        value += maps[step, node, i, j] * out[nodes * step, j, c]
                    out[nodes * step + 1 + node, i, c] = value
