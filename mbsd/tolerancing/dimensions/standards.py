"""Standard tolerances by size: ISO 2768-1, and grades and fits of ISO 286-1, all in m.

    general_tolerance(0.120, "m")         3e-4: the length is 120 +- 0.3 mm
    standard_tolerance(0.010, 7)          15e-6: IT7 at 10 mm, from limit to limit
    fit(0.010, "H7/g6")                   (5e-6, 29e-6): least and largest play of a pin of 10 mm in its bore

The values are those of the tables in the standards (up to 4 m and 500 mm), which are rounded and so are no formula.
"""

from __future__ import annotations

import re
from bisect import bisect_left

from mbsd.base.arguments import positive_number, text
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown

GENERAL_STEPS = (3.0, 6.0, 30.0, 120.0, 400.0, 1000.0, 2000.0, 4000.0)
"""Sizes (mm) up to which each column of ISO 2768-1, table 1 goes; the first begins at 0.5."""
SMALLEST = 0.5
GENERAL: dict[str, tuple[float | None, ...]] = {
    "f": (0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, None),
    "m": (0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0),
    "c": (0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0),
    "v": (None, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0),
}
"""Deviations (mm) to either side: fine, medium, coarse, very coarse."""

STEPS = (3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0)
"""Sizes (mm) up to which each column of ISO 286-1 goes."""
GRADES: dict[int, tuple[float, ...]] = {
    1: (0.8, 1, 1, 1.2, 1.5, 1.5, 2, 2.5, 3.5, 4.5, 6, 7, 8),
    2: (1.2, 1.5, 1.5, 2, 2.5, 2.5, 3, 4, 5, 7, 8, 9, 10),
    3: (2, 2.5, 2.5, 3, 4, 4, 5, 6, 8, 10, 12, 13, 15),
    4: (3, 4, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20),
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
    13: (140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970),
    14: (250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550),
    15: (400, 480, 580, 700, 840, 1000, 1200, 1400, 1600, 1850, 2100, 2300, 2500),
    16: (600, 750, 900, 1100, 1300, 1600, 1900, 2200, 2500, 2900, 3200, 3600, 4000),
}
"""Standard tolerances IT1 to IT16 (um)."""
BELOW: dict[str, tuple[float, ...]] = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * 13,
}
"""Distances (um) of a shaft's zone below the nominal size, and of the zone of a hole of the same letter above it."""
ABOVE: dict[str, tuple[float, ...]] = {
    "k": (0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5),
    "m": (2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23),
    "n": (4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40),
    "p": (6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68),
}
"""Distances (um) of a shaft's zone above the nominal size; those of k are of the grades 4 to 7, 0 of all others."""
K_GRADES = range(4, 8)
ZONE = re.compile(r"([A-Za-z]{1,2})(\d{1,2})")
MM, UM = 1e-3, 1e-6


def general_tolerance(size: float, name: str) -> float:
    """The deviation (m) to either side of a length ``size`` (m) by ISO 2768-1, class "f", "m", "c" or "v".

    Raises ModelError for another class, and for a size that the class has no deviation for.
    """
    length = positive_number("general_tolerance: size", size, "m") / MM
    if name not in GENERAL:
        raise ModelError(f"general_tolerance: {no_such('class of ISO 2768-1', name, GENERAL)}")
    column = _column(length, GENERAL_STEPS)
    deviation = GENERAL[name][column] if column is not None and length >= SMALLEST * (1 - NEAR) else None
    if deviation is None:
        raise ModelError(
            f"ISO 2768-1 has no deviation of class {name} for {length:g} mm; give the tolerance itself as a number (m)"
        )
    return deviation * MM


NEAR = 1e-9
"""Part by which a size may lie beyond the end of a step: 0.03 m is 30 mm."""


def standard_tolerance(size: float, grade: int) -> float:
    """Return the standard tolerance IT ``grade`` (m) of a ``size`` (m) up to 500 mm by ISO 286-1.

    It is from limit to limit.

    Raises ModelError for a grade other than 1 to 16, and for a larger size.
    """
    if grade not in GRADES:
        raise ModelError(f"standard_tolerance: grade is {shown(grade)}; there are 1 to {max(GRADES)}")
    return GRADES[grade][_step(size, f"IT{grade}")] * UM


def fit(size: float, name: str) -> tuple[float, float]:
    """Return least and largest play (m), bore less pin, of an ISO 286-1 fit such as "H7/g6".

    The diameter is ``size`` (m). Holes D, E, F, G, H, JS; shafts d, e, f, g, h, js, k, m, n, p. Below 0 the pin is
    larger than its bore. Raises ModelError for another text, and for a diameter beyond 500 mm.
    """
    zones = [ZONE.fullmatch(part.strip()) for part in text("fit: name", name).split("/")]
    hole, shaft = zones if len(zones) == 2 else (None, None)
    if hole is None or shaft is None or not hole[1][0].isupper() or not shaft[1][0].islower():
        raise ModelError(f"fit: {shown(name)} is no fit; write a hole and a shaft, such as 'H7/g6'")
    low, high = deviations(size, hole[0])
    least, largest = deviations(size, shaft[0])
    return low - largest, high - least


def deviations(size: float, zone: str) -> tuple[float, float]:
    """Lower and upper deviation (m) of a zone such as "H7" or "g6" at a ``size`` (m). Raises ModelError."""
    match = ZONE.fullmatch(zone)
    letter, grade = (match[1], int(match[2])) if match else ("", 0)
    small, hole = letter.lower(), letter[:1].isupper()
    known = ["js", *BELOW] if hole else ["js", *BELOW, *ABOVE]
    if small not in known or letter not in (small, small.upper()) or grade not in GRADES:
        names = [known_name.upper() if hole else known_name for known_name in known]
        raise ModelError(f"fit: {no_such('zone of ISO 286-1', zone, names)}, each with a grade from 1 to {max(GRADES)}")
    width, column = standard_tolerance(size, grade), _step(size, zone)
    if small == "js":
        return -width / 2, width / 2
    if small in ABOVE:
        least = ABOVE[small][column] * UM if small != "k" or grade in K_GRADES else 0.0
        return least, least + width
    away = BELOW[small][column] * UM
    return (away, away + width) if hole else (-away - width, -away)


def _step(size: float, what: str) -> int:
    length = positive_number(f"{what}: size", size, "m") / MM
    column = _column(length, STEPS)
    if column is None:
        raise ModelError(f"{what}: the table of ISO 286-1 here ends at {STEPS[-1]:g} mm, and the size is {length:g} mm")
    return column


def _column(length: float, steps: tuple[float, ...]) -> int | None:
    column = bisect_left(steps, length * (1 - NEAR))
    return column if column < len(steps) else None
