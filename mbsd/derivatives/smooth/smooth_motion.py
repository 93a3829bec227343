"""A motion at the nodes of its tangents: simulated there, or where it is smooth found between the looks at it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.derivatives.free.mesh import longest_steps, looked_at_closer
from mbsd.derivatives.numbers.terms import Along, Terms, along_of, rows_of, terms_of
from mbsd.derivatives.smooth.between_looks import between_looks
from mbsd.dynamics.repeated import Course, Repeated
from mbsd.results.solution import Solution

STEPS_OF_METHOD = 0.2
"""Usual steps of the tangents for one of the integrator."""
AGAIN, FEW = 3, 2
"""A motion is looked at again so often at most, as long as a step somewhere has no more gaps than so many, or the
integrator took more steps than there were looks."""
CLOSE = 1e-4
"""Error of accelerations between looks, as part of the largest, beyond which the motion is simulated at the nodes."""


class NotSmooth(Exception):
    """A way to the tangents does not serve this motion."""


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
        solution = None if self.solution is None else rows_of(self.solution, rows)
        return Motion(self.t[rows], self.along.take(rows), solution)


def motion_of(sol: Solution) -> Motion:
    """Return the smooth motion of a simulation."""
    along = along_of(sol)
    along.held = sol.held
    return Motion(sol.t, along, sol)


def between(course: Course, times: np.ndarray) -> Motion:
    """Return the motion of a smooth course at times (R,) (s) within it."""
    assert course.q is not None
    q, v, a = between_looks(course.t, course.q, course.v, course.a, times)
    rows = len(course.packed.ws.phi)
    lam, held = np.zeros((len(times), rows)), np.ones((len(times), rows), bool)
    return Motion(times, Along(times, q, v, a, lam, held=held), None)


def looked_at_closely(runs: Repeated, first: Course) -> tuple[Course, np.ndarray]:
    """A course, at closer times where it is smooth and was looked at too seldom, and how long steps may be there."""
    usual = (first.t[-1] - first.t[0]) / max(1.0, STEPS_OF_METHOD * first.steps)
    longest = longest_steps(first.t, *_parts(first), usual)
    for _ in range(AGAIN if first.q is not None else 0):
        if first.steps < len(first.t) and not (longest < FEW * np.diff(first.t)).any():
            break
        first = runs.closer(looked_at_closer(first.t, longest))
        longest = longest_steps(first.t, *_parts(first), usual)
    return first, longest


def terms_along(runs: Repeated, first: Course) -> Terms:
    """The equations of a course; where it is smooth, with the laws and loads that were prepared for it."""
    known = runs.ready.dynamics if first.q is not None and runs.ready is not None else None
    if known is None or len(known.loads.interaction):  # these remember how contacts were approached
        return terms_of(first.packed, runs.span)
    return terms_of(first.packed, runs.span, known.laws, known=known.loads)


def _parts(first: Course) -> tuple[np.ndarray, np.ndarray]:
    """(T, 2 n) speeds and accelerations, and (2 n,) what makes parts of their largest of them."""
    motion = np.concatenate([first.v[:, 3:], first.a[:, 3:]], axis=1)
    largest = np.abs(motion).max(axis=0)
    return motion, 1.0 / np.where(largest > 1e-9 * largest.max(initial=1e-300), largest, np.inf)
