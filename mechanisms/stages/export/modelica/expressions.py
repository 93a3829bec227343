"""Numbers, vectors and laws of time as Modelica has them."""

from __future__ import annotations

from typing import Any

from mbsd.model.laws.constant_rate import ConstantRate
from mbsd.model.laws.harmonic import Harmonic
from mbsd.model.laws.polynomial import Polynomial
from mechanisms.stages.export.numbers import ROUNDING


def number(value: float) -> str:
    """One number with all its digits."""
    return repr(0.0 if abs(value) < ROUNDING else float(value)).removesuffix(".0")


def vector(*values: float) -> str:
    """Several in braces."""
    return "{" + ", ".join(number(value) for value in values) + "}"


def signed(value: float) -> str:
    """A number to be multiplied or added."""
    return f"({number(value)})" if value < 0 else number(value)


def law(motion: Any) -> str | None:
    """A law of time; None of those that have no formula."""
    match motion:
        case ConstantRate():
            return f"{number(motion.start)} + {signed(motion.rate)}*time"
        case Harmonic():
            phase = f"{signed(motion.rate)}*time + {signed(motion.phase)}"
            return f"{number(motion.mean)} + {signed(motion.amplitude)}*sin({phase})"
        case Polynomial():
            first, *others = motion.coefficients
            terms = [f"{signed(value)}*time^{power}" for power, value in enumerate(others, 1)]
            return " + ".join([number(first), *terms])
    return None
