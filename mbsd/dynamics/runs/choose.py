"""Runs in the coordinates that suit them: independent ones where there are some, else reference coordinates."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from mbsd.base.errors import ModelError, SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.multipliers import fill_multipliers
from mbsd.dynamics.runs.embed import NO_PLAN, Embedded, can_embed, embed, embedded_at_start
from mbsd.dynamics.runs.embedded_run import EmbeddedRun
from mbsd.dynamics.runs.pace import Pace
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.runs.running import AUTO, INDEPENDENT, REFERENCE


class ChoosingRun(Run):
    """A run that chooses its coordinates."""

    def to_end(
        self, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
    ) -> bool:
        """Go on to the last output time, from a start or restart; returns whether in independent coordinates.

        Then multipliers and margins are still to be found (reference/multipliers.py).
        """
        embedded = self.embedded(state)
        if embedded is None:
            self.in_one_go(state, out, progress)
            return False
        embedded.in_one_go(state, out, progress)
        return True

    def embedded(self, state: run_state.State) -> EmbeddedRun | None:
        """The same run in independent coordinates from this state on, or None if it stays in reference coordinates.

        Raises ModelError if independent coordinates are asked for and impossible.
        """
        if self.formulation == REFERENCE or (self.formulation == AUTO and self.ready.masses_apart):
            return None  # independent coordinates solve once, and lose the digits of the light bodies
        why, made = self._choice(state)
        if made is not None and (made.pays or self.formulation == INDEPENDENT):
            return EmbeddedRun(self, made, state)
        if self.formulation == INDEPENDENT:
            raise ModelError(f"{self.ready.packed.name}: formulation='independent' is not possible here: {why}")
        return None

    def _choice(self, state: run_state.State) -> tuple[str | None, Embedded | None]:
        if not self.method.independent:
            return f"method '{self.method.name}' works in reference coordinates", None
        why = can_embed(self.ready)
        if why is not None:
            return why, None
        if np.array_equal(state.y[0], self.ready.initial.q) and np.array_equal(state.y[1], self.ready.initial.v):
            return NO_PLAN, embedded_at_start(self.ready)
        return NO_PLAN, embed(self.ready, state.y[0], state.y[1], float(state.clock[run_state.TIME]))

    def in_one_go(
        self, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
    ) -> None:
        """``to_end`` in reference coordinates, carried across singular poses by independent ones if asked for these."""
        end = float(out.t[-1])
        if self.formulation == REFERENCE:
            from mbsd.dynamics.runs.across import Across, can_carry

            if can_carry(self):
                if Across(self, state, out, Pace(self, state, end, progress)).to_end():
                    fill_multipliers(self.ready.packed, self.ready.dynamics, out.t, out.y, out.lam, out.margin)
                return
        pace = None if progress is None else Pace(self, state, end, progress)
        while self.some_steps(state, out, end) != run_state.REACHED:
            pace = pace or Pace(self, state, end, progress)
            pace.note()
        if pace is not None:
            pace.note()


def integrate(
    ready: PreparedDynamics,
    method: Integrator,
    times: np.ndarray,
    tolerance: float,
    step: float,
    progress: Callable[[float], None] | None = None,
    options: Mapping[str, float] | None = None,
    formulation: str = AUTO,
) -> tuple[run_state.State, run_state.Output]:
    """Integrate to the last of ``times`` (s), which begin with the start; no events. Raises SimulationError.

    Multipliers are found in reference coordinates alone.
    """
    state, out = ready.begun(times)
    run = ChoosingRun(ready, method, tolerance, step, float(times[-1] - times[0]), options or {}, formulation)
    run.to_end(state, out, progress)
    missing = len(times) - int(state.count[run_state.NEXT])
    if missing:
        raise SimulationError(
            f"{ready.packed.name}: the last {missing} of {len(times)} outputs were not reached, which is a fault of "
            "mbsd, not of the model; formulation='reference' goes another way"
        )
    return state, out
