"""A motion at the nodes of its tangents: simulated there, or where it is smooth found between the looks at it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.derivatives.asked import taken
from mbsd.derivatives.between_looks import between_looks
from mbsd.derivatives.sweeps import along_of
from mbsd.derivatives.terms import Along
from mbsd.dynamics.repeated import Course
from mbsd.results.solution import Solution


@dataclass
class Motion:
    """A motion at T times."""

    t: np.ndarray
    """(T,) s; where an event happens twice the same."""
    along: Along
    """With accelerations that were not solved for, and without multipliers, where it is found between looks."""
    solution: Solution | None
    """The simulation at these times; None where it is found between looks."""

    def take(self, rows: np.ndarray) -> Motion:
        """Some of its times."""
        solution = None if self.solution is None else taken(self.solution, rows)
        return Motion(self.t[rows], self.along.take(rows), solution)


def motion_of(sol: Solution) -> Motion:
    """That of a simulation."""
    along = along_of(sol)
    along.held = sol.held
    return Motion(sol.t, along, sol)


def between(course: Course, times: np.ndarray) -> Motion:
    """That of a smooth course at times (R,) (s) within it."""
    assert course.q is not None
    q, v, a = between_looks(course.t, course.q, course.v, course.a, times)
    rows = len(course.packed.ws.phi)
    lam, held = np.zeros((len(times), rows)), np.ones((len(times), rows), bool)
    return Motion(times, Along(times, q, v, a, lam, held=held), None)
