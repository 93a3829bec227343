"""Derivatives of a mechanism's motion against central differences of whole solutions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mbsd.arrays.packing import pack
from mbsd.derivatives.numbers.variants import FOURTH, size_of, step_of
from mbsd.derivatives.requests import wanted
from mbsd.derivatives.sensitivities import moves_freely, sensitivities
from mbsd.mechanism import Mechanism
from mbsd.numbers.names import Number, number_named, with_values
from mbsd.testing.kinds import compare

STEP = 1e-3
"""Step of the differences, as part of the size of a number; see mbsd/derivatives/numbers/variants.py."""
CLOSER = 0.25
"""Part of the step of the differences that confirm the first ones."""
SLIGHT = 1e-4
"""Derivatives below this are rounding of what is zero (SI)."""
PRECISE = 1e-12
"""Tolerance of the simulations whose differences are taken."""


def check_derivatives(
    m: Mechanism,
    of: Any,
    to: Sequence[str],
    duration: float | None = None,
    steps: int = 40,
    tolerance: float = 1e-5,
    step: float = STEP,
    confirmed: bool = False,
) -> dict[str, float]:
    """Compare m.sensitivities() with central differences of fourth order of sweeps, or of simulations.

    The ``tolerance`` is part of the largest derivative by each number; ``step`` is part of the number's size. With
    ``confirmed`` differences over a quarter of the step must be the same within the tolerance, so that they are known
    to have converged. Gives the error by number. Raises AssertionError.
    """
    given = sensitivities(m, of, to, duration, steps, None)
    functions, free = wanted(m, of, given.solution), moves_freely(m)
    span = float(given.t[0]), float(given.t[-1])
    errors: dict[str, float] = {}

    def differences_over(number: Number, h: float) -> dict[str, Any]:
        total: dict[str, Any] = dict.fromkeys(functions, 0.0)
        for offset, weight in zip(*FOURTH, strict=True):
            other = with_values(m, [number], [number.value + offset * h])
            sol = other.simulate(times=given.t, tolerance=PRECISE) if free else other.sweep(times=given.t)
            for label, function in functions.items():
                total[label] = total[label] + weight * np.asarray(function(sol)) / h
        return total

    for k, name in enumerate(to):
        number = number_named(m, name)
        h = step_of(step, size_of(number, m, pack(m), span))
        total = differences_over(number, h)
        closer = differences_over(number, CLOSER * h) if confirmed else total
        errors[name] = 0.0
        for label, differences in total.items():
            scale = max(float(np.abs(differences).max()), float(np.abs(given.values[label]).max()), SLIGHT)
            own = given[label][..., k]
            compare(
                f"{m.name}: d {label} / d {name}: its differences", closer[label], differences, tolerance * scale,
                lambda *at: f"t = {given.t[at[0]]:.3g} s" if at else "",
            )  # fmt: skip
            compare(
                f"{m.name}: d {label} / d {name}", own, differences, tolerance * scale,
                lambda *at: f"t = {given.t[at[0]]:.3g} s" if at else "",
            )  # fmt: skip
            errors[name] = max(errors[name], float(np.abs(own - differences).max() / (scale or 1.0)))
    return errors
