"""Steps in reference coordinates, carried by independent ones across poses where joints nearly depend on each other.

There the multipliers grow without bound, and rounding with them: with the inverse square of the distance from the pose
in velocities, with its inverse cube in accelerations. A step that comes near such a pose is taken back, and the
mechanism goes in independent coordinates, which pass it smoothly (bridge.py), until it is well beyond. Mechanisms
without such coordinates pass as well as they can.
"""

from __future__ import annotations

import numpy as np

from mbsd.base.errors import SimulationError
from mbsd.dynamics.independent.embedding import can_embed, embed, embedded_at_start
from mbsd.dynamics.independent.steps import IndependentSteps
from mbsd.dynamics.reference.acceleration import derivative
from mbsd.dynamics.runs.pace import Pace
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.runs.steps import advance
from mbsd.dynamics.state import PAUSED, REACHED, TIME, Output, State, copied
from mbsd.kinematics.groups.groups import KIND
from mbsd.kinematics.groups.registry import BRANCH

NEAR = 0.05
"""Part of the largest margin so far below which a pose is near a singular one; it goes with the distance squared."""


def can_carry(run: Run) -> bool:
    """Whether a run in reference coordinates has poses of this sort and independent coordinates to pass them."""
    ready = run.ready
    if not run.method.independent or can_embed(ready) is not None:
        return False
    made = embedded_at_start(ready)
    if made is None:
        return False
    return any(int(kind) in BRANCH for kind in made.arrays.group[:, KIND])


class CarriedSteps:
    """See the file; one step at a time."""

    def __init__(self, run: Run, state: State, out: Output, pace: Pace) -> None:
        self.run, self.state, self.out, self.pace = run, state, out, pace
        self.end = float(out.t[-1])
        self.widest = self._margin()
        self.carried = False

    def to_end(self) -> bool:
        """Go on to the last output time; returns whether outputs were written in independent coordinates."""
        vain = False
        while True:
            before, failure = copied(self.state), None
            try:
                status = advance(self.run, self.state, self.out, self.end, 1)
            except SimulationError as error:
                if vain:
                    raise
                failure, status = error, PAUSED
            self.pace.note()
            if status == REACHED:
                return self.carried
            near = failure is not None or self._near(float(self.run.scratch.report[0]))
            if not near:
                vain = False
            elif not vain:
                for target, source in zip(self.state, before, strict=True):
                    target[...] = source
                status = self._carry()
                if status == REACHED:
                    return True
                vain = status != PAUSED
                if vain and failure is not None:
                    raise failure
                if vain:
                    for target, source in zip(self.state, before, strict=True):
                        target[...] = source

    def _near(self, margin: float) -> bool:
        self.widest = max(self.widest, margin)
        return not margin > NEAR * self.widest

    def _margin(self) -> float:
        state, ready = self.state, self.run.ready
        derivative(
            ready.dynamics, self.run.scratch, float(state.clock[TIME]), state.y, np.zeros_like(state.y),
            np.zeros_like(state.lam),
        )  # fmt: skip
        return float(self.run.scratch.report[0])

    def _carry(self) -> int | None:
        """Go on in independent coordinates until the pose is clear; returns PAUSED or REACHED, None if that fails."""
        state = self.state
        made = embed(self.run.ready, state.y[0], state.y[1], float(state.clock[TIME]))
        if made is None:
            return None
        independent = IndependentSteps(self.run, made, state)
        moved = False
        while True:
            status = independent.one_step(self.out, self.end)
            self.pace.note()
            if status is None or status == REACHED:
                self.carried = self.carried or status == REACHED or moved
                return status
            moved = self.carried = True
            if not self._near(self._margin()):
                independent.leave()
                return PAUSED
