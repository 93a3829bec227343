"""A march of Newton-Raphson along the steps of a driven motion, in the plane and in space.

The kernel solves one step after the other until it refuses one. Then the march goes on in the first way that serves:

    1  all steps in which a law goes further than its stride are divided
    2  rows of redundant joints are chosen anew, where those in use come near to depend on each other
    3  a change point ahead is passed (change_points/passages.py)
    4  the step is divided
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np

from mbsd.kinematics.change_points.assemblies import Solver
from mbsd.kinematics.change_points.passages import Passage, Passages
from mbsd.kinematics.newton import DONE
from mbsd.kinematics.steps import Steps


class NewtonMarch(ABC):
    """A motion whose rows are solved one after the other, from a closed pose in the first."""

    poses: ClassVar[tuple[str, str, str]] = ("q", "v", "a")
    """Names of the arrays of coordinates and of their derivatives by time."""

    def __init__(self, ready: Any, steps: Steps, switch_at: np.ndarray) -> None:
        """``ready``: Prepared, of the plane or of space. ``switch_at``: see Passages."""
        self.ready, self.steps = ready, steps
        self.sequence, self.factors = ready.sequence, ready.factors
        self._repeats = bool(ready.mobility.redundant_rows)
        self.arrays = self.room()
        """By name (T, ...); among them ``poses``, residual (T,) and determinant (T, d)."""
        self.passages = Passages(self.solver(), steps, switch_at)
        self.filled: list[np.ndarray] = []
        """Rows whose poses are those of each passage."""

    @abstractmethod
    def room(self) -> dict[str, np.ndarray]:
        """Return arrays for all steps, with the start in their first rows."""

    @abstractmethod
    def solver(self) -> Solver:
        """Return Newton-Raphson with the rows in use, for passages."""

    @abstractmethod
    def solve(self, first: int, chosen: int) -> tuple[int, int]:
        """Solve the steps from ``first`` on, by rows chosen at ``chosen``; returns status and index of the kernel."""

    @abstractmethod
    def error_of_step(self, status: int, index: int) -> Exception:
        """Return the error for a refused step that nothing cures."""

    def exchange(self, solver: Solver) -> None:
        """Go on with the rows of a solver, which depend less on each other than those in use."""
        self.passages.solver, self.sequence, self.factors = solver, solver.sequence, solver.factors
        self.arrays["determinant"] = np.zeros((len(self.steps.times), len(self.sequence.ends)))

    def is_solved(self, status: int) -> bool:
        """Return True if a step was refused for its rows alone: where these are the best, its pose is as good."""
        del status
        return False

    def complete(self, rows: np.ndarray) -> None:
        """Fill what follows from ``poses`` at ``rows`` (R,), which are those of a passage."""
        del rows

    def follow(self) -> None:
        """Solve all steps. Raises what says why the motion cannot go on."""
        steps, first, chosen = self.steps, 0, 0
        while first < len(steps.times):
            status, index = self.solve(first, chosen)
            if status == DONE:
                break
            if index == 0:
                raise self.error_of_step(status, 0)
            if not self.passages.passages and steps.follow_laws():
                self.arrays.update(self.room())
                first = chosen = 0
                continue
            if self._repeats and (index - 1 > chosen or self.sequence is self.ready.sequence):
                solver = self.passages.solver_at(index - 1, self.arrays[self.poses[0]])
                if solver is not None:
                    self.exchange(solver)
                    first = chosen = index - 1
                    continue
            if self.is_solved(status):
                first = index
                continue
            q, rate, _ = (self.arrays[name] for name in self.poses)
            passage = self.passages.pass_ahead(index - 1, q, rate)
            if passage is not None:
                first = chosen = self._gone_on(passage)
                continue
            if not steps.divide(index):
                raise self.error_of_step(status, index)
            self.arrays.update({name: np.insert(array, index, 0.0, axis=0) for name, array in self.arrays.items()})
            first = index

    def fill(self) -> None:
        """Fill poses near change points, also near those that the motion does not reach. Raises ModelError."""
        if len(self.steps.times):
            q, rate, _ = (self.arrays[name] for name in self.poses)
            self.passages.pass_ends(q, rate, self.arrays["determinant"], self._repeats)
        self.passages.refuse_missed_switches()
        self.filled = self.passages.fill(self.arrays, self.poses)
        for rows in self.filled:
            self.complete(rows)

    def _gone_on(self, passage: Passage) -> int:
        """Keep the steps before a passage, fill those right beyond it, and return the first to solve."""
        times = self.steps.times
        kept = int(np.searchsorted(times, passage.start, side="right"))
        for name, array in self.arrays.items():
            self.arrays[name] = np.concatenate([array[:kept], np.zeros((len(times) - kept, *array.shape[1:]))])
        first = kept + int(np.argmin(np.append(passage.is_near(times[kept:]), False)))
        for name, part in zip(self.poses, passage.motion(times[kept:first]), strict=True):
            self.arrays[name][kept:first] = part
        self.complete(np.arange(kept, first))
        return first
