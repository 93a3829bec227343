"""CVODE of SUNDIALS over the solver's accelerations, for cross-checking: another's time integration.

``sundials-adams``: Adams methods of order 1 to 12, for motion that is not stiff. ``sundials-bdf``: backward
differentiation of order 1 to 5, for stiff motion. Both solve their equations by Newton's method with a full matrix by
differences.

They need the package scikit-sundae, of the extra ``bench``. How they see the model: see outside.py.

Source: Hindmarsh and others 2005, ACM Trans. Math. Softw. 31 (SUNDIALS).
"""

from __future__ import annotations

from functools import partial

import numpy as np

from mbsd.dynamics.integrators.kind import Integrator, register
from mbsd.dynamics.integrators.others.outside import PULL, STAGES, Maker, Rates, Stepper, advance_with, tolerances
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.state import Settings

SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""


class _Cvode:
    """A CVODE solver under way."""

    def __init__(self, formula: str, rates: Rates, t: float, y: np.ndarray, end: float, settings: Settings) -> None:
        from sksundae.cvode import CVODE  # pyright: ignore[reportMissingImports]

        def fill(t: float, y: np.ndarray, yp: np.ndarray) -> None:
            yp[:] = rates(t, y)

        rates.pull = float(settings.options[0])
        relative, absolute = tolerances(settings)
        limits = {"max_step": settings.longest, "min_step": SMALLEST_STEP * settings.longest}
        self._solver = CVODE(fill, method=formula, rtol=relative, atol=absolute, **limits)
        self._solver.init_step(t, y)
        self._end = end
        self.t, self.y = t, y

    def step(self) -> bool:
        """See Stepper."""
        taken = self._solver.step(self._end, "onestep", self._end)
        self.t, self.y = float(taken.t), np.array(taken.y)
        return bool(taken.success)

    def between(self, t: float) -> np.ndarray:
        """See Stepper."""
        return np.array(self._solver.step(t, "normal", self._end).y)


def _refusal(dynamics: Dynamics) -> str | None:
    if SUNDIALS_BDF.installed:
        return None
    return (
        "methods of SUNDIALS need scikit-sundae: install mbsd[bench] (make bench does), or take 'scipy-lsoda', "
        "which needs nothing more"
    )


def _maker(formula: str) -> Maker:
    def make(rates: Rates, t: float, y: np.ndarray, end: float, settings: Settings) -> Stepper:
        return _Cvode(formula, rates, t, y, end, settings)

    return make


SUNDIALS_ADAMS, SUNDIALS_BDF = (
    register(
        Integrator(
            f"sundials-{formula.lower()}",
            partial(advance_with, _maker(formula)),
            STAGES,
            order=0,
            fixed_step=False,
            options=PULL,
            refusal=_refusal,
            package="sksundae",
        )
    )
    for formula in ("Adams", "BDF")
)
