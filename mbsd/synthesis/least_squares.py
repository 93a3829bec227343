"""Least squares from many designs side by side: Levenberg and Marquardt within bounds.

A point's place on the path is held while the slopes are taken, and the part of a slope along the path is left out, for
the place follows along the path anyway (variable projection after Kaufman, BIT 15, 1975): sweeping the changed
designs is all that a slope costs. A number at a bound that the slope would push across stays there (the projected
method). All designs of a step are swept at once, so that fifty descents cost little more than one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mbsd.derivatives.numbers.variants import size_of, step_of
from mbsd.synthesis.designs import Designs, Paths
from mbsd.synthesis.target import Target

MARGIN = 1e-4
"""Conditions are kept by so much more than asked for (rad, or part of the lengths)."""
STEP = 1e-6
"""Step of the differences that give the slopes, as a part of what the mechanism notices."""
WEIGHT = 10.0
"""Weight of errors of conditions (rad, or fraction of the lengths) against distances in extents."""
SQUARE = 0.01
"""Cosine of the angle between path and residual below which the place is where the path is nearest."""


@dataclass
class Missed:
    """Errors of n designs, in extents of the target."""

    rows: np.ndarray
    """(n, r)"""
    cost: np.ndarray
    """(n,) mean squares; infinite where a design does not close."""
    where: np.ndarray
    """(n, N) sample numbers of the points' places."""
    along: np.ndarray
    """(n, N, 2) unit vectors along which a place moves freely; zero where it does not."""

    def subset(self, index: np.ndarray) -> Missed:
        """Return some of the designs."""
        return Missed(self.rows[index], self.cost[index], self.where[index], self.along[index])

    def replace(self, index: np.ndarray, other: Missed) -> None:
        """Replace some of the designs."""
        self.rows[index], self.cost[index] = other.rows, other.cost
        self.where[index], self.along[index] = other.where, other.along


@dataclass(frozen=True)
class Residuals:
    """A target, the designs, and the conditions on them.

    Vectors u (n, k) are in parts of the bounds, 0 .. 1.
    """

    designs: Designs
    target: Target
    least_transmission: float
    """rad"""
    low: np.ndarray
    size: np.ndarray
    """(k,) lowest numbers, and how far the bounds are apart; the shift (s) is last where it is free."""

    @cached_property
    def steps(self) -> np.ndarray:
        """(k,) steps of the numbers (m), and of the shift (s), whatever their bounds are."""
        numbers = self.designs.numbers(self.size)
        m, grid = self.designs.m, self.designs.grids[True]
        sizes = [size_of(number, m, self.designs.ready.packed, (float(grid[0]), float(grid[-1]))) for number in numbers]
        return np.array([step_of(STEP, size) for size in [*sizes, *self.size[len(sizes) :].tolist()]])

    def missed(self, u: np.ndarray, fine: bool) -> Missed:
        """Return the errors of designs u (n, k), on chords of the coarse motion or exactly on the fine one."""
        paths, shifts = self._paths(self.low + self.size * u, fine)
        there = np.where(paths.closes[:, None, None], paths.path, 0.0)
        where = self.target.where(there, shifts, fine)
        rows = self._rows(paths, there, where, fine)
        cost = np.where(paths.closes, (rows**2).sum(-1) / len(self.target.points), np.inf)
        missed = Missed(rows, cost, where, np.zeros((0, 0, 2)))
        missed.along = self._along(there, missed, fine)
        return missed

    def slopes(self, u: np.ndarray, missed: Missed, fine: bool) -> np.ndarray:
        """Return (n, r, k) of the designs u (n, k) that missed so."""
        n, k = u.shape
        x, steps = self.low + self.size * u, np.where(u < 0.5, self.steps, -self.steps)
        changed = (x[:, None] + steps[:, None] * np.eye(k)).reshape(n * k, k)
        paths, shifts = self._paths(changed, fine) if self.designs.at_once else self._neighbours(x, steps, fine)
        closes = paths.closes & np.repeat(np.isfinite(missed.cost), k)
        there = np.where(closes[:, None, None], paths.path, 0.0)
        held = np.repeat(missed.where, k, axis=0)
        where = held if self.target.times is None else self.target.where(there, shifts, fine)
        rows = self._rows(paths, there, where, fine).reshape(n, k, -1)
        slope = (rows - missed.rows[:, None]) * (self.size / steps)[..., None]
        slope[~closes.reshape(n, k)] = 0.0
        along = missed.along[:, None]
        at_points = slope[..., : 2 * along.shape[2]].reshape(n, k, -1, 2)
        held_back = (at_points * along).sum(-1, keepdims=True) * along
        slope[..., : 2 * along.shape[2]] -= held_back.reshape(n, k, -1)
        return slope.transpose(0, 2, 1)

    def _paths(self, x: np.ndarray, fine: bool) -> tuple[Paths, np.ndarray]:
        """Return paths and shifts (s) of designs x (n, k)."""
        count = self.designs.varied.count
        return self.designs(x[:, :count], fine), x[:, count:].sum(axis=1)

    def _neighbours(self, x: np.ndarray, steps: np.ndarray, fine: bool) -> tuple[Paths, np.ndarray]:
        """Return the same of designs x (n, k) that differ by a step (n, k) in one number each.

        They follow exact tangents.
        """
        count, k = self.designs.varied.count, x.shape[1]
        shifts = (x[:, None] + steps[:, :, None] * np.eye(k))[..., count:].sum(axis=2).ravel()
        paths = self.designs.neighbours(x[:, :count], steps[:, :count], fine)
        if count == k:
            return paths, shifts
        own = np.arange(len(x))[:, None] * count + np.minimum(np.arange(k), count - 1)  # the shift leaves the path
        still = self.designs.neighbours(x[:, :count], 0.0 * steps[:, :count], fine)
        pick = own.ravel()
        free = np.tile(np.arange(k) >= count, len(x))
        return Paths(*(np.where(free.reshape(-1, *[1] * (a.ndim - 1)), b[pick], a[pick])
                       for a, b in zip(paths.parts(), still.parts(), strict=True))), shifts  # fmt: skip

    def _rows(self, paths: Paths, there: np.ndarray, where: np.ndarray, fine: bool) -> np.ndarray:
        away = self.target.missed(there, where, fine).reshape(len(there), -1) / self.target.extent
        short = np.zeros(len(there))
        if self.least_transmission:
            short = np.maximum(self.least_transmission + MARGIN - paths.transmission, 0.0)
        excess = np.where(paths.excess > 0, paths.excess + MARGIN, 0.0)
        return np.column_stack([away, WEIGHT * short, WEIGHT * excess])

    def _along(self, there: np.ndarray, missed: Missed, fine: bool) -> np.ndarray:
        """Return directions of the paths where the points' places are free and nearest."""
        points = len(self.target.points)
        if self.target.times is not None:
            return np.zeros((len(there), points, 2))
        tangent = self.target.directions(there, missed.where, fine)
        away = missed.rows[:, : 2 * points].reshape(len(there), points, 2)
        near = np.abs((away * tangent).sum(-1)) <= SQUARE * np.hypot(*np.moveaxis(away, -1, 0))
        return np.where(near[..., None], tangent, 0.0)


FIRST = 1e-2
"""Damping of the first step, in parts of the largest diagonal entry of J^T J."""
FASTER, SLOWER = 1 / 6, 4.0
"""Factors of the damping after a step that gains and after one that does not."""
STIFFEST = 1e7
"""Damping at which a descent ends."""
GAIN = 1e-8
"""Part of its cost that a descent gains at least in a step that counts; after three others it ends."""
IDLE = 3


def descended(
    residuals: Residuals,
    u: np.ndarray,
    *,
    fine: bool,
    steps: int,
    enough: float = 0.0,
    halved: tuple[int, ...] = (),
    seen: Callable[[float, np.ndarray], None] = lambda cost, u: None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return designs (n, k) in parts of the bounds, the best first, and their costs (n,), from designs u.

    At the steps ``halved`` the better half goes on alone. A descent ends at a cost of ``enough``; the first that does
    ends them all. ``seen`` is called with the best cost and its design
    after each step.
    """
    u = np.clip(u, 0.0, 1.0)
    missed = residuals.missed(u, fine)
    slopes = residuals.slopes(u, missed, fine)
    damping, idle = np.full(len(u), FIRST), np.zeros(len(u), int)
    for step in range(steps):
        goes = np.flatnonzero((damping < STIFFEST) & (idle < IDLE) & np.isfinite(missed.cost))
        if step in halved and len(goes) > 1:
            order = goes[np.argsort(missed.cost[goes], kind="stable")]
            damping[order[(len(order) + 1) // 2 :]] = np.inf
            goes = np.sort(order[: (len(order) + 1) // 2])
        if not len(goes) or missed.cost.min() <= enough:
            break
        tried = np.clip(u[goes] + _steps(u[goes], missed.rows[goes], slopes[goes], damping[goes]), 0.0, 1.0)
        there = residuals.missed(tried, fine)
        better = there.cost < missed.cost[goes]
        gained = there.cost <= (1 - GAIN) * missed.cost[goes]
        idle[goes] = np.where(gained, 0, idle[goes] + better)
        damping[goes] = np.where(better, np.maximum(FASTER * damping[goes], 1e-12), SLOWER * damping[goes])
        ours = goes[better]
        if len(ours):
            u[ours] = tried[better]
            missed.replace(ours, there.subset(better))
            slopes[ours] = residuals.slopes(u[ours], missed.subset(ours), fine)
        best = int(missed.cost.argmin())
        seen(float(missed.cost[best]), u[best])
    order = np.argsort(missed.cost, kind="stable")
    return u[order], missed.cost[order]


def _steps(u: np.ndarray, rows: np.ndarray, slopes: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """Return (n, k): of each design -(J^T J + damping)^-1 J^T r over the numbers that no bound holds."""
    slope = np.einsum("nrk,nr->nk", slopes, rows)
    square = np.einsum("nrk,nrl->nkl", slopes, slopes)
    free = ~((u <= 0) & (slope > 0) | (u >= 1) & (slope < 0))
    square *= free[:, :, None] & free[:, None]
    diagonal = np.einsum("nkk->nk", square)
    lift = damping * np.maximum(diagonal.max(axis=1), 1e-300)
    square += np.where(free, lift[:, None], 1.0)[:, :, None] * np.eye(u.shape[1])
    return -np.linalg.solve(square, np.where(free, slope, 0.0)[..., None])[..., 0]
