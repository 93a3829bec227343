"""A run: an integrator with its tolerances over a prepared mechanism.

It is made of steps: in reference coordinates (steps.py), in independent ones (independent/steps.py), in
reference coordinates carried across singular poses (carried_steps.py), or from event to event (mbsd/dynamics/events/).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.dynamics.prepare.prepared import OUTPUTS_LONGEST, PreparedDynamics
from mbsd.dynamics.reference.arrays import Scratch
from mbsd.dynamics.state import Output, output_for

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


class Run:
    """What all steps of a run share."""

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
        self.contacts: Any = None
        """Arrays of contacts and events for the loop, once it has met some; the same ones whenever the run goes on."""
        ready.refuse_method(method)
        self.settings = ready.settings(method, tolerance, step, duration, options)

    @cached_property
    def passing(self) -> Run:
        """This run, or where its method knows no independent coordinates one that passes singular poses."""
        if self.method.independent:
            return self
        settings = self.settings
        duration = OUTPUTS_LONGEST * settings.longest
        return Run(self.ready, INTEGRATORS["dop853"], self.tolerance, settings.step, duration, {})

    @cached_property
    def scratch(self) -> Scratch:
        """In reference coordinates."""
        return self.ready.scratch(self.method)

    @cached_property
    def nowhere(self) -> Output:
        """For steps without outputs."""
        return output_for(np.zeros(0), len(self.ready.initial.q), len(self.ready.packed.ws.phi))
