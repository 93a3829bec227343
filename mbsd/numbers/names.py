"""Numbers of a model by name: what they are now, and the model with another value of them.

crank.length  crank.mass  crank.com.x  rod (a rod's or bar's length)     of bodies and rods
spring.stiffness  motor.rate  push.direction.y                           what change() takes, and numbers of laws
B.x  B.y                             place of a joint: its marker on ground, or else its first
rocker.B.x  B.j.angle                a marker of a joint, force or contact by its body, or by its side
P.x                                  a traced point
door.start.angle  door.moving.omega  start_near and start_moving (rad, m, rad/s, m/s)
gravity.y                            m/s^2
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import partial
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import Marker, rod_inertia
from mbsd.model.change import BAR, BODY, change, given, given_body
from mbsd.model.joint import Joint
from mbsd.model.laws import Motion
from mbsd.model.mechanism import Model, connections, start_given
from mbsd.numbers.saved import SavedModel

AXES = {"x": 0, "y": 1}
PLACE = ("x", "y", "angle")
ROD_ALIKE = 1e-9
"""Relative difference below which a bar's inertia is that of a uniform rod."""
LISTED = 12
"""Numbers of a thing that a message lists."""
START = {"start": ("angle", "x", "y"), "moving": ("omega", "vx", "vy")}
START_METHOD = {"start": "near", "moving": "moving"}


@dataclass(frozen=True)
class Within:
    """Where a number stands in what :func:`mbsd.model.change.change` takes."""

    whole: str
    """The whole name of the changed number."""
    key: str
    """Its argument."""
    path: str
    """The number in the argument, "" where it is the argument itself."""


@dataclass(frozen=True)
class Number:
    """One number of a model."""

    name: str
    value: float
    assign: Callable[[Model, float], None]
    """Gives a model another value of it. Raises ModelError for one that it refuses."""
    built: Callable[[float], Model] | None = None
    """The model with another value, of a number that a function of the author builds models from."""
    within: Within | None = None
    """Its place, if it is a part of what ``change`` takes."""
    marker: Marker | None = None
    """The marker whose coordinate or angle it is."""
    is_place: bool = False
    """True if it is a coordinate, whose origin is anywhere."""
    vector: float = 0.0
    """Length of the vector that it is a component of (SI); 0 of others."""
    reach: float = 0.0
    """Distance of the bounds within which it varies; 0 where there are none."""


def numbers_named(m: Model, names: Sequence[str]) -> list[Number]:
    """The numbers of these names, each once. Raises ModelError for one that there is not."""
    if not names or len(set(names)) < len(names):
        raise ModelError(f"{m.name}: derivatives: give the names of numbers, each once, got {shown(names)}")
    return [number_named(m, name) for name in names]


def number_named(m: Model, name: str) -> Number:
    """The number of this name. Raises ModelError for one that there is not, and for what is no number."""
    if not isinstance(name, str):
        raise ModelError(f"{m.name}: derivatives: {shown(name)} is no name of a number; write 'crank.length'")
    for whole, rest in _splits(name):
        number = _number(m, whole, rest)
        if number is not None:
            return number if number.name == name else replace(number, name=name)
    known = _things(m)
    whole = next((whole for whole, _ in _splits(name) if whole in known), name.partition(".")[0])
    raise _no_number(m, whole, name[len(whole) + 1 :], "derivatives")


def twin_of(number: Number, other: Model, value: float, numbers: Iterable[Number]) -> Number | None:
    """Return the one of ``numbers`` that is ``number`` by another name, with ``value`` in ``other``.

    ``other`` is a model.
    """
    alike = (twin for twin in numbers if twin.value == number.value)
    return next((twin for twin in alike if number_named(other, twin.name).value == value), None)


def number_in(m: Model, whole: str, rest: str, asked: str) -> Number:
    """Return the number ``rest`` of a thing: "x" of a joint.

    Raises ModelError, which says that ``asked`` asked for it.
    """
    number = _number(m, whole, rest)
    if number is None:
        raise _no_number(m, whole, rest, asked)
    return number


def place_in(m: Model, name: str, axis: str) -> Number:
    """Return the coordinate "x" or "y" of a traced point, or of a joint's place. Raises ModelError."""
    if name not in m.traces and name not in m.joints:
        raise ModelError(f"{m.name}: {no_such('joint or traced point', name, [*m.joints, *m.traces])}")
    if name in m.traces:
        return _of_trace(m, name, axis)
    return _of_marker(m, f"{name}.{axis}", name, placed_side(m, m.joints[name]), axis)


def placed_side(m: Model, joint: Joint) -> str:
    """Return "i" or "j", the side whose marker is the place of a joint: that on ground, or else the first."""
    return "i" if joint.i.body is m.ground or joint.j.body is not m.ground else "j"


def lengthened(m: Model, name: str, length: float) -> dict[str, Any]:
    """Return what ``change`` takes for another length (m) of a rod or bar. A uniform rod stays one."""
    out: dict[str, Any] = {"length": length}
    if name in m.joints and m.joints[name].kind.constraints == ("distance",):
        return out
    body = m.known_body(name)
    assert body.length is not None
    if body.com == (body.length / 2, 0.0):
        rod = rod_inertia(body.mass, body.length)
        if "com" not in body.derived:
            out["com"] = length / 2, 0.0
        if "inertia" not in body.derived and body.mass > 0 and abs(body.inertia - rod) <= ROD_ALIKE * rod:
            out["inertia"] = rod_inertia(body.mass, length)
    return out


def _number(m: Model, whole: str, rest: str) -> Number | None:
    if whole == "gravity" and rest in AXES:
        return _gravity(m, AXES[rest])
    own = _of_entry(m, whole, rest) or _of_body(m, whole, rest)
    return own if own is not None or whole not in m.traces or rest not in PLACE else _of_trace(m, whole, rest)


def _things(m: Model) -> list[str]:
    return [*(key for table in connections(m) for key in table), *m.bodies, *m.traces, "gravity"]


def _no_number(m: Model, whole: str, rest: str, asked: str) -> ModelError:
    """Why a thing has no such number."""
    if whole not in _things(m):
        return ModelError(f"{m.name}: {asked}: {no_such('thing with numbers', whole, _things(m))}")
    own = known_numbers(m, whole)
    if not rest:
        more = f"it has some: {', '.join(f'{whole}.{key}' for key in own[:LISTED])}" if own else "it has none"
        return ModelError(f"{m.name}: {asked}: '{whole}' is no number; {more}")
    first = rest.partition(".")[0]
    if whole in m.bodies and first in START and not any(key.startswith(f"{first}.") for key in own):
        return ModelError(
            f"{m.name}: {asked}: '{whole}.{rest}': '{whole}' has no such number before start_{START_METHOD[first]} "
            "gives it"
        )
    return ModelError(f"{m.name}: {asked}: '{whole}': {no_such('number', rest, own)}")


@contextmanager
def with_value(m: Model, number: Number, value: float, saved: SavedModel | None = None) -> Iterator[Model]:
    """Yield the model ``m`` with another value of a number in this context; ``saved``: as it is now."""
    if number.built is not None:
        yield number.built(value)
        return
    saved = saved or SavedModel(m)
    try:
        number.assign(m, value)
        yield m
    finally:
        saved.restore()


def with_values(m: Any, numbers: Sequence[Number], values: Sequence[float]) -> Any:
    """A copy of a model with other values of numbers. Raises ModelError for those that it refuses."""
    out = copy.deepcopy(m)
    put_together(out, numbers, values)
    return out


def changed(m: Model, values: Mapping[str, object]) -> Model:
    """Return a copy of ``m`` with other lengths of bars and rods, and places of joints and traced points.

    A length is one number (m), a place is (x, y) (m).

    A bar's new end moves whatever is at its end, forces included, and a uniform rod stays one; other masses are kept.
    Raises ModelError for a name of none.
    """
    out = copy.deepcopy(m)
    for name, value in values.items():
        if isinstance(value, tuple):
            for axis, coordinate in zip("xy", value, strict=True):
                place_in(out, name, axis).assign(out, coordinate)
        else:
            change(out, name, lengthened(out, name, float(value)))  # pyright: ignore[reportArgumentType]
    return out


def put_together(
    m: Model, numbers: Sequence[Number], values: Sequence[float], changes: Mapping[str, Mapping[str, Any]] | None = None
) -> None:
    """Set other values of numbers in a model in place; ``changes``: other arguments of ``change`` by name.

    All of one thing are changed at once, so that what it refuses are the new numbers alone. Places come last, as the
    end of a bar follows its length. Raises ModelError for what the model refuses.
    """
    together: dict[str, dict[str, Any]] = {whole: dict(own) for whole, own in (changes or {}).items()}
    others: list[tuple[Number, float]] = []
    for number, value in zip(numbers, values, strict=True):
        at = number.within
        if at is None:
            others.append((number, float(value)))
            continue
        own = together.setdefault(at.whole, {})
        own[at.key] = _with_inner(at.path, own[at.key] if at.key in own else _arguments(m, at.whole)[at.key], value)
    for whole, own in together.items():
        change(m, whole, own)
    for number, value in others:
        number.assign(m, value)


def _with_inner(path: str, value: Any, new: float) -> Any:
    """An argument with another number at ``path``."""
    if not path:
        return float(new)
    at = _within(path, value)
    assert at is not None
    return at[1](float(new))


def _arguments(m: Model, whole: str) -> dict[str, Any]:
    """Return the arguments that ``change`` takes, with all values that are known, derived ones, too."""
    out: dict[str, Any] = {}
    if whole in m.bodies:
        body = m.bodies[whole]
        out |= {"mass": body.mass, "inertia": body.inertia, "com": body.com}
        out |= {key: value for key, value in given_body(body).items() if value is not None}
    for table in connections(m):
        if whole in table:
            entry: Any = table[whole]
            out |= {**entry.params, **given(entry)}
    return out


def _inner(name: str, whole: str, key: str, path: str, value: Any) -> Number | None:
    """The number at ``path`` of the argument ``key``, whose value is given."""
    at = _within(path, value)
    if at is None:
        return None
    within = Within(whole, key, path)

    def assign(m: Model, new: float) -> None:
        given_now = None if not path else _arguments(m, whole)[key]
        change(m, whole, {key: _with_inner(path, given_now, new)})

    vector = isinstance(value, tuple | list) and all(map(_is_number, value))
    return Number(
        name, at[0], assign, within=within, is_place=key == "com", vector=math.hypot(*value) if vector else 0.0
    )


def _splits(name: str) -> list[tuple[str, str]]:
    """The name cut in two at none or one of its dots, the longest first part first."""
    cuts = [k for k, letter in enumerate(name) if letter == "."]
    return [(name, ""), *((name[:k], name[k + 1 :]) for k in reversed(cuts))]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _within(path: str, value: Any) -> tuple[float, Callable[[float], Any]] | None:
    """Return the number at ``path`` of a value, and a function that gives the value with another one.

    The value is a number, several, or a law.
    """
    if not path:
        return (float(value), lambda new: new) if _is_number(value) else None
    first, _, rest = path.partition(".")
    if isinstance(value, tuple | list):
        at = AXES.get(first, int(first) if first.isdigit() else -1)
        inner = _within(rest, value[at]) if 0 <= at < len(value) else None
        return inner and (inner[0], lambda new: type(value)([*value[:at], inner[1](new), *value[at + 1 :]]))
    if isinstance(value, Mapping):
        inner = _within(rest, value[first]) if first in value else None
        return inner and (inner[0], lambda new: {**value, first: inner[1](new)})
    if is_dataclass(value) and not isinstance(value, type) and first in {part.name for part in fields(value)}:
        inner = _within(rest, getattr(value, first))
        return inner and (inner[0], lambda new: replace(value, **{first: inner[1](new)}))
    return None


def _of_entry(m: Model, whole: str, rest: str) -> Number | None:
    """The number of a joint, driver, force or contact."""
    table = next((table for table in connections(m) if whole in table), None)
    if table is None:
        return None
    entry: Any = table[whole]
    arguments, name = given(entry), f"{whole}.{rest}"
    rest = rest or ("length" if whole not in m.bodies else "")
    first, _, inner = rest.partition(".")
    if first in arguments:
        return _inner(name, whole, first, inner, arguments[first])
    law = entry.motion if isinstance(entry, Joint) else next(iter(entry.laws.values()), None)
    if law is not None and _within(rest, law) is not None:
        key = next(key for key, value in arguments.items() if value is law)
        return _inner(name, whole, key, rest, law)
    derived = entry.params.get(first)
    if derived is not None and _is_number(derived) and not inner:
        return _inner(name, whole, first, "", derived)
    if first in ("i", "j") and inner in PLACE:
        return _of_marker(m, name, whole, first, inner)
    if rest in PLACE and isinstance(entry, Joint):
        return _of_marker(m, name, whole, placed_side(m, entry), rest)
    return None


def _of_marker(m: Model, name: str, entry: str, side: str, axis: str) -> Number:
    def assign(m: Model, new: float) -> None:
        table: Any = next(table for table in connections(m) if entry in table)
        marker: Marker = getattr(table[entry], side)
        table[entry] = replace(table[entry], **{side: replace(marker, **{axis: float(new)})})

    [marker] = [getattr(table[entry], side) for table in connections(m) if entry in table]
    return Number(name, float(getattr(marker, axis)), assign, marker=marker, is_place=axis in AXES)


def _of_body(m: Model, whole: str, rest: str) -> Number | None:
    if whole not in m.bodies:
        return None
    body, name = m.bodies[whole], f"{whole}.{rest}"
    rest = rest or "length"
    first, _, inner = rest.rpartition(".")
    if first in START and inner in START[first]:
        return _of_start(m, name, whole, first, START[first].index(inner))
    if whole != "ground" and rest.partition(".")[0] in (BODY if body.length is None else BAR):
        key, _, inner = rest.partition(".")
        plain = key in ("mass", "inertia", "com", "length")
        return _inner(name, whole, key, inner, getattr(body, key) if plain else _arguments(m, whole).get(key))
    entry, _, axis = rest.rpartition(".")
    for table in connections(m):
        if entry in table and axis in PLACE:
            ends: Any = table[entry]
            side = next((side for side in ("i", "j") if getattr(ends, side).body is body), None)
            if side is not None:
                return _of_marker(m, name, entry, side, axis)
    return None


def _of_start(m: Model, name: str, body: str, what: str, at: int) -> Number | None:
    given_start: Any = (m.starts if what == "start" else m.velocities).get(body)
    if given_start is None or (at and given_start.place is None):
        return None
    first = "angle" if what == "start" else "omega"

    def assign(m: Model, new: float) -> None:
        if what == "start" and not at:
            start_given(m, body, math.degrees(new))
        table: Any = m.starts if what == "start" else m.velocities
        old = table[body]
        own = {first: float(new)} if not at else {"place": tuple(float(new) if k + 1 == at else value
                                                               for k, value in enumerate(old.place))}  # fmt: skip
        table[body] = replace(old, **own)

    value = float(getattr(given_start, first) if not at else given_start.place[at - 1])
    vector = 0.0 if what == "start" or not at else math.hypot(*given_start.place)
    return Number(name, value, assign, is_place=what == "start" and at > 0, vector=vector)


def _of_trace(m: Model, whole: str, rest: str) -> Number:
    def assign(m: Model, new: float) -> None:
        m.traces[whole] = replace(m.traces[whole], **{rest: float(new)})

    marker = m.traces[whole]
    return Number(f"{whole}.{rest}", float(getattr(marker, rest)), assign, marker=marker, is_place=rest in AXES)


def _gravity(m: Model, axis: int) -> Number:
    def assign(m: Model, new: float) -> None:
        now = m.gravity or (0.0, 0.0)
        m.gravity = (float(new), now[1]) if axis == 0 else (now[0], float(new))

    now = m.gravity or (0.0, 0.0)
    return Number(f"gravity.{'xy'[axis]}", float(now[axis]), assign, vector=math.hypot(*now))


def law_with(m: Model, number: Number) -> Callable[[float], Any] | None:
    """Return a function that gives the law of a number of ``m`` with another value; None without a law."""
    at = number.within
    if at is None or not at.path:
        return None
    law = _arguments(m, at.whole).get(at.key)
    return partial(_with_inner, at.path, law) if isinstance(law, Motion) else None


def numbers_within(law: Any) -> list[str]:
    """Names of the single numbers of a law; none of anything else."""
    if not is_dataclass(law) or isinstance(law, type):
        return []
    return [part.name for part in fields(law) if _is_number(getattr(law, part.name))]


def known_numbers(m: Model, whole: str) -> list[str]:
    """Names of numbers that a thing has, for a message."""
    out: list[str] = []
    for table in connections(m):
        if whole in table:
            entry: Any = table[whole]
            arguments = given(entry)
            out += [key for key, value in arguments.items() if _is_number(value)]
            law = entry.motion if isinstance(entry, Joint) else next(iter(entry.laws.values()), None)
            own = next((key for key, value in arguments.items() if value is law), "")
            out += [f"{own}.{number}" if number in arguments else number for number in numbers_within(law)]
            if isinstance(entry, Joint):
                out += PLACE
            out += [f"{side}.{axis}" for side in ("i", "j") for axis in PLACE]
    if whole in m.bodies and whole != "ground":
        out += ["mass", "inertia", "com.x", "com.y", *(["length"] if m.bodies[whole].length is not None else [])]
    for what, table in (("start", m.starts), ("moving", m.velocities)):
        if whole in table:
            out += [f"{what}.{part}" for part in START[what][: 1 if table[whole].place is None else 3]]
    return out + (list(PLACE) if whole in m.traces else [*AXES] if whole == "gravity" else [])
