"""The search for the best design: differential evolution over all designs within bounds, then least squares.

A design that does not close, or misses a condition, is worse than any that does; how much it misses leads the search
back. Each start is an evolution of its own with its own seed, so equal seeds give equal results.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from mbsd.synthesis.designs import Designs, Paths
from mbsd.synthesis.target import Target

OPEN = 1e4
"""Cost of a design that does not close, in squares of the target's extent."""
MISSED = 1e2
"""Cost of one that misses a condition, and what it misses is added a hundredfold."""
MEMBERS = 12
"""Designs of a generation for each number that varies."""
POLISHED = 3
"""Of the last generation, so many of the best are fitted by least squares."""
APART = 0.02
"""Designs nearer to each other than this part of the bounds count as one."""
MARGIN = 1e-4
"""The fit keeps conditions by so much more than asked for (rad, or part of the lengths)."""
STEP = 1e-6
"""Of the differences that give the slopes, in parts of the bounds."""
NEAR = 1e-5
"""Cost at which an evolution ends, for least squares goes on faster."""
GOOD = 1e-9
"""Root mean square in extents at which further starts are not tried."""


@dataclass
class Search:
    """A target, the designs, and the conditions on them."""

    designs: Designs
    target: Target
    free_shift: bool
    """Whether the last number of a vector is the time (s) by which the points' times are shifted."""
    least_transmission: float
    """rad"""
    generations: int
    progress: Callable[[float, float], None]
    """Called with the part done (0 .. 1) and the best root mean square so far (m)."""
    history: list[float] = field(default_factory=list)
    """Best root mean square (m) after each generation; infinite while no design does."""
    closed: int = 0
    kept: int = 0
    """Designs that closed, and of these, that met the conditions."""
    best: float = np.inf

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Of a vector with all that is free."""
        varied, (first, last) = self.designs.varied, self.target.span
        if not self.free_shift:
            return varied.low, varied.high
        return np.append(varied.low, 0.0), np.append(varied.high, last - first)

    def run(self, starts: int, seed: int) -> tuple[np.ndarray, list[float]] | None:
        """The best vector and the root mean square (m) that each start ended with; None where no design does."""
        best: np.ndarray | None = None
        worst_of = np.inf
        ends: list[float] = []
        for start in range(starts):
            found = [self._fitted(x) for x in self._evolved(np.random.default_rng([seed, start]), start, starts)]
            found = [one for one in found if np.isfinite(one[1])]
            if not found:
                ends.append(np.inf)
                continue
            x, error = min(found, key=lambda one: one[1])
            ends.append(error)
            if error < worst_of:
                best, worst_of = x, error
                self.best = min(self.best, error)
            self.progress((start + 1) / starts, self.best)
            if worst_of <= GOOD * self.target.extent:
                break
        return None if best is None else (best, ends)

    def error(self, x: np.ndarray) -> float:
        """Root mean square (m) of one design; infinite where it does not close or meet the conditions."""
        paths = self._paths(x[None], fine=True)
        if not self._meets(paths)[0]:
            return np.inf
        away = self.target.reached(paths.path[0], self._shifts(x[None])[0]) - self.target.points
        return float(np.sqrt((away**2).sum(-1).mean()))

    def _evolved(self, random: np.random.Generator, start: int, starts: int) -> list[np.ndarray]:
        """Designs of the last generation, the best first, apart from each other."""
        from scipy.optimize import differential_evolution

        low, high = self.bounds
        generation = 0

        def seen(intermediate_result: object) -> None:
            nonlocal generation
            generation += 1
            cost = float(getattr(intermediate_result, "fun", np.inf))
            if cost < 1.0:
                self.best = min(self.best, float(np.sqrt(cost)) * self.target.extent)
            self.history.append(self.best)
            self.progress((start + generation / (self.generations + 1)) / starts, self.best)
            if cost < NEAR:
                raise StopIteration

        result = differential_evolution(
            lambda x: self._cost(low + (high - low) * x.T), [(0.0, 1.0)] * len(low), popsize=MEMBERS,
            maxiter=self.generations, tol=1e-8, mutation=(0.4, 0.9), recombination=0.9, rng=random, polish=False,
            init="sobol", vectorized=True, updating="deferred", callback=seen,
        )  # fmt: skip
        ordered = result.population[np.argsort(result.population_energies)]
        chosen: list[np.ndarray] = []
        for one in ordered:
            if all(np.abs(one - other).max() > APART for other in chosen):
                chosen.append(one)
            if len(chosen) == POLISHED:
                break
        return [low + (high - low) * one for one in chosen]

    def _fitted(self, x: np.ndarray) -> tuple[np.ndarray, float]:
        """Least squares from one design: the better of both, and its root mean square (m)."""
        from scipy.optimize import least_squares

        low, high = self.bounds
        before = self.error(x)
        if not np.isfinite(before):
            return x, before
        size = high - low
        slopes: Any = partial(self._slopes, low=low, size=size)
        inside = np.clip((x - low) / size, 1e-9, 1 - 1e-9)
        found = least_squares(
            lambda u: self._residuals(low + size * u[None])[0], inside, jac=slopes,
            bounds=(0.0, 1.0), xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=100,
        )  # fmt: skip
        after = low + size * found.x
        error = self.error(after)
        return (after, error) if error < before else (x, before)

    def _slopes(self, u: np.ndarray, low: np.ndarray, size: np.ndarray) -> np.ndarray:
        sign = np.where(u < 0.5, 1.0, -1.0)
        steps = np.diag(STEP * sign)
        rows = self._residuals(low + size * np.vstack([u + steps, u - steps]))
        ahead, behind = rows[: len(u)], rows[len(u) :]
        inside = ((u - STEP >= 0) & (u + STEP <= 1))[:, None] & (np.abs(ahead) < OPEN) & (np.abs(behind) < OPEN)
        own = self._residuals(low + size * u[None])[0]
        slope = np.where(inside, (ahead - behind) / 2, ahead - own) / (STEP * sign)[:, None]
        return np.where(np.abs(ahead) < OPEN, slope, 0.0).T

    def _residuals(self, x: np.ndarray) -> np.ndarray:
        """(n, r) of designs x (n, k), in extents; those that do not close are far off."""
        paths, shifts = self._paths(x, fine=True), self._shifts(x)
        scale = self.target.extent
        rows = []
        for k in range(len(x)):
            if not paths.closes[k]:
                rows.append(None)
                continue
            short = max(0.0, self.least_transmission + MARGIN - paths.transmission[k]) if self.least_transmission else 0
            excess = paths.excess[k] + MARGIN if paths.excess[k] > 0 else 0.0
            rows.append(np.append(self.target.residuals(paths.path[k], shifts[k]) / scale, [10 * short, 10 * excess]))
        width = self.target.count(len(self.designs.grids[True])) + 2
        return np.array([np.full(width, 10 * OPEN) if row is None else row for row in rows])

    def _cost(self, x: np.ndarray) -> np.ndarray:
        """(n,) of designs x (n, k)."""
        paths = self._paths(x, fine=False)
        out = np.full(len(x), OPEN) + paths.excess
        meets, closes = self._meets(paths), paths.closes
        short = np.maximum(self.least_transmission - paths.transmission, 0.0) + paths.excess
        out[closes] = MISSED * (1 + short[closes])
        if meets.any():
            squares = self.target.squares(paths.path[meets], self._shifts(x)[meets])
            out[meets] = np.minimum(squares / self.target.extent**2, MISSED)
        self.closed += int(closes.sum())
        self.kept += int(meets.sum())
        return out

    def _paths(self, x: np.ndarray, fine: bool) -> Paths:
        return self.designs(x[:, : self.designs.varied.count], fine)

    def _meets(self, paths: Paths) -> np.ndarray:
        return paths.closes & (paths.transmission >= self.least_transmission) & (paths.excess <= 0)

    def _shifts(self, x: np.ndarray) -> np.ndarray:
        return x[:, -1] if self.free_shift else np.zeros(len(x))
