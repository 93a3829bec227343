"""One run of an integrator over a prepared mechanism, and why it cannot go on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mbsd.errors import SimulationError
from mbsd.integrators import state as run_state
from mbsd.integrators.kind import Integrator
from mbsd.joint_friction import FAILED

if TYPE_CHECKING:
    from mbsd.dynamics.prepare import PreparedDynamics

STEPS_AT_ONCE = 2000
"""Between two looks at the clock and the keyboard."""
NO_LIMIT = 10**12


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
    ) -> None:
        self.ready = ready
        self.method = method
        self.tolerance = tolerance
        self.scratch = ready.scratch(method)
        self.settings = ready.settings(method, tolerance, step, duration, options)

    def advance(self, state: run_state.State, out: run_state.Output, end: float, steps: int = NO_LIMIT) -> int:
        """Go on to ``end`` (s), ``steps`` steps at most; returns REACHED or PAUSED, raises SimulationError."""
        status = self.method.advance(self.ready.dynamics, self.scratch, state, out, self.settings, end, steps)
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
    ) -> None:
        """Go on to the last output time."""
        start, end = float(state.clock[run_state.TIME]), float(out.t[-1])
        while True:
            status = self.advance(state, out, end, STEPS_AT_ONCE)
            if progress is not None:
                progress((state.clock[run_state.TIME] - start) / (end - start))
            if status == run_state.REACHED:
                return

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
        return SimulationError(
            f"{where}: steps below {state.clock[run_state.STEP]:.1e} s do not meet the tolerance {self.tolerance:g}. "
            "The pose is singular here, or a force jumps or grows without bound; change the lengths, smooth the force, "
            "or loosen the tolerance."
        )
