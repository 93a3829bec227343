"""One run of an integrator over a prepared mechanism, and why it cannot go on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelError, SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.exchange import LOOK, exchange_rows
from mbsd.dynamics.reference.multipliers import fill_multipliers
from mbsd.dynamics.runs.pace import Pace, steps_at_once
from mbsd.dynamics.runs.stuck import jump
from mbsd.equations.joint_friction import FAILED

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepare import PreparedDynamics
    from mbsd.dynamics.runs.embed import Embedded
    from mbsd.dynamics.runs.embedded_run import EmbeddedRun

NO_LIMIT = 10**12
JUMP_STEP = 1e-9
"""Part of the longest step within which a force that jumps is looked for where steps shrink to nothing."""
AUTO, REFERENCE, INDEPENDENT = FORMULATIONS = "auto", "reference", "independent"
"""Which coordinates are integrated; "auto" takes independent ones where it can."""


class Run:
    """An integrator with its scratch and tolerances."""

    def __init__(
        self,
        ready: PreparedDynamics,
        method: Integrator,
        tolerance: float,
        step: float,
        duration: float,
        options: Mapping[str, float],
        formulation: str = AUTO,
    ) -> None:
        self.ready = ready
        self.formulation = formulation
        self.method = method
        self.tolerance = tolerance
        self.steps_at_once = steps_at_once(ready.packed.coordinates, method.matrices[0] > 0)
        self.scratch = ready.scratch(method)
        self.settings = ready.settings(method, tolerance, step, duration, options)

    def advance(self, state: run_state.State, out: run_state.Output, end: float, steps: int = NO_LIMIT) -> int:
        """Go on to ``end`` (s), ``steps`` steps at most; returns REACHED or PAUSED, raises SimulationError."""
        ready = self.ready
        status = ready.advance(self.method, ready.dynamics, self.scratch, state, out, self.settings, end, steps)
        self.ready.packed.specials.check()
        if status not in (run_state.REACHED, run_state.PAUSED):
            raise self._failure(status, state)
        return status

    @cached_property
    def nowhere(self) -> run_state.Output:
        """For runs without outputs."""
        return run_state.output_for(np.zeros(0), len(self.ready.initial.q), len(self.ready.packed.ws.phi))

    def to_end(
        self, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
    ) -> bool:
        """Go on to the last output time, from a start or restart; returns whether in independent coordinates."""
        embedded = self.embedded(state)
        if embedded is None:
            self.in_one_go(state, out, progress)
            return False
        embedded.in_one_go(state, out, progress)
        fill_multipliers(self.ready.dynamics, self.scratch, out)
        self.ready.packed.specials.check()
        return True

    def embedded(self, state: run_state.State) -> EmbeddedRun | None:
        """The same run in independent coordinates from this state on, or None if it stays in reference coordinates.

        Raises ModelError if independent coordinates were asked for in vain.
        """
        if self.formulation == REFERENCE:
            return None
        why, made = self._choice(state)
        if made is not None:
            from mbsd.dynamics.runs.embedded_run import EmbeddedRun

            return EmbeddedRun(self, made, state)
        if self.formulation == INDEPENDENT:
            raise ModelError(f"{self.ready.packed.name}: formulation='independent' is not possible here: {why}")
        return None

    def _choice(self, state: run_state.State) -> tuple[str | None, Embedded | None]:
        from mbsd.dynamics.runs.embed import NO_PLAN, can_embed, embed

        if not self.method.embeds:
            return f"method '{self.method.name}' works in reference coordinates", None
        why = can_embed(self.ready)
        if why is not None:
            return why, None
        if np.array_equal(state.y[0], self.ready.initial.q) and np.array_equal(state.y[1], self.ready.initial.v):
            return NO_PLAN, self.ready.embedded
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
                    fill_multipliers(self.ready.dynamics, self.scratch, out)
                return
        pace = None if progress is None else Pace(self, state, end, progress)
        while self._some_steps(state, out, end) != run_state.REACHED:
            pace = pace or Pace(self, state, end, progress)
            pace.note()
        if pace is not None:
            pace.note()

    def _some_steps(self, state: run_state.State, out: run_state.Output, end: float) -> int:
        """As :meth:`advance`, with a look at rows that repeat others now and then."""
        if not self.ready.switches.spare:
            return self.advance(state, out, end, self.steps_at_once)
        status = run_state.PAUSED
        for _ in range(0, self.steps_at_once, LOOK):
            exchange_rows(self.ready, state)
            status = self.advance(state, out, end, LOOK)
            if status == run_state.REACHED:
                break
        return status

    def _failure(self, status: int, state: run_state.State) -> SimulationError:
        packed, method = self.ready.packed, self.method
        time, speeds = state.clock[run_state.TIME], np.abs(state.y[1].reshape(-1, 3)[1:])
        fastest = packed.body_names[1 + int(np.argmax((speeds / [packed.size, packed.size, 1]).max(1)))]
        where = f"{packed.name}: {method.name} stops at t = {time:.6g} s, where '{fastest}' is fastest"
        if status == run_state.NO_CONVERGENCE:
            return SimulationError(
                f"{where}: the equations of a step have no solution near the last one. Take a smaller step, "
                "or look for a force or law that jumps."
            )
        if self.ready.dynamics.loads.rubbing[FAILED]:
            return SimulationError(
                f"{where}: friction and reactions of the joints do not agree there; joints jam. Lower the friction, "
                "guide sliders over a longer length, or raise slip_speed."
            )
        if method.fixed_step:
            return SimulationError(
                f"{where}: numbers are no longer finite after a step of {self.settings.step:.3g} s. "
                "Take a smaller step, or method='dop853'; stiff springs and dampers ask for method='radau'."
            )
        short = f"steps below {state.clock[run_state.STEP]:.1e} s do not meet the tolerance {self.tolerance:g}"
        jumping = jump(self, state, JUMP_STEP * self.settings.longest)
        if jumping is not None:
            return SimulationError(f"{where}: {short}; {jumping}")
        return SimulationError(
            f"{where}: {short}. "
            "The pose is singular here, or a force jumps or grows without bound; change the lengths, smooth the force, "
            "or loosen the tolerance."
        )
