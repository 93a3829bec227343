"""What a run stands on: a prepared mechanism, an integrator, its scratch and tolerances."""

from __future__ import annotations

from collections.abc import Mapping

from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepared import PreparedDynamics

AUTO, REFERENCE, INDEPENDENT = FORMULATIONS = "auto", "reference", "independent"
"""Which coordinates are integrated; "auto" takes independent ones where it can."""
STEPS_AT_ONCE = 2000
"""Between two looks, of small mechanisms."""
WORK_AT_ONCE = 3e6
"""Coordinates times evaluations between two looks: a fraction of a second."""
EVALUATIONS = 12
"""Number of evaluations of a step."""


def steps_at_once(coordinates: int, matrices: bool) -> int:
    """Steps for one call of a compiled loop, so that it comes back within a second or so."""
    work = max(coordinates, 1) * (EVALUATIONS + (6 * coordinates if matrices else 0))
    return int(min(max(WORK_AT_ONCE / work, 1), STEPS_AT_ONCE))


class Running:
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
