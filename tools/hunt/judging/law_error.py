"""How exactly derivatives of a driver's law are known of which values alone are given.

Those of a Python function come from a fit.

Of a piece of the fit, w wide, the last Chebyshev coefficients are below c, and rounding hides r of f
(mbsd/model/laws/fitting/leaves.py: both are in its Leaves). T_8' = 64 and T_8'' = 1344 at the ends of -1 .. 1, so

    |error of f''| <= 1344 (2 / w)^2 max(c, r),      |error of f'| <= 64 (2 / w) max(c, r)

Fits over other spans err otherwise, so two solutions differ by the sum of both. A table of values at times h apart is a
spline of degree 5. Each value is rounded by eps |f| / 2; at its ends, where derivatives are those of the polynomial
through six values, their weights add up to 21 / h and 53 / h^2. What that makes of the motion is in
agreement.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.model.laws import Motion
from mbsd.model.laws.fitting.fit import fit
from mbsd.model.laws.fitting.leaves import BEND_OF_LAST, ROUNDING, given_cuts
from mbsd.model.laws.fitting.sampling import Sampled, look_times
from mbsd.model.laws.function import Function
from mbsd.model.laws.splines import Table
from mbsd.results.solution import Solution
from tools.hunt.words.raised import Raised

SLOPE_OF_LAST = 64.0
"""T_8' at the ends."""
SLOPE_OF_SIX, BEND_OF_SIX = 21.0, 53.0
"""What weights of six values at even times add up to, without their signs, in the derivatives at the first of them."""


@dataclass(frozen=True)
class LawError:
    """Errors of all drivers together, lengths in sizes of the mechanism."""

    slope: float = 0.0
    """Error of f' (1/s)."""
    bend: float = 0.0
    """Error of f'' (1/s^2)."""

    def __add__(self, other: LawError) -> LawError:
        return LawError(self.slope + other.slope, self.bend + other.bend)


def law_error(sol: Solution) -> LawError:
    """Error of the laws of a solution, over its span."""
    out, first, last = LawError(), float(sol.t[0]), float(sol.t[-1])
    if not last > first:
        last = first + 1.0  # as the solver does
    for driver in sol.mechanism.drivers.values():
        assert driver.motion is not None
        error = of_law(driver.motion, first, last)
        scale = 1.0 if "angle" in driver.kind.name else sol.packed.size
        out += LawError(error.slope / scale, error.bend / scale)
    return out


def of_law(law: Motion, first: float, last: float) -> LawError:
    """Error of one law between two times (s), in its own unit; none of laws that know their derivatives."""
    raised_by = 0.0
    while isinstance(law, Raised):
        law, raised_by = law.law, raised_by + abs(law.by)
    if isinstance(law, Table):
        shortest, largest = float(np.diff(law.times).min()), float(np.abs(law.values).max()) + raised_by
        rounding = float(np.finfo(float).eps) * largest
        return LawError(SLOPE_OF_SIX / 2 * rounding / shortest, BEND_OF_SIX / 2 * rounding / shortest**2)
    if not isinstance(law, Function) or law.df is not None:
        return LawError()
    looks, f = look_times(first, last, law.shortest), law.f
    sampled = Sampled(lambda times: np.array([float(f(t)) for t in times]))
    leaves = fit(sampled, first, last, given_cuts(law.breaks, first, last), looks, False).leaves
    off = np.maximum(leaves.last, leaves.rounding + ROUNDING * raised_by)
    halves = 2.0 / leaves.width
    return LawError(float((SLOPE_OF_LAST * halves * off).max()), float((BEND_OF_LAST * halves**2 * off).max()))
