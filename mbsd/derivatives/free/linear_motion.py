"""Linear equations of motion along nodes, s'' = A(t) (s, s') + B(t), by collocation of y = (s, s').

Lobatto IIIA with nine stages: a step has nodes at its ends, its middle, and between. At ends of steps it is of order
16; inside, where the polynomial of y' is integrated, of tenth. Legendre's coefficients of y' on the nodes tell the
errors: where they fall as those of a smooth motion do, by the same factor from the fourth to the eighth as from there
on, the ninth is what the step leaves out inside, the fourteenth at its end. Both are parts of the largest y so far:
what errs while y is small grows with it. Source: Hairer, Wanner, Solving ODEs II, IV.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from mbsd.compiling.jit import internal, kernel
from mbsd.equations.products import eliminate

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
HALFWAY, LAST = _COEFFICIENTS[[NODES // 2, NODES]]
"""(9,) what makes Legendre's fourth and eighth coefficients of values at the nodes."""

LATEST = 2.0 * legendre.legval(1.0, legendre.legder(_COEFFICIENTS))
"""(9,) weights of the values at the nodes in their slope at the end, for a step of length 1."""


@dataclass
class Carried:
    """y along d steps of nine nodes."""

    t: np.ndarray
    """(8 d + 1,) nodes (s)."""
    y: np.ndarray
    """(8 d + 1, k, c), k = 2 f, as rates, y'."""
    rates: np.ndarray
    errors: np.ndarray
    """(d, 2) what each step adds, and what it leaves out inside alone, as parts of the largest y so far."""

    def at(self, times: np.ndarray) -> np.ndarray:
        """(R, k, c) y at times (R,) (s)."""
        if len(times) == 1 and times[0] == self.t[-1]:
            return self.y[-1:]
        edges = self.t[::NODES]
        step = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(edges) - 2)
        length = edges[step + 1] - edges[step]
        weights = length[:, None] * weights_at((times - edges[step]) / length)
        rates = self.rates[_nodes_of(step)]
        grown = weights[:, None] @ rates.reshape(*weights.shape, -1)
        return self.y[NODES * step] + grown.reshape(len(times), *self.y.shape[1:])

    def errors_of(self, times: np.ndarray) -> np.ndarray:
        """Return ``errors`` of y at times (R,) (s): steps without one of them inside leave out nothing there."""
        edges = self.t[::NODES]
        first = np.searchsorted(times, edges[:-1], side="right")
        inside = np.searchsorted(times, edges[1:], side="left") > first
        return np.where(inside[:, None], self.errors, self.errors * [1.0, 0.0])


def carried(t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray, slight: np.ndarray) -> Carried:
    """y at nodes t (8 d + 1,) (s) from ``begun`` (2 f, c), and beyond.

    a (8 d + 1, f, 2 f), b (8 d + 1, f, c). Errors are parts of the largest y so far, or of ``slight`` (2 f, c)
    if that is more.
    """
    f, c = b.shape[1:]
    out, rates = np.zeros((2, len(t), 2 * f, c))
    out[0] = begun
    matrix, side = np.zeros((NODES * f, NODES * f)), np.zeros((NODES * f, c))
    march(t, np.ascontiguousarray(a), np.ascontiguousarray(b), WEIGHTS, matrix, side, out, rates)
    largest = np.maximum.accumulate(np.abs(out), axis=0)[NODES::NODES]
    per = 1.0 / np.maximum(largest, slight)
    errors = np.zeros(((len(t) - 1) // NODES, 2))
    estimate(t, rates, per, HALFWAY, LAST, errors)
    return Carried(t, out, rates, errors)


def _nodes_of(steps: np.ndarray) -> np.ndarray:
    """(d, 9) the nodes of steps (d,)."""
    return NODES * steps[:, None] + np.arange(NODES + 1)


@internal
def rate_at(a, b, s, out):
    """Fill the lower half of out (2 f, c) with s'' of s (2 f, c) at one node, the upper with s'."""
    f = b.shape[0]
    for k in range(f):
        for i in range(b.shape[1]):
            out[k, i] = s[f + k, i]
            out[f + k, i] = b[k, i]
        for j in range(2 * f):
            factor = a[k, j]
            for i in range(b.shape[1]):
                out[f + k, i] += factor * s[j, i]


@internal
def fill_matrix(h, a, weights, matrix):
    """Fill matrix (8 f, 8 f) of s' at nodes 1 .. 8 of a step h; a (9, f, 2 f)."""
    f = a.shape[1]
    for i in range(NODES):
        for j in range(NODES):
            for k in range(f):
                row = matrix[i * f + k]
                for g in range(f):
                    value = h * weights[i, 1 + j] * a[1 + j, k, f + g]
                    for n in range(NODES):
                        value += h * h * weights[i, 1 + n] * weights[n, 1 + j] * a[1 + n, k, g]
                    row[j * f + g] = -value
    for r in range(NODES * f):
        matrix[r, r] += 1.0


@internal
def fill_side(h, a, b, weights, s, first, side):
    """Fill side (8 f, c) from s (2 f, c) and its rate ``first`` at node 0; a (9, f, 2 f), b (9, f, c)."""
    f = b.shape[1]
    count = b.shape[2]
    for i in range(NODES):
        for k in range(f):
            row = side[i * f + k]
            for c in range(count):
                row[c] = s[f + k, c] + h * weights[i, 0] * first[f + k, c]
            for n in range(NODES):
                weight = h * weights[i, 1 + n]
                for c in range(count):
                    row[c] += weight * b[1 + n, k, c]
                for g in range(f):
                    factor = weight * a[1 + n, k, g]
                    for c in range(count):
                        row[c] += factor * (s[g, c] + h * weights[n, 0] * s[f + g, c])


@kernel
def march(t, a, b, weights, matrix, side, out, rates):
    """Fill out and rates (8 d + 1, 2 f, c) from out[0], by ``weights`` (8, 9); matrix and side are scratch.

    a (8 d + 1, f, 2 f), b (8 d + 1, f, c). Each step is solved for s' at its nodes, of which s is the integral.
    """
    f = b.shape[1]
    for first in range(0, t.shape[0] - 1, NODES):
        h = t[first + NODES] - t[first]
        own = slice(first, first + NODES + 1)
        rate_at(a[first], b[first], out[first], rates[first])
        fill_matrix(h, a[own], weights, matrix)
        fill_side(h, a[own], b[own], weights, out[first], rates[first], side)
        eliminate(matrix, side)
        for i in range(NODES):
            node = out[first + 1 + i]
            for k in range(f):
                for c in range(side.shape[1]):
                    node[f + k, c] = side[i * f + k, c]
                    node[k, c] = out[first, k, c] + h * weights[i, 0] * out[first, f + k, c]
                for n in range(NODES):
                    weight = h * weights[i, 1 + n]
                    for c in range(side.shape[1]):
                        node[k, c] += weight * side[n * f + k, c]
            rate_at(a[first + 1 + i], b[first + 1 + i], node, rates[first + 1 + i])


@kernel
def estimate(t, rates, per, halfway, last, errors):
    """Fill errors (d, 2) of steps from rates (8 d + 1, k, c); ``per`` (d, k, c): 1 / the largest values so far."""
    for step in range(errors.shape[0]):
        first = NODES * step
        middle = 0.0
        high = 0.0
        for k in range(rates.shape[1]):
            for c in range(rates.shape[2]):
                fourth = 0.0
                eighth = 0.0
                for n in range(NODES + 1):
                    fourth += halfway[n] * rates[first + n, k, c]
                    eighth += last[n] * rates[first + n, k, c]
                middle = max(middle, abs(fourth) * per[step, k, c])
                high = max(high, abs(eighth) * per[step, k, c])
        fall = min(high / max(middle, 1e-300), 1.0)
        high *= t[first + NODES] - t[first]
        errors[step, 0] = high * fall**1.5
        errors[step, 1] = high * fall**0.25 / NODES
