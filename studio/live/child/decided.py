"""Numbers of a model that a number of Params decides, and the unit that follows.

Lengths are found by Euler's theorem: a place F of the model grows as the lengths x that decide it do, F = sum of
x dF/dx over all numbers that change it, which no angle and no ratio among them obeys. A number that is itself a mass, a
rate or an angle of the model has its unit.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from mbsd import Mechanism, MechanismError
from mbsd.model.body import Marker
from shared.stage.errors import UserError
from studio.live.child.author import Author
from studio.live.numbers import Number

STEP = 1e-4
"""Step of a number, by which it is changed."""
ALIKE = 1e-5
"""Fraction of a value: what differs less is equal."""
NOTHING = 1e-9
"""A slope, in sizes of what it changes, that is rounding."""
PLACES = ("/x", "/y", "/length", "/place/0", "/place/1", "/com/0", "/com/1")
OWN = {"mass": "kg", "inertia": "kg m^2", "gravity/0": "m/s^2", "gravity/1": "m/s^2", "free_length": "m"}
"""Units of a model's values."""
RATES = {"drive_angle": "rad/s", "drive_relative_angle": "rad/s", "drive_distance": "m/s", "drive_coordinate": "m/s"}
"""Units of constant rates, by the driver's kind."""


@dataclass(frozen=True)
class Decided:
    """Numbers of the model that each number of Params decides."""

    model: dict[str, Any]
    """Its values, by path."""
    slopes: dict[str, dict[str, float]]
    """dF/dx by name of the number x and path of the value F, where it is not zero."""
    lengths: frozenset[str]

    def unit(self, number: Number) -> str:
        """Return the unit that the model implies; empty if it implies none."""
        if number.name in self.lengths:
            return "m"
        units = {self._own_unit(path, number.value, slope) for path, slope in self.slopes.get(number.name, {}).items()}
        units.discard("")
        return units.pop() if len(units) == 1 else ""

    def axis(self, number: Number, k: int) -> str:
        """Return ``x`` or ``y`` if number k of a pair moves places along that axis alone, else ""."""
        keys = {path.rsplit("/", 1)[-1] for path in self.slopes.get(number.name, {})}
        return "xy"[k] if keys == {"xy"[k]} else ""

    def _own_unit(self, path: str, x: float, slope: float) -> str:
        value, (*_, before, key) = _number(self.model.get(path)), ["", *path.split("/")]
        if key == "angle" and _same(value, math.radians(x)) and _same(slope, math.radians(1)):
            return "deg"
        if not (_same(abs(value), abs(x)) and _same(abs(slope), 1.0)):
            return ""
        if key == "rate" and self.model.get(path.removesuffix("rate") + "kind") == "ConstantRate":
            return RATES.get(self.model.get(path.removesuffix("law/rate") + "kind", ""), "")
        return "rad" if key == "angle" else OWN.get(key, OWN.get(f"{before}/{key}", ""))


def decided_by(author: Author, numbers: list[Number]) -> Decided:
    """Return the numbers of the model that each number of Params decides, by differences."""

    def model(values: dict[str, float]) -> dict[str, Any]:
        return dict(_values(author.build(author.changed(values))))

    slopes: dict[str, dict[str, float]] = {}
    own = model({})
    for number in numbers:
        step = STEP * (abs(number.value) or 1.0)
        if number.whole:
            continue
        with suppress(MechanismError, UserError):
            low, high = model({number.name: number.value - step}), model({number.name: number.value + step})
            rates = {path: (_number(high.get(path)) - _number(low.get(path))) / (2 * step) for path in low}
            slopes[number.name] = {path: slope for path, slope in rates.items() if abs(slope) > NOTHING}
    return Decided(own, slopes, _lengths(own, slopes, {number.name: number.value for number in numbers}))


def _lengths(model: dict[str, Any], slopes: dict[str, dict[str, float]], values: dict[str, float]) -> frozenset[str]:
    """Return the numbers that decide some place together, as lengths do, and nothing but lengths."""
    deciding: dict[str, dict[str, float]] = {}
    for name, paths in slopes.items():
        for path, slope in paths.items():
            if path.endswith(PLACES):
                deciding.setdefault(path, {})[name] = slope
    others = {name for name, paths in slopes.items() if any(_is_other(path) for path in paths)}
    lengths: set[str] = set()
    for path, by in deciding.items():
        shares, value = [values[name] * slope for name, slope in by.items()], _number(model.get(path))
        largest = max(abs(share) for share in shares)
        grows = abs(sum(shares) - value) <= ALIKE * largest if largest else value == 0 and len(by) == 1
        if grows and not others & set(by):
            lengths |= set(by)
    return frozenset(lengths)


def _is_other(path: str) -> bool:
    """Return True if no length decides it: masses, weight, laws, velocities, parameters of forces."""
    table, *_, key = path.split("/")
    return (
        key == "mass"
        or table in ("gravity", "velocities")
        or "/law" in path
        or (table == "forces" and "/params/" in path and key != "free_length")
    )


def _values(m: Mechanism) -> Iterator[tuple[str, Any]]:
    """Yield the values of a model with their paths."""
    yield from _flat("gravity", m.gravity)
    for name, body in m.bodies.items():
        if name != "ground":
            of = {"mass": body.mass, "com": body.com, "inertia": body.inertia, "length": body.length}
            yield from _flat(f"bodies/{name}", of)
    for table in ("joints", "drivers", "forces", "contacts"):
        for name, entry in getattr(m, table).items():
            laws = {"law": getattr(entry, "motion", None), "laws": getattr(entry, "laws", {})}
            of = {"kind": entry.kind.name, "i": _marker(entry.i), "j": _marker(entry.j), "params": entry.given, **laws}
            yield from _flat(f"{table}/{name}", of)
    yield from _flat("traces", {name: _marker(marker) for name, marker in m.traces.items()})
    yield from _flat("starts", m.starts)
    yield from _flat("velocities", m.velocities)


def _marker(marker: Marker) -> dict[str, float]:
    return {"x": marker.x, "y": marker.y, "angle": marker.angle}


def _flat(path: str, value: Any) -> Iterator[tuple[str, Any]]:
    if dataclasses.is_dataclass(value):
        named = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
        value = {"kind": type(value).__name__, **named}
    if isinstance(value, Mapping):
        for key, part in value.items():
            yield from _flat(f"{path}/{key}" if path else key, part)
    elif isinstance(value, list | tuple):
        for k, part in enumerate(value):
            yield from _flat(f"{path}/{k}", part)
    else:
        yield path, value


def _number(value: Any) -> float:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0


def _same(first: float, second: float) -> bool:
    return second != 0 and math.isclose(first, second, rel_tol=ALIKE, abs_tol=0.0)
