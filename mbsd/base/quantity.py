"""Numbers with units as people write them: prefixes, few digits, a true minus sign, no exponents.

render/view/page/src/data/numbers.js follows the same rules; the cases in tests/shared/quantities.json hold both to the
same answers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
DOWN = ("m", "m/s", "s")
"""Units that have prefixes for small numbers alone."""
PLAIN = ("m/s²", "rad", "rad/s", "rad/s²", "°", "%", "cm³", "km/h", "rpm", "bar", "l/min", "1", "")
"""Units without prefixes."""
STEPS = {
    "kg": ((1e3, 1e-3, "t"), (1.0, 1.0, "kg"), (0.0, 1e3, "g")),
    "kg m²": ((0.01, 1.0, "kg·m²"), (0.0, 1e4, "kg·cm²")),
}
"""Units that others stand for, without prefixes: from which number on (SI), the factor and the unit."""
MINUS = "\N{MINUS SIGN}"
DIGITS = 4
"""Significant digits, at most."""
LIVE = 6
"""Decimals at most of a number that changes while one looks at it."""
ANGLES = (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0)
"""Steps of ticks in degrees."""


def written(value: float, unit: str, digits: int = 3) -> str:
    """Return ``value`` (SI) with an engineering prefix: ``12.3 mN``, ``0 N``, ``1.29 kN·m``, ``−40 µm``."""
    if not math.isfinite(value):
        named = dotted(unit)
        return f"no number of {named}" if math.isnan(value) else f"{MINUS if value < 0 else ''}∞ {named}".rstrip()
    factor, named = prefixed(float(f"{abs(value):.{digits}g}"), unit)  # rounded first: 999.9996 is 1 k
    digits = digits if abs(value * factor) < 1000.0 else max(digits, DIGITS)
    return f"{figures(value * factor, digits)}{'' if named in ('°', '%') else ' '}{named}".rstrip()


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """Return the factor from SI and the unit with its prefix for numbers up to ``largest``.

    For 1290 N they are 0.001 and ``kN``, and a product of units has a dot: ``N·m``.
    """
    if unit in PLAIN or not largest or not math.isfinite(largest):
        return 1.0, dotted(unit)
    if unit in STEPS:
        return next((factor, named) for least, factor, named in STEPS[unit] if abs(largest) >= least)
    power = min(max(3 * math.floor(math.log10(abs(largest)) / 3 + 1e-9), -12), 12)
    power = min(power, 0) if unit in DOWN else power
    return 10.0**-power, f"{PREFIXES[power]}{dotted(unit)}"


def dotted(unit: str) -> str:
    """Return a product of units with a dot, ``N·m``."""
    return unit.replace(" ", "·")


def figures(value: float, digits: int = DIGITS) -> str:
    """Return a number with significant digits, without an exponent: ``1230``, ``−0.02``, ``2.5 × 10¹⁸``."""
    number = float(f"{value:.{digits}g}")
    if number == 0.0:
        return "0"
    digits_of, _, exponent = f"{number:.{digits - 1}e}".partition("e")
    power = int(exponent)
    if not -7 <= power < 7:
        mantissa = f"{float(digits_of):.{digits}g}"
        raised = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{mantissa} × 10{raised}".replace("-", MINUS)
    text = f"{number:.{max(digits - 1 - power, 0)}f}"
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", MINUS)


def counted(count: int, noun: str) -> str:
    """Return a number of things with their noun: ``1 impact``, ``3 bodies``, ``no drivers``."""
    several = f"{noun[:-1]}ies" if noun.endswith("y") else f"{noun}s"
    return f"{count or 'no'} {noun if count == 1 else several}"


def live(values: Iterable[float], unit: str, digits: int = DIGITS) -> Callable[[float], str]:
    """Return a writer of numbers of a series with one prefix and one count of decimals.

    So they stand still.
    """
    top = max((abs(float(value)) for value in values), default=0.0)
    top = float(f"{top:.{digits}g}")
    factor, named = prefixed(top, unit)
    if not top or not math.isfinite(top):
        return lambda value: f"0 {named}".rstrip()
    decimals = min(max(digits - 1 - math.floor(math.log10(top * factor) + 1e-12), 0), LIVE)

    def write(value: float) -> str:
        if abs(top * factor) >= 1e7:
            return f"{figures(value * factor, digits)} {named}".rstrip()
        number = round(value * factor, decimals) + 0.0
        return f"{number:.{decimals}f} {named}".rstrip().replace("-", MINUS)

    return write


def labelled(words: str, unit: str) -> str:
    """Return the label of an axis: ``force / kN``, ``velocity / (m/s)``; ``order`` without a unit.

    It follows ISO 80000-1.
    """
    if unit in ("", "1"):
        return words
    return f"{words} / ({dotted(unit)})" if set(unit) & set("/ ·") else f"{words} / {unit}"


def angle_step(span: float, most: int = 9) -> float:
    """Return the step of ticks (degrees) over a ``span`` of angle, with at most ``most`` ticks.

    Steps are parts and multiples of a right angle.

    From 180 degrees on they are 45, 90 or whole multiples of 90.
    """
    for step in ANGLES:
        if span / step <= most and (span < 180.0 or step >= 45.0):
            return step
    return 360.0 * math.ceil(span / 360.0 / most)
