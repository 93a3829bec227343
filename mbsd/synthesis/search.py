"""Search for the best design: a spread of descents, differential evolution, least squares.

Many designs of a low-discrepancy sequence (Sobol) are swept, and least squares goes down from the best of them side by
side. Where none of these meets the target, they begin an evolution over all designs within the bounds. A design that
does not close, or misses a condition, is worse than any that does; how much it misses leads the search back. Each start
is a search of its own with its own seed, so equal seeds give equal results.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from mbsd.synthesis.designs import Designs, Paths
from mbsd.synthesis.least_squares import Residuals, descended
from mbsd.synthesis.target import Target

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult
    from scipy.stats.qmc import QMCEngine

OPEN = 1e4
"""Cost of a design that does not close, in squares of the target's extent."""
MISSED = 1e2
"""Cost of one that misses a condition, and what it misses is added a hundredfold."""
MEMBERS = 12
"""Designs of a generation for each number that varies."""
POLISHED = 3
"""Number of the best of the last generation that are fitted by least squares."""
APART = 0.02
"""Designs nearer to each other than this part of the bounds count as one."""
DRAWN, ONE_BY_ONE = 100, 12
"""Designs of a round for each number that varies: swept at once in closed form, and others."""
DESCENTS = 20
"""A descent for so many of them."""
ROUNDS = 8
"""At most."""
AGREED, ALIKE = 3, 1e-3
"""Number of starts that suffices if their costs agree to this part, or if none comes near the points."""
STEPS, HALVED = 24, (5, 10)
"""Steps of the descents, and those at which the better half goes on."""
DESCENDING = 0.3
"""Part of a start that the rounds take, as progress reports it."""
FINE_STEPS = 100
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
    """True if the last number of a vector is the time (s) by which the points' times are shifted."""
    least_transmission: float
    """rad"""
    generations: int
    progress: Callable[[float, float], None]
    """Called with the part done (0 .. 1) and the best root mean square so far (m)."""
    better: Callable[[np.ndarray, float], None] = lambda x, error: None
    """Called with the best vector so far and its root mean square (m), whenever there is a better one."""
    history: list[float] = field(default_factory=list)
    """Best root mean square (m) after each generation; infinite while no design does."""
    closed: int = 0
    kept: int = 0
    """Designs that closed, and of these, that met the conditions."""
    best: float = np.inf

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of a vector with all that is free."""
        varied, (first, last) = self.designs.varied, self.target.span
        if not self.free_shift:
            return varied.low, varied.high
        return np.append(varied.low, 0.0), np.append(varied.high, last - first)

    def run(self, starts: int, seed: int) -> tuple[np.ndarray, list[float]] | None:
        """Return the best vector and the root mean square (m) of each start; None where no design works."""
        best: np.ndarray | None = None
        worst_of = np.inf
        ends: list[float] = []
        for start in range(starts):
            x, error = self._started(np.random.default_rng([seed, start]), start, starts)
            ends.append(error)
            if error < worst_of:
                best, worst_of = x, error
                if error < self.best:
                    self.best = error
                    self.better(x, error)
            self.progress((start + 1) / starts, self.best)
            if worst_of <= GOOD * self.target.extent:
                break
        return None if best is None else (best, ends)

    def error(self, x: np.ndarray) -> float:
        """Return the root mean square (m) of one design; infinite if it does not close or meet the conditions."""
        paths = self._paths(x[None], fine=True)
        if not self._meets(paths)[0]:
            return np.inf
        away = self.target.reached(paths.path[0], self._shifts(x[None])[0]) - self.target.points
        return float(np.sqrt((away**2).sum(-1).mean()))

    @cached_property
    def _residuals(self) -> Residuals:
        low, high = self.bounds
        return Residuals(self.designs, self.target, self.least_transmission, low, high - low)

    def _started(self, random: np.random.Generator, start: int, starts: int) -> tuple[np.ndarray, float]:
        """Return the best vector of a start, and its root mean square (m), infinite where no design serves."""
        low, _ = self.bounds
        sequence, count = self._sequence(random)
        best, least = low, np.inf
        begun: list[np.ndarray] = []
        costs: list[float] = []
        rounds = ROUNDS if self._quick else 1
        for number in range(rounds):
            drawn = sequence.random(count)
            ends, missed = self._descended(drawn, (start + DESCENDING * number / rounds) / starts)
            begun.append(ends)
            costs.append(float(missed[0]))
            if costs[-1] < NEAR:
                x, error = self._best(ends)
                costs[-1] = (error / self.target.extent) ** 2
                if error < least:
                    best, least = x, error
                if least <= GOOD * self.target.extent:
                    return best, least
            far = number + 1 == AGREED and min(costs) >= NEAR
            if far or sum(cost <= (1 + ALIKE) * min(costs) for cost in costs) == AGREED:
                break
        if not least < np.inf:
            size = 1 << int(np.ceil(np.log2(MEMBERS * len(low))))
            first = np.concatenate([*begun, sequence.random(size)])[:size]
            best, least = self._best(self._evolved(first, random, start, starts))
        return best, least

    def _best(self, u: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the best vector after least squares and its root mean square (m), from u (n, k), best first."""
        low, high = self.bounds
        fitted = [self._fitted(low + (high - low) * u[k]) for k in _apart(u, POLISHED)]
        return min(fitted, key=lambda fit: fit[1])

    def _descended(self, drawn: np.ndarray, done: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the ends of descents from the best of designs drawn (n, k), the best first, and their costs."""
        low, high = self.bounds
        costs = np.concatenate([self._cost(low + (high - low) * some) for some in np.array_split(drawn, 8)])
        order = np.argsort(costs, kind="stable")
        begun = drawn[order][_apart(drawn[order], max(2, len(drawn) // DESCENTS))]
        self._seen(float(costs.min()), done, drawn[costs.argmin()])
        return descended(
            self._residuals, begun, fine=False, steps=STEPS, enough=NEAR / 100, halved=HALVED,
            seen=lambda cost, u: self._seen(cost, done, u),
        )  # fmt: skip

    @property
    def _quick(self) -> bool:
        """True if a design costs little: all are swept at once, and no function of the author builds them."""
        return self.designs.at_once and self.designs.build is None

    def _sequence(self, random: np.random.Generator) -> tuple[QMCEngine, int]:
        """Return designs in parts of the bounds, and how many of them a round takes."""
        from scipy.stats import qmc

        numbers = len(self.bounds[0])
        wanted = (DRAWN if self._quick else ONE_BY_ONE) * numbers
        return qmc.Sobol(numbers, rng=random), 1 << int(np.ceil(np.log2(wanted)))

    def _evolved(self, first: np.ndarray, random: np.random.Generator, start: int, starts: int) -> np.ndarray:
        """Return the last generation after the ``first`` (n, k), the best first."""
        from scipy.optimize import differential_evolution

        low, high = self.bounds
        generation, begun = 0, cast(Any, first)  # scipy's types know words alone

        def seen(intermediate_result: OptimizeResult) -> None:
            nonlocal generation
            generation += 1
            cost = float(intermediate_result.fun)
            self._seen(cost, (start + generation / (self.generations + 1)) / starts, intermediate_result.x)
            if cost < NEAR:
                raise StopIteration

        result = differential_evolution(
            lambda x: self._cost(low + (high - low) * x.T), [(0.0, 1.0)] * len(low), maxiter=self.generations,
            tol=1e-8, mutation=(0.4, 0.9), recombination=0.9, rng=random, polish=False, init=begun, vectorized=True,
            updating="deferred", callback=seen,
        )  # fmt: skip
        return result.population[np.argsort(result.population_energies, kind="stable")]

    def _seen(self, cost: float, done: float, u: np.ndarray) -> None:
        """Report a design u (k,) in parts of the bounds, the best of those that were just tried."""
        error = float(np.sqrt(cost)) * self.target.extent if cost < 1.0 else np.inf
        if error < self.best:
            self.best = error
            low, high = self.bounds
            self.better(low + (high - low) * u, error)
        self.history.append(self.best)
        self.progress(done, self.best)

    def _fitted(self, x: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the better of a design and its least squares fit, and its root mean square (m)."""
        before = self.error(x)
        if not np.isfinite(before):
            return x, before
        low, high = self.bounds
        u = descended(self._residuals, (x - low)[None] / (high - low), fine=True, steps=FINE_STEPS)[0]
        after = low + (high - low) * u[0]
        error = self.error(after)
        return (after, error) if error < before else (x, before)

    def _cost(self, x: np.ndarray) -> np.ndarray:
        """Return (n,) of designs x (n, k)."""
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


def _apart(designs: np.ndarray, most: int) -> list[int]:
    """Return numbers of the first designs (n, k) that are apart from each other."""
    chosen: list[int] = []
    for k, design in enumerate(designs):
        if all(np.abs(design - designs[other]).max() > APART for other in chosen):
            chosen.append(k)
        if len(chosen) == most:
            break
    return chosen
