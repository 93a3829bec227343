"""The integrators of scipy over the solver's accelerations, for cross-checking: another's time integration.

``scipy-dop853``: explicit Runge-Kutta of order 8. ``scipy-radau``: Radau IIA of order 5, implicit. ``scipy-lsoda``:
Adams and BDF methods of variable order; it finds by itself where the motion is stiff.

They run in Python, and cost many times what the solver's own methods do. How they see the model: see outside.py.

Source: scipy.integrate (DOP853, Radau, LSODA); Hairer, Norsett, Wanner, Solving ODEs I, II; Petzold 1983, SIAM J. Sci.
Stat. Comput. 4 (LSODA).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from mbsd.dynamics.integrators.kind import Integrator, register
from mbsd.dynamics.integrators.others.outside import PULL, STAGES, Maker, Rates, Stepper, advance_with, tolerances
from mbsd.dynamics.state import Settings


class _Scipy:
    """A solver of scipy under way."""

    def __init__(self, solver: str, rates: Rates, t: float, y: np.ndarray, end: float, settings: Settings) -> None:
        from scipy import integrate

        relative, absolute = tolerances(settings)
        self._rates, self._one_step = rates, solver != "LSODA"
        rates.pull = None if self._one_step else float(settings.options[0])
        limits = {"rtol": relative, "atol": absolute, "max_step": settings.longest}
        with np.errstate(all="ignore"):
            self._solver = getattr(integrate, solver)(rates, t, y, end, **limits)
        self._dense: Callable[[float], np.ndarray] | None = None
        self.t, self.y = t, y

    def step(self) -> bool:
        """See Stepper."""
        with np.errstate(all="ignore"):  # a trial step may overflow, and is taken again
            self._solver.step()
        self._dense = None
        if self._solver.status == "failed":
            return False
        if self._one_step:
            self._solver.y = self._rates.projected(self._solver.t, self._solver.y)
            self._solver.f = self._rates(self._solver.t, self._solver.y)
        self.t, self.y = float(self._solver.t), self._solver.y
        return True

    def between(self, t: float) -> np.ndarray:
        """See Stepper."""
        dense = self._dense = self._dense or self._solver.dense_output()
        return dense(t)


def _maker(solver: str) -> Maker:
    def make(rates: Rates, t: float, y: np.ndarray, end: float, settings: Settings) -> Stepper:
        return _Scipy(solver, rates, t, y, end, settings)

    return make


SCIPY_DOP853, SCIPY_RADAU, SCIPY_LSODA = (
    register(
        Integrator(
            f"scipy-{solver.lower()}",
            partial(advance_with, _maker(solver)),
            STAGES,
            order,
            fixed_step=False,
            options=options,
        )
    )
    for solver, order, options in (("DOP853", 8, {}), ("Radau", 5, {}), ("LSODA", 0, PULL))
)
