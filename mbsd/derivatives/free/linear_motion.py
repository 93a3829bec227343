"""Linear equations of motion along nodes by collocation of y = (q, v), changes of n coordinates and k velocities.

    q' = C q + D v + e       v' = A (q, v) + b            in the plane q' = v, with n = k = f changes s of coordinates

Lobatto IIIA with nine stages: a step has nodes at its ends, its middle, and between. Coordinates at its nodes follow
from velocities there, so that a step is solved for velocities alone. At ends of steps it is of order
16; inside, where the polynomial of y' is integrated, of tenth. Legendre's coefficients of y' on the nodes tell the
errors: where they fall as those of a smooth motion do, by the same factor from the fourth to the eighth as from there
on, the ninth is what the step leaves out inside, the fourteenth at its end. Both are parts of the largest y so far:
what errs while y is small grows with it.

The rates u of the motion solve these equations, with how v' changes with time itself for b: a motion that begins later
by tau, and all that time does with it, changes by tau u. A toggle makes u a million times as large within no time, and
y with it; behind it little of y is left, in which errors of that moment remain. So what a step errs in u, which is
known, is taken from y as well, for the part tau u of it that is nearest to y. The known u err by as much, and what that
is to the rest y - tau u, or to the last y if this is more, is left as noise.

Source: Hairer, Wanner, Solving ODEs II, IV.5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, internal, kernel
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

SLOW = 1e-6
"""Part of the fastest rates of the motion below which rates are too slow to correct a step."""
CONSISTENT = 1e-4
"""Error of u in a step, as part of it, beyond which it corrects nothing: the step is too long, or u is rounding."""

LATEST = 2.0 * legendre.legval(1.0, legendre.legder(_COEFFICIENTS))
"""(9,) weights of the values at the nodes in their slope at the end, for a step of length 1."""


@dataclass
class Carried:
    """y along d steps of nine nodes."""

    t: np.ndarray
    """(8 d + 1,) nodes (s)."""
    y: np.ndarray
    """(8 d + 1, n + k, c), as rates, y'."""
    rates: np.ndarray
    errors: np.ndarray
    """(d, 3) what each step adds, and what it leaves out inside alone, as parts of the largest y so far; and the part
    of the last y that errors of the motion leave unknown."""

    def at(self, times: np.ndarray) -> np.ndarray:
        """(R, n + k, c) y at times (R,) (s)."""
        edges = self.t[::NODES]
        step = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(edges) - 2)
        length = edges[step + 1] - edges[step]
        weights = length[:, None] * weights_at((times - edges[step]) / length)
        rates = self.rates[_nodes_of(step)]
        grown = weights[:, None] @ rates.reshape(*weights.shape, -1)
        out = self.y[NODES * step] + grown.reshape(len(times), *self.y.shape[1:])
        out[times == self.t[-1]] = self.y[-1]
        return out

    def errors_of(self, times: np.ndarray) -> np.ndarray:
        """Return ``errors`` of y at times (R,) (s): steps without one of them inside leave out nothing there."""
        edges = self.t[::NODES]
        first = np.searchsorted(times, edges[:-1], side="right")
        inside = np.searchsorted(times, edges[1:], side="left") > first
        return np.where(inside[:, None], self.errors, self.errors * [1.0, 0.0, 1.0])


class SameRates(NamedTuple):
    """q' = v, as in the plane."""

    none: Any
    """(0,) nothing."""


SAME_RATES = SameRates(np.zeros(0))


class OwnRates(NamedTuple):
    """q' = C q + D v + e at T nodes."""

    matrix: Any
    """(T, n, n + k) C and D."""
    right: Any
    """(T, n, c) e."""
    gain: Any
    """(8 n, 8 k + c) scratch: q at nodes 1 .. 8 of a step by v there, and what it is without v."""
    square: Any
    """(8 n, 8 n) scratch."""


def own_rates(matrix: np.ndarray, right: np.ndarray) -> OwnRates:
    """Return q' = C q + D v + e with scratch; matrix (T, n, n + k) C and D, right (T, n, c) e."""
    n, k, c = matrix.shape[1], matrix.shape[2] - matrix.shape[1], right.shape[2]
    gain, square = np.zeros((NODES * n, NODES * k + c)), np.zeros((NODES * n, NODES * n))
    return OwnRates(np.ascontiguousarray(matrix), np.ascontiguousarray(right), gain, square)


class ByTime(NamedTuple):
    """How a motion at 8 d + 1 nodes is changed by time alone."""

    slope: np.ndarray
    """(8 d + 1, k) how v' changes with time, q and v held."""
    passing: np.ndarray
    """(8 d + 1,) True where the motion passes a toggle: there alone steps are corrected."""


def carried(
    t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray, slight: np.ndarray,
    kinematics: SameRates | OwnRates = SAME_RATES, flow: np.ndarray | None = None, by_time: ByTime | None = None,
) -> Carried:  # fmt: skip
    """Return y at nodes t (8 d + 1,) (s) from ``begun`` (n + k, c), and beyond.

    a (8 d + 1, k, n + k), b (8 d + 1, k, c). Errors are parts of the largest y so far, or of ``slight`` (n + k, c)
    if that is more. ``flow`` (8 d + 1, n + k): rates of the motion, if they correct steps (see the file), with
    ``by_time`` if time alone changes v'.
    """
    k, c = b.shape[1], begun.shape[1]
    steps = (len(t) - 1) // NODES
    if flow is None or k == 0:
        flow, passing = np.zeros((0, len(begun))), np.zeros(steps, bool)
    else:
        own = np.zeros((len(t), k)) if by_time is None else by_time.slope
        passing = _fast_steps(t, flow, k) if by_time is None else _steps_of(by_time.passing).any(axis=1)
        b = np.append(b, own[..., None], axis=2)
    corrected = passing.copy()
    out, rates = np.zeros((2, len(t), len(begun), b.shape[2]))
    out[0, :, :c] = begun
    matrix, side = np.zeros((NODES * k, NODES * k)), np.zeros((NODES * k, b.shape[2]))
    removed = np.zeros((steps, c, 2))
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    march(kinematics, t, a, b, WEIGHTS, flow, corrected, matrix, side, removed, out, rates)
    if len(flow):
        out, rates = (np.ascontiguousarray(part[..., :c]) for part in (out, rates))
    largest = np.maximum.accumulate(np.abs(out), axis=0)[NODES::NODES]
    per = 1.0 / np.maximum(largest, slight)
    errors = np.zeros((steps, 3))
    estimate(t, rates, per, HALFWAY, LAST, errors)
    last = np.linalg.norm(np.maximum(np.abs(out[-1, -k:]), slight[-k:]), axis=0)
    is_noisy = corrected if by_time is None else passing
    parts = removed[is_noisy]
    errors[is_noisy, 2] = (parts[..., 0] / np.maximum(parts[..., 1], last)).max(axis=1, initial=0.0)
    return Carried(t, out, rates, errors)


def _fast_steps(t: np.ndarray, flow: np.ndarray, k: int) -> np.ndarray:
    """Return (d,) True where ``flow`` (8 d + 1, n + k) at the start of a step are fast enough to correct it."""
    first, length = flow[:-1:NODES], np.diff(t[::NODES])
    size = (first[:, -k:] ** 2).sum(axis=1) + (first[:, :-k] ** 2).sum(axis=1) / length**2
    return size >= (SLOW * np.abs(flow[:, -k:]).max()) ** 2


def _steps_of(values: np.ndarray) -> np.ndarray:
    """Return values at nodes (8 d + 1,) step by step, (d, 9)."""
    return values[_nodes_of(np.arange((len(values) - 1) // NODES))]


def _nodes_of(steps: np.ndarray) -> np.ndarray:
    """(d, 9) the nodes of steps (d,)."""
    return NODES * steps[:, None] + np.arange(NODES + 1)


# -- coordinates by velocities, where q' = v and in general ------------------------------------------------------------


@inlined
def _same_rates(kinematics, at, s, f, out):
    for k in range(f):
        for i in range(s.shape[1]):
            out[k, i] = s[f + k, i]


@inlined
def _own_rates(kinematics, at, s, f, out):
    for m in range(kinematics.right.shape[1]):
        for i in range(s.shape[1]):
            out[m, i] = kinematics.right[at, m, i]
        for j in range(s.shape[0]):
            factor = kinematics.matrix[at, m, j]
            for i in range(s.shape[1]):
                out[m, i] += factor * s[j, i]


@inlined
def _no_gain(kinematics, h, first, weights, s, rate):
    pass


@internal
def _fill_gain(kinematics, h, first, weights, s, rate):
    matrix = kinematics.matrix
    right = kinematics.right
    gain = kinematics.gain
    square = kinematics.square
    n = right.shape[1]
    k = matrix.shape[2] - n
    for i in range(NODES):
        for m in range(n):
            row = i * n + m
            for c in range(right.shape[2]):
                gain[row, NODES * k + c] = s[m, c] + h * weights[i, 0] * rate[m, c]
            for j in range(NODES):
                weight = h * weights[i, 1 + j]
                for g in range(n):
                    square[row, j * n + g] = -weight * matrix[first + 1 + j, m, g]
                for g in range(k):
                    gain[row, j * k + g] = weight * matrix[first + 1 + j, m, n + g]
                for c in range(right.shape[2]):
                    gain[row, NODES * k + c] += weight * right[first + 1 + j, m, c]
            square[row, row] += 1.0
    eliminate(square, gain)


@inlined
def _integrated(kinematics, h, weights, a, i, n, j, k, g):
    return h * h * weights[i, 1 + n] * weights[n, 1 + j] * a[1 + n, k, g]


@inlined
def _gained(kinematics, h, weights, a, i, n, j, k, g):
    count = kinematics.right.shape[1]
    total = 0.0
    for m in range(count):
        total += a[1 + n, k, m] * kinematics.gain[n * count + m, j * a.shape[1] + g]
    return h * weights[i, 1 + n] * total


@inlined
def _start(kinematics, h, weights, s, f, n, g, c):
    return s[g, c] + h * weights[n, 0] * s[f + g, c]


@inlined
def _own_start(kinematics, h, weights, s, f, n, g, c):
    return kinematics.gain[n * f + g, kinematics.gain.shape[1] - s.shape[1] + c]


@inlined
def _integrate(kinematics, h, weights, i, s, f, side, node):
    for k in range(f):
        for c in range(side.shape[1]):
            node[k, c] = s[k, c] + h * weights[i, 0] * s[f + k, c]
        for n in range(NODES):
            weight = h * weights[i, 1 + n]
            for c in range(side.shape[1]):
                node[k, c] += weight * side[n * f + k, c]


@inlined
def _gain_coordinates(kinematics, h, weights, i, s, f, side, node):
    gain = kinematics.gain
    count = kinematics.right.shape[1]
    for m in range(count):
        row = gain[i * count + m]
        for c in range(side.shape[1]):
            node[m, c] = row[side.shape[0] + c]
        for g in range(side.shape[0]):
            for c in range(side.shape[1]):
                node[m, c] += row[g] * side[g, c]


coordinate_rates = alternatives({SameRates: _same_rates, OwnRates: _own_rates})
"""(kinematics, at, s, f, out): fill the first rows of out (n + k, c) with q' at node ``at``, where y is s."""
fill_gain = alternatives({SameRates: _no_gain, OwnRates: _fill_gain})
"""(kinematics, h, first, weights, s, rate): fill the gain of a step h from node ``first``, where y is s and y' rate."""
gained = alternatives({SameRates: _integrated, OwnRates: _gained})
"""(kinematics, h, weights, a, i, n, j, k, g): how v_k at node i changes with v_g at node j by coordinates at node n."""
start = alternatives({SameRates: _start, OwnRates: _own_start})
"""(kinematics, h, weights, s, f, n, g, c): coordinate g of f at node n without velocities at nodes 1 .. 8."""
fill_coordinates = alternatives({SameRates: _integrate, OwnRates: _gain_coordinates})
"""(kinematics, h, weights, i, s, f, side, node): fill the first rows of node (n + k, c) i by v at nodes (8 k, c)."""


# -- steps -------------------------------------------------------------------------------------------------------------


@internal
def rate_at(kinematics, at, a, b, s, out):
    """Fill out (n + k, c) with y' at node ``at``, where y is s (n + k, c); a (k, n + k), b (k, c)."""
    f = b.shape[0]
    n = a.shape[1] - f
    coordinate_rates(kinematics, at, s, f, out)
    for k in range(f):
        for i in range(b.shape[1]):
            out[n + k, i] = b[k, i]
        for j in range(n + f):
            factor = a[k, j]
            for i in range(b.shape[1]):
                out[n + k, i] += factor * s[j, i]


@internal
def fill_matrix(kinematics, h, a, weights, matrix):
    """Fill matrix (8 k, 8 k) of v at nodes 1 .. 8 of a step h; a (9, k, n + k)."""
    f = a.shape[1]
    count = a.shape[2] - f
    for i in range(NODES):
        for j in range(NODES):
            for k in range(f):
                row = matrix[i * f + k]
                for g in range(f):
                    value = h * weights[i, 1 + j] * a[1 + j, k, count + g]
                    for n in range(NODES):
                        value += gained(kinematics, h, weights, a, i, n, j, k, g)
                    row[j * f + g] = -value
    for r in range(NODES * f):
        matrix[r, r] += 1.0


@internal
def fill_side(kinematics, h, a, b, weights, s, first, side):
    """Fill side (8 k, c) from s (n + k, c) and its rate ``first`` at node 0; a (9, k, n + k), b (9, k, c)."""
    f = b.shape[1]
    count = b.shape[2]
    coordinates = a.shape[2] - f
    for i in range(NODES):
        for k in range(f):
            row = side[i * f + k]
            for c in range(count):
                row[c] = s[coordinates + k, c] + h * weights[i, 0] * first[coordinates + k, c]
            for n in range(NODES):
                weight = h * weights[i, 1 + n]
                for c in range(count):
                    row[c] += weight * b[1 + n, k, c]
                for g in range(coordinates):
                    factor = weight * a[1 + n, k, g]
                    for c in range(count):
                        row[c] += factor * start(kinematics, h, weights, s, coordinates, n, g, c)


@internal
def _size(u, f, h):
    """Return the square of the size of u (n + k,): that of its velocities, and of its coordinates by a step h."""
    size = 0.0
    for k in range(u.shape[0]):
        part = u[k] / h if k < u.shape[0] - f else u[k]
        size += part * part
    return size


@internal
def correct(flow, f, h, y, removed):
    """Take from y (9, n + k, c + 1) at the nodes of a step the error that its last column has in ``flow`` (9, n + k).

    removed (c, 2): the size of what is removed at the end, and that of the rest y - tau u. Returns True if u errs
    little enough; else nothing is removed.
    """
    coordinates = flow.shape[1] - f
    last = y.shape[2] - 1
    for i in range(NODES + 1):
        for k in range(flow.shape[1]):
            y[i, k, last] -= flow[i, k]
    error = _size(y[NODES, :, last], f, h)
    size = _size(flow[0], f, h)
    consistent = size > 0.0 and error <= CONSISTENT * CONSISTENT * _size(flow[NODES], f, h)
    for c in range(last):
        shift = 0.0
        for k in range(flow.shape[1]):
            shift += flow[0, k] * y[0, k, c] / (h * h if k < coordinates else 1.0)
        shift /= max(size, 1e-300)
        rest = 0.0
        for i in range(1, NODES + 1 if consistent else 1):
            for k in range(flow.shape[1]):
                y[i, k, c] -= shift * y[i, k, last]
        for k in range(flow.shape[1]):
            part = (y[NODES, k, c] - shift * flow[NODES, k]) / (h if k < coordinates else 1.0)
            rest += part * part
        removed[c, 0] = abs(shift) * math.sqrt(error)
        removed[c, 1] = math.sqrt(rest)
    return consistent


@kernel
def march(kinematics, t, a, b, weights, flow, corrected, matrix, side, removed, out, rates):
    """Fill out and rates (8 d + 1, n + k, c) from out[0], by ``weights`` (8, 9); matrix and side are scratch.

    a (8 d + 1, k, n + k), b (8 d + 1, k, c). Each step is solved for v at its nodes, of which q follows. Where there
    are rates of the motion, ``flow`` (8 d + 1, n + k), the last of the columns is theirs, and what is ``removed``
    (d, c, 2) in steps that are to be ``corrected`` (d,) is what ``correct`` gives; those that cannot be are left out.
    """
    f = b.shape[1]
    n = a.shape[2] - f
    for first in range(0, t.shape[0] - 1, NODES):
        h = t[first + NODES] - t[first]
        own = slice(first, first + NODES + 1)
        if flow.shape[0] > 0:
            for k in range(flow.shape[1]):
                out[first, k, out.shape[2] - 1] = flow[first, k]
        rate_at(kinematics, first, a[first], b[first], out[first], rates[first])
        fill_gain(kinematics, h, first, weights, out[first], rates[first])
        fill_matrix(kinematics, h, a[own], weights, matrix)
        fill_side(kinematics, h, a[own], b[own], weights, out[first], rates[first], side)
        eliminate(matrix, side)
        for i in range(NODES):
            node = out[first + 1 + i]
            for k in range(f):
                for c in range(side.shape[1]):
                    node[n + k, c] = side[i * f + k, c]
            fill_coordinates(kinematics, h, weights, i, out[first], f, side, node)
        if corrected[first // NODES]:
            corrected[first // NODES] = correct(flow[own], f, h, out[own], removed[first // NODES])
        for i in range(1, NODES + 1):
            rate_at(kinematics, first + i, a[first + i], b[first + i], out[first + i], rates[first + i])


@kernel
def estimate(t, rates, per, halfway, last, errors):
    """Fill the first two of errors (d, 3) of steps from rates (8 d + 1, k, c).

    ``per`` (d, k, c): 1 / the largest values so far.
    """
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
