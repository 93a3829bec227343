"""Quantities of a text by their addresses: values of the moment and over the motion, in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote, unquote

import numpy as np
from numpy.typing import NDArray

from shared.contract.quantity import live, written
from shared.stage.errors import UserError, did_you_mean

# Addresses are links of the text, and page/src/article/quantities.js reads the same ones:
#
#     now:joint/B/size      value at the moment       range:body/rocker/theta   largest less smallest
#     most:joint/B/size     largest size              kinds and names of the payload, series as below
#
# Names are percent-encoded. Of an angle all words are in degrees.

Array = NDArray[np.float64]
KINDS = {
    "joint": "joints", "body": "bodies", "driver": "drivers", "point": "points", "force": "forces",
    "contact": "contacts",
}  # fmt: skip
UNITS = {
    "theta": "rad", "omega": "rad/s", "x": "m", "y": "m", "vx": "m/s", "vy": "m/s", "speed": "m/s", "size": "N",
    "fx": "N", "fy": "N", "torque": "N m", "power": "W",
}  # fmt: skip
"""Units of series; values and efforts have those of their driver, force or contact."""
OWN = {"value": "unit", "gap": "unit", "effort": "effort_unit", "normal": "effort_unit"}
SIZES = {"size": ("fx", "fy"), "speed": ("vx", "vy")}
"""Series that are sizes of vectors."""
MEASURES = ("now", "range", "most")
DIGITS = {"now": 3, "range": 2, "most": 2}


@dataclass(frozen=True)
class Series:
    """One series of a thing."""

    values: Array
    """(T,) SI."""
    unit: str

    def measured(self, measure: str, row: int = 0) -> float:
        """Return a value over the motion, or at a row of it (SI)."""
        if measure == "range":
            return float(np.ptp(self.values))
        return float(np.abs(self.values).max() if measure == "most" else self.values[row])

    def words(self, measure: str, row: int = 0) -> str:
        """Return the same as a sentence has it: ``56°``, ``1.4 N``."""
        value = self.measured(measure, row)
        if self.unit == "rad":
            turns = measure == "now" and float(np.ptp(self.values)) > 2 * math.pi
            return degrees(value % (2 * math.pi) if turns else value)
        if measure == "now":
            return live(self.values, self.unit, DIGITS["now"])(value)
        return written(value, self.unit, DIGITS[measure])


def degrees(value: float) -> str:
    """Return an angle (rad) in whole degrees."""
    return f"{round(math.degrees(value)) or 0}°".replace("-", "−")


def address(kind: str, name: str, series: str = "") -> str:
    """Return ``joint/B/size``."""
    return "/".join(quote(part, safe="") for part in (kind, name, series) if part)


def named(words: str) -> list[str]:
    """Return kind, name and perhaps series of an address."""
    return [unquote(part) for part in words.split("/")]


def thing_of(payload: dict[str, Any], words: str) -> dict[str, Any]:
    """Return the thing of an address. Raises UserError for one that the machine lacks."""
    kind, name, *_ = [*named(words), ""]
    if kind not in KINDS:
        raise UserError(
            f"'{words}': there is no kind '{kind}'; there is: {', '.join(KINDS)}{did_you_mean(kind, KINDS)}"
        )
    things = payload[KINDS[kind]]
    if name not in things:
        raise UserError(f"'{words}': the machine has no {kind} '{name}'{did_you_mean(name, list(things))}")
    return things[name]


def series_of(payload: dict[str, Any], words: str) -> Series:
    """Return the series of an address. Raises UserError for one that the machine lacks."""
    thing = thing_of(payload, words)
    series = [*named(words), "", ""][2]
    parts = SIZES.get(series, (series,))
    if any(not isinstance(thing.get(part), np.ndarray) for part in parts):
        known = [key for key in (*thing, *SIZES) if key in {*UNITS, *OWN}]
        raise UserError(f"'{words}' names no series; there is: {', '.join(known)}{did_you_mean(series, known)}")
    values = [np.asarray(thing[part], float) for part in parts]
    unit = UNITS.get(series) or thing[OWN[series]]
    return Series(values[0] if len(values) == 1 else np.hypot(*values), unit)
