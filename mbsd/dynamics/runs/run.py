"""One run of an integrator over a prepared mechanism, and why it cannot go on."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from mbsd.arrays.friction_along import REMEDY, jam
from mbsd.base.errors import SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.prepare.exchange import LOOK, exchange_rows
from mbsd.dynamics.runs.running import Running
from mbsd.dynamics.runs.stuck import jump
from mbsd.equations.joint_friction import FAILED, X

NO_LIMIT = 10**12
RECENT = 1e3
"""Steps before a run stops in which what a function of the user did may be why."""
JUMP_STEP = 1e-9
"""Part of the longest step within which a force that jumps is looked for where steps shrink to nothing."""


class Run(Running):
    """A run in reference coordinates."""

    def advance(self, state: run_state.State, out: run_state.Output, end: float, steps: int = NO_LIMIT) -> int:
        """Go on to ``end`` (s), ``steps`` steps at most; returns REACHED or PAUSED, raises SimulationError."""
        ready = self.ready
        status = ready.advance(self.method, ready.dynamics, self.scratch, state, out, self.settings, end, steps)
        accepted, specials = status in (run_state.REACHED, run_state.PAUSED), ready.packed.specials
        if self.method.fixed_step:
            specials.check()
        elif accepted:
            specials.check_trials()
        else:
            specials.check_trials(state.clock[run_state.TIME] - RECENT * state.clock[run_state.STEP])
        if not accepted:
            raise self._failure(status, state)
        return status

    @cached_property
    def nowhere(self) -> run_state.Output:
        """For runs without outputs."""
        return run_state.output_for(np.zeros(0), len(self.ready.initial.q), len(self.ready.packed.ws.phi))

    def some_steps(self, state: run_state.State, out: run_state.Output, end: float) -> int:
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
        bodies = len(packed.body_names) - packed.states
        time, speeds = state.clock[run_state.TIME], np.abs(state.y[1].reshape(-1, 3)[1:bodies])
        fastest = packed.body_names[1 + int(np.argmax((speeds / [packed.size, packed.size, 1]).max(1)))]
        where = f"{packed.name}: {method.name} stops at t = {time:.6g} s, where '{fastest}' is fastest"
        if status == run_state.NO_CONVERGENCE:
            own = ", or method='dop853'; stiff springs and dampers ask for method='radau'" if method.fixed_step else ""
            return SimulationError(
                f"{where}: the equations of a step of {self.settings.step:.3g} s have no solution near the last one. "
                f"Take a smaller step{own}, or look for a force or law that jumps."
            )
        loads = self.ready.dynamics.loads
        if loads.iteration[FAILED]:
            return SimulationError(f"{where}: {jam(packed, loads.normal[X])}. {REMEDY}, or raise slip_speed.")
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
