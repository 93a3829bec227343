"""Names that people give the numbers of Params: ``tracer[0]`` is "tracer x", in m.

An author may say so, where one string serves all numbers of a tuple,

    wheel: tuple[float, float] = field(
        default=(0.8, 2e-3), metadata={"names": ("mass", "inertia"), "unit": ("kg", "kg m^2")}
    )

or in the comment beside the number: "# of a charge (J/m^3)", "# metres", "# crank, rod, slider". Where he says nothing,
the model does, as below.
"""

from __future__ import annotations

import ast
import dataclasses
import io
import math
import re
import tokenize
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from mbsd import Mechanism, MechanismError
from mbsd.model.body import Marker
from shared.stage.errors import UserError
from shared.stage.paths import mechanism_file
from studio.live.child.author import Author
from studio.live.numbers import Number, numbers_of, parsed

# Numbers of a model that a number of Params decides, and the unit that follows.
#
# Lengths are found by Euler's theorem: a place F of the model grows as the lengths x that decide it do, F = sum of x
# dF/dx over all numbers that change it, which no angle and no ratio among them obeys. A number that is itself a mass, a
# rate or an angle of the model has its unit.


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


ATOM = r"(?:[mckM]?m|[kM]?g|t|m?s|min|h|rad|deg|[kM]?N|[kM]?J|[kM]?W|[kMG]?Pa|bar|[kM]?Hz|K|A|V)(?:\^?[2-4])?"
UNIT = re.compile(rf"{ATOM}(?:[ /]{ATOM})*")
WORDS = {"metres": "m", "millimetres": "mm", "kilograms": "kg", "seconds": "s", "degrees": "°", "radians": "rad"}
"""Units that people write out."""


def described(author: Author) -> dict[str, dict[str, str]]:
    """Return ``label`` and ``unit`` of each number of Params; a unit is empty if nothing gives it."""
    numbers = numbers_of(author.params)
    said, comments = _metadata(author.params), _comments(author)
    decided = decided_by(author, numbers)
    sizes: dict[str, int] = {}
    for number in numbers:
        field, _ = parsed(number.name)
        sizes[field] = sizes.get(field, 0) + 1
    out: dict[str, dict[str, str]] = {}
    counts: dict[str, int] = {}
    for number in numbers:
        field, places = parsed(number.name)
        k = counts[field] = counts.get(field, -1) + 1
        given, comment, size = said.get(field, {}), comments.get(field, ""), sizes[field]
        unit = _one_of(given.get("unit"), k) or _in_comment(comment, k, size) or decided.unit(number)
        label = field.replace("_", " ")
        if places:
            name = (
                _one_of(given.get("names"), k)
                or _listed(comment, k, size)
                or (size == 2 and decided.axis(number, k))
                or ""
            )
            label = f"{label} {name or k + 1}"
        whole = number.whole and not given.get("unit")
        out[number.name] = {"label": label, "unit": "" if whole else _printed(unit)}
    return out


def _printed(unit: str) -> str:
    for digit, raised in (("2", "²"), ("3", "³"), ("4", "⁴")):
        unit = unit.replace(f"^{digit}", raised)
    return "°" if unit == "deg" else unit


def _one_of(given: Any, k: int) -> str:
    if isinstance(given, str):
        return given
    return str(given[k]) if isinstance(given, tuple | list) and k < len(given) else ""


def _metadata(params: Any) -> dict[str, Mapping[str, Any]]:
    fields = getattr(params, "__dataclass_fields__", {})
    return {name: field.metadata for name, field in fields.items()}


def _comments(author: Author) -> dict[str, str]:
    """Return the comments behind the fields of Params in mechanism.py."""
    try:
        source = mechanism_file(author.name).read_text("utf-8-sig")
        tree = ast.parse(source)
        by_line = {
            token.start[0]: token.string.lstrip("# ")
            for token in tokenize.generate_tokens(io.StringIO(source).readline)
            if token.type == tokenize.COMMENT
        }
    except (OSError, ValueError, SyntaxError, tokenize.TokenError):
        return {}
    return {
        line.target.id: by_line.get(line.end_lineno or line.lineno, "")
        for node in tree.body
        if isinstance(node, ast.ClassDef) and node.name == "Params"
        for line in node.body
        if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name)
    }


def _in_comment(comment: str, k: int, size: int) -> str:
    """Return the unit in a comment: in brackets, as its first word or behind its last comma."""
    bracketed = [unit for unit in re.findall(r"\(([^()]*)\)", comment) if UNIT.fullmatch(unit)]
    if bracketed:
        return bracketed[k] if len(bracketed) == size else bracketed[0] if len(bracketed) == 1 else ""
    for part in (comment.split(";")[0].split(",")[0].strip(), comment.rsplit(",", 1)[-1].strip(), comment.strip()):
        if part in WORDS:
            return WORDS[part]
        if UNIT.fullmatch(part):
            return part
    first = re.match(r"\w+", comment)
    return WORDS.get(first[0], "") if first else ""


def _listed(comment: str, k: int, size: int) -> str:
    """Return the name of a tuple's number k if the comment lists the names; else ""."""
    words = [word.strip() for word in comment.split(",")]
    return words[k] if len(words) == size > 1 and all(re.fullmatch(r"[\w-]+", word) for word in words) else ""
