"""Dimensions that a user names, as a list of :class:`Dimension`.

They are named in the words of ``batch`` and ``change``.

{"crank": 5e-5}                         the length of a bar or a rod
{"D": 2e-5}                             both coordinates of the place of a joint or a traced point, as in ``batch``
{"D": {"x": 1e-5}}                      one of them
{"spring": {"stiffness": 4.0}}          a number that ``change`` takes: of a body, joint, driver, force or contact
{"motor": {"rate": 0.1}}                a number of a law; {"rod": {"B.x": 1e-5}} the place of a joint on a body
{"B": Clearance(3e-5)}                  the play of a pin; beside its place: {"B": {"x": 1e-5, "play": Clearance(3e-5)}}
"m", or "IT9"                           the lengths of all bars and rods
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.derivatives.numbers.variants import size_of, step_of
from mbsd.model.body import Marker
from mbsd.model.change import values_of
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, connections
from mbsd.numbers.names import known_numbers, number_in, place_in
from mbsd.tolerancing.dimensions.clearance import Clearance
from mbsd.tolerancing.dimensions.dimension import Column, Dimension, LoosePlay, PushedPlay, Size
from mbsd.tolerancing.dimensions.spreads import spread_of

PIN, PLAY, TOLERANCES = "revolute", "play", "tolerances"
AXES = ("x", "y")
LEAST_STEP = 1e-6
"""Least step of a difference, as part of the size of a number; see mbsd/derivatives/numbers/variants.py."""
SIZES = ("length", "radius", "diameter", "bore")
"""Parts of the names of arguments that are sizes, by which classes and grades go."""


def dimensions_of(m: Model, sizes: Any) -> list[Dimension]:
    """Return the dimensions of a mechanism.

    Pins whose play follows the reaction are still :class:`LoosePlay`.

    Raises ModelError for names that do not exist and tolerances that cannot be.
    """
    if isinstance(sizes, str):
        sizes = dict.fromkeys(_lengths(m), sizes)
        if not sizes:
            raise ModelError(f"{m.name}: tolerances: there is no bar and no rod; name what strays")
    if not isinstance(sizes, Mapping) or not sizes:
        raise ModelError(
            f"{m.name}: tolerances: sizes are {shown(sizes)}; give names and tolerances, {{'crank': 5e-5}}, or a "
            "class of ISO 2768-1 for all lengths, 'm'"
        )
    out: list[Dimension] = []
    for name, value in sizes.items():
        if isinstance(value, Clearance):
            out.append(_play(m, name, value))
        elif isinstance(value, Mapping):
            out += [
                _play(m, name, part) if key == PLAY else _named(m, name, str(key), part) for key, part in value.items()
            ]
        else:
            out += _plain(m, name, value)
    if not out:
        raise ModelError(f"{m.name}: tolerances: nothing strays; name a length, a place, a mass or a pin with play")
    packed = pack(m)
    return [replace(size, least_step=_least_step(m, packed, size)) if isinstance(size, Size) else size for size in out]


def _least_step(m: Model, packed: Packed, size: Size) -> float:
    """By how much its number is moved for a derivative at least."""
    [column] = size.columns
    number = number_in(m, column.name, column.key or "length", TOLERANCES)
    return step_of(LEAST_STEP, size_of(number, m, packed, (0.0, 1.0)))


def numbers_of(function: str, nominal: Mapping[str, float], sizes: Any) -> list[Dimension]:
    """Return the dimensions of a function with ``nominal`` values of its arguments. Raises ModelError."""
    if not isinstance(sizes, Mapping) or not sizes:
        raise ModelError(f"{function}: tolerances: sizes are {shown(sizes)}; give names and tolerances: {{'a': 5e-5}}")
    out: list[Dimension] = []
    for name, value in sizes.items():
        if name not in nominal:
            raise ModelError(f"{function}: tolerances: {no_such('argument with a number', name, nominal)}")
        if isinstance(value, Clearance | Mapping):
            raise ModelError(f"{function}: tolerances: '{name}' is {shown(value)}; an argument takes a tolerance")
        out.append(_size(function, name, value, Column("number", name, "", nominal[name]), abs(nominal[name]) or None))
    return out


def pushed(dimension: LoosePlay) -> PushedPlay:
    """The same pin, which lies where the reaction pushes it."""
    column = Column("reaction", dimension.label)
    return PushedPlay(dimension.label, (column,), dimension.nominal, clearance=dimension.clearance)


def _lengths(m: Model) -> list[str]:
    bars = [name for name, body in m.bodies.items() if body.length is not None]
    return bars + [name for name, joint in m.joints.items() if _rod(joint)]


def _rod(joint: Joint | None) -> bool:
    return joint is not None and joint.kind.constraints == ("distance",)


def _plain(m: Model, name: Any, value: Any) -> list[Dimension]:
    """A bare tolerance of a name."""
    if name in _lengths(m):
        return [_named(m, name, "length", value)]
    if name in m.traces or name in m.joints:
        return [_named(m, name, axis, value) for axis in AXES]
    every = [*(key for table in connections(m) for key in table), *m.bodies, *m.traces]
    if name not in every or name == "ground":
        known = [*_lengths(m), *m.joints, *m.traces]
        raise ModelError(f"{m.name}: tolerances: {no_such('bar, rod, joint or traced point', name, known)}")
    numbers = [key for key, nominal in (values_of(m, name) or {}).items() if _single(nominal)]
    numbers = numbers or known_numbers(m, name)
    raise ModelError(
        f"{m.name}: tolerances: '{name}' has no length; say which of its numbers strays ({', '.join(numbers)}): "
        f"{{'{name}': {{'{numbers[0]}': {shown(value)}}}}}"
    )


def _named(m: Model, name: Any, key: str, value: Any) -> Dimension:
    """One number of a name."""
    if key in AXES and (name in m.traces or name in m.joints):
        return _coordinate(m, name, key, value)
    known = values_of(m, name)
    if known is None or key not in known:
        return _part(m, name, key, value)
    nominal = known[key]
    if not _single(nominal):
        raise ModelError(
            f"{m.name}: tolerances: {key} of '{name}' is {shown(nominal)}; only a number can stray. Give it one, "
            "or use a function that builds the mechanism"
        )
    kind = "length" if key == "length" and name in _lengths(m) else "argument"
    label = name if kind == "length" else f"{name}.{key}"
    length = nominal if any(word in key for word in SIZES) else None
    return _size(m.name, label, value, Column(kind, name, key, float(nominal)), length)


def _part(m: Model, name: Any, key: str, value: Any) -> Dimension:
    """Return the dimension of a number of a law, a marker, the start or gravity.

    A marker has coordinates by its body, the start an angle or speed, gravity a component.
    """
    every = [*(other for table in connections(m) for other in table), *m.bodies, *m.traces, "gravity"]
    if name not in every:
        raise ModelError(
            f"{m.name}: tolerances: {no_such('body, joint, driver, force, contact or traced point', name, every)}"
        )
    number = number_in(m, name, key, TOLERANCES)
    place = number.marker if key.rpartition(".")[2] in AXES else None
    length = None if place is None else math.hypot(place.x, place.y) or None
    size = _size(m.name, number.name, value, Column("part", name, key, number.value), length)
    if place is not None:
        refuse_beyond(m, f"'{number.name}' strays by", max(map(abs, size.limits)), place)
    return size


def _single(value: Any) -> bool:
    """Return True if it is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _coordinate(m: Model, name: str, axis: str, value: Any) -> Dimension:
    number = place_in(m, name, axis)
    marker, column = number.marker, Column("place", name, axis, number.value)
    assert marker is not None
    size = _size(m.name, f"{name}.{axis}", value, column, math.hypot(marker.x, marker.y) or None)
    refuse_beyond(m, f"'{name}.{axis}' strays by", max(map(abs, size.limits)), marker)
    return size


def _size(owner: str, label: str, value: Any, column: Column, length: float | None) -> Size:
    what = f"{owner}: tolerances: tolerance of '{label}'"
    try:
        spread = spread_of(what, value).at_size(length)
    except ModelError as error:
        said = str(error)
        raise ModelError(said if said.startswith(what) else f"{what}: {said}") from None
    if column.kind not in ("place", "part", "number"):
        _refuse_no_size(owner, label, column, spread)
    return Size(label, (column,), column.nominal, spread=spread)


def _refuse_no_size(owner: str, label: str, column: Column, spread: Any) -> None:
    """Raise ModelError where a length, a mass or a stiffness could pass 0."""
    sign = -1.0 if column.nominal < 0 else 1.0
    closest = sign * (column.nominal + spread.middle) - spread.reach
    if closest > 0.0 or (closest == 0.0 and column.kind == "argument"):
        return
    low, high = spread.limits
    tail = " (a normal distribution reaches further than its tolerance)" if spread.reach > spread.half else ""
    remedy = "narrow it" if not tail else "narrow it, or cut the distribution: Normal(..., cut=True)"
    raise ModelError(
        f"{owner}: tolerances: '{label}' is {column.nominal:g} and strays from {low:g} to {high:+g}{tail}: it "
        f"would pass 0; {remedy}"
    )


def _play(m: Model, name: Any, clearance: Any) -> LoosePlay:
    if not isinstance(clearance, Clearance):
        raise ModelError(f"{m.name}: tolerances: play of '{name}' is {shown(clearance)}; give Clearance(...)")
    if name not in m.joints:
        pins = [key for key, joint in m.joints.items() if joint.kind.name == PIN]
        raise ModelError(f"{m.name}: tolerances: {no_such('pin', name, pins)}")
    if m.joints[name].kind.name != PIN:
        raise ModelError(
            f"{m.name}: tolerances: '{name}' is no pin but a {m.joints[name].kind.name}; play is that of a pin in "
            "its bore"
        )
    for marker in (m.joints[name].i, m.joints[name].j):
        refuse_beyond(
            m, f"the pin of '{name}' lies off its bore's centre by half of its play,", 0.5 * clearance.limits[1], marker
        )
    columns = tuple(Column("bore", name, axis) for axis in AXES)
    return LoosePlay(name, columns, clearance.play, clearance=clearance)


def refuse_beyond(m: Model, what: str, far: float, marker: Marker) -> None:
    """Raise ModelError if ``marker`` strays as far as the farthest other joint of its body.

    ``far`` (m) is its stray. ``what`` says so in words. A body with no other joint has no such
    length.
    """
    reach = _reach(m, marker)
    if reach > 0.0 and far >= reach:
        raise ModelError(
            f"{m.name}: tolerances: {what} up to {far:g} m, and '{marker.body.name}' reaches {reach:g} m from there to "
            "its farthest joint; narrow it. Lengths are in metres: 0.02 mm is 2e-5"
        )


def _reach(m: Model, marker: Marker) -> float:
    """m from a marker to the farthest joint of its body."""
    others = (other for joint in m.joints.values() for other in (joint.i, joint.j) if other.body is marker.body)
    return max((math.hypot(other.x - marker.x, other.y - marker.y) for other in others), default=0.0)
