"""Consistency of a file beyond its types: units, lengths, times, names and files fit together.

Each function raises UserError naming the file and the field. ``path`` is the file's, for the message.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from shared.stage.errors import UserError

if TYPE_CHECKING:
    from shared.contract import Motion, Motion3, Mount, Parts
    from shared.contract.motion import BodyMotion
    from shared.contract.space import BodyMotion3

SPAN_TOLERANCE = 1e-9
"""Largest difference between the period and the time spanned, relative."""
RETURN_TOLERANCE = 1e-5
"""Largest difference between the poses at both ends of a period (m or rad, relative above 1)."""
UNIT_TOLERANCE = 1e-9
"""Tolerance of the length of a unit vector."""
_NO_SERIES = {"redundant", "events", "start_changes", "notes", "shape", "indicated_work", "order", "harmonics"}
"""Fields with lists that are not of time."""
PLANE, PLACE, QUATERNION = ("x", "y", "theta"), ("x", "y", "z"), ("qw", "qx", "qy", "qz")
"""Series that place a body, in the plane and in space."""
_UNFIT = re.compile(r"[/\\\x00-\x1f\x7f]")
"""Characters that no name of a body, joint, driver or point may hold, as files are named after it."""


def refuse_other_words(field: str, words: Mapping[str, str], expected: Mapping[str, str], path: Path | str) -> None:
    """Raise UserError for units (or conventions) that this program does not read."""
    for key in sorted(expected.keys() | words.keys()):
        if words.get(key) != expected.get(key):
            said = repr(words[key]) if key in words else "missing"
            reads = repr(expected[key]) if key in expected else "nothing of that name"
            raise UserError(f"{path}: {field}.{key} is {said}, this program reads {reads}; make the file again")


def refuse_inconsistent_motion(motion: Motion | Motion3, path: Path | str) -> None:
    """Raise UserError for inconsistent series, times, period or bodies.

    Series must not be ragged, times must rise, the period must be the time spanned, and bodies must be known.
    """
    _refuse_ragged(motion, path)
    named = ("bodies", "joints", "drivers", "points", "forces", "contacts")
    _refuse_unfit_names({field: getattr(motion, field, {}) for field in named}, path)
    known = {"ground", *motion.bodies}
    if "ground" in motion.bodies:
        raise UserError(f"{path}: bodies has 'ground', which does not move; leave it out")
    used = [(f"joints.{name}.bodies", body) for name, joint in motion.joints.items() for body in joint.bodies]
    used += [(f"points.{name}.body", point.body) for name, point in motion.points.items()]
    used += _bodies_in_space(motion) if motion.schema_version == 4 else _bodies_of_loads(motion)
    for field, body in used:
        if body not in known:
            raise UserError(f"{path}: {field} names '{body}', which is no body; there is: {', '.join(sorted(known))}")
    _refuse_wrong_period(motion, path)
    _refuse_wrong_events(motion, path)
    if motion.schema_version == 4:
        _refuse_unknown_joints(motion, path)
    if motion.schema_version == 1:
        newer = [field for field in ("forces", "contacts", "start_changes") if getattr(motion, field)]
        if newer:
            raise UserError(f"{path}: schema_version is 1, which has no {newer[0]}; make the file again")


def refuse_inconsistent_parts(parts: Parts, path: Path | str) -> None:
    """Raise UserError for inconsistent names, files, heights or bodies of parts.

    Names must be fit, files must be beside parts.json by their names, the lowest height comes first, bodies without
    solids have none, and pairs of bodies must exist.
    """
    refuse_wrong_mount(parts.mount, f"{path}: mount")
    _refuse_unfit_names({"bodies": parts.bodies, "without_solids": parts.without_solids}, path)
    for body in parts.without_solids:
        if body in parts.bodies:
            raise UserError(f"{path}: without_solids names '{body}', which has solids; remove it from one of the two")
    for index, pair in enumerate(parts.may_touch):
        for body in pair:
            if body not in parts.bodies or pair[0] == pair[1]:
                raise UserError(
                    f"{path}: may_touch[{index}] is {' and '.join(pair)}; it must name two bodies that have solids: "
                    f"{', '.join(parts.bodies)}"
                )
    home = {name: body for body, solids in parts.bodies.items() for name in solids.pieces}
    for index, (first, second) in enumerate(parts.pieces_may_touch):
        if first not in home or second not in home or home[first] == home[second]:
            raise UserError(
                f"{path}: pieces_may_touch[{index}] is {first} and {second}; it must name pieces of two bodies"
            )
    seen: dict[str, str] = {}
    for body, solids in parts.bodies.items():
        for name, piece in solids.pieces.items():
            field = f"bodies.{body}.pieces.{name}"
            _refuse_unfit_names({f"bodies.{body}.pieces": [name]}, path)
            for kind, file in (("stl", piece.stl), ("step", piece.step)):
                if not file or _UNFIT.search(file) or file in (".", ".."):
                    raise UserError(f"{path}: {field}.{kind} is {file!r}; it must name a file beside parts.json")
                if file in seen:
                    raise UserError(f"{path}: {field}.{kind} names {file}, as {seen[file]} does")
                seen[file] = f"{field}.{kind}"
            if piece.z_range[0] > piece.z_range[1]:
                raise UserError(f"{path}: {field}.z_range is {list(piece.z_range)}; the lowest point comes first")


def refuse_wrong_mount(mount: Mount, where: str) -> None:
    """Raise UserError for a wrong direction up: z on a desk, else a unit vector in the plane."""
    x, y, z = mount.up
    if mount.kind == "bench":
        if (x, y, z) != (0.0, 0.0, 1.0) and not (z == 0.0 and abs(math.hypot(x, y) - 1.0) < UNIT_TOLERANCE):
            raise UserError(
                f"{where}: up is ({x:g}, {y:g}, {z:g}); on a bench it is (0, 0, 1), or a unit vector of x, y"
            )
        return
    if mount.kind == "desk" and (x, y, z) != (0.0, 0.0, 1.0):
        raise UserError(f"{where}: up is ({x:g}, {y:g}, {z:g}); on a desk it is (0, 0, 1)")
    if mount.kind != "desk" and not (z == 0.0 and abs(math.hypot(x, y) - 1.0) < UNIT_TOLERANCE):
        raise UserError(f"{where}: up is ({x:g}, {y:g}, {z:g}); what stands has a unit vector in the plane, z = 0")


def _bodies_of_loads(motion: Motion) -> list[tuple[str, str]]:
    """Return the fields of forces, contacts and shapes that name a body, each with that name."""
    used = [(f"contacts.{name}.bodies", body) for name, contact in motion.contacts.items() for body in contact.bodies]
    used += [
        (f"drivers.{name}.bodies", body) for name, driver in motion.drivers.items() for body in driver.bodies or ()
    ]
    used += [
        (f"drivers.{name}.actions[{k}].body", action.body)
        for name, driver in motion.drivers.items()
        for k, action in enumerate(driver.actions)
    ]
    for name, force in motion.forces.items():
        used += [(f"forces.{name}.actions[{k}].body", action.body) for k, action in enumerate(force.actions)]
        if force.gas is not None and force.gas.crank is not None:
            used.append((f"forces.{name}.gas.crank", force.gas.crank))
    for field in ("joints", "drivers", "forces", "contacts"):
        for name, load in getattr(motion, field).items():
            if load.shape is not None:
                used += [(f"{field}.{name}.shape.bodies", body) for body in load.shape.bodies]
    return used


def _bodies_in_space(motion: Motion3) -> list[tuple[str, str]]:
    """Return the fields of forces and drivers in space that name a body, each with that name."""
    loads = [
        (f"{field}.{name}.bodies", load)
        for field in ("drivers", "forces")
        for name, load in getattr(motion, field).items()
    ]
    return [(field, body) for field, load in loads for body in load.bodies]


def _refuse_unknown_joints(motion: Motion3, path: Path | str) -> None:
    """Raise UserError for a driver whose joint does not exist."""
    for name, driver in motion.drivers.items():
        if driver.joint is not None and driver.joint not in motion.joints:
            raise UserError(
                f"{path}: drivers.{name}.joint names '{driver.joint}', which does not exist; there is: "
                f"{', '.join(motion.joints) or 'none'}"
            )


def _refuse_wrong_events(motion: Motion | Motion3, path: Path | str) -> None:
    """Raise UserError unless events are in the order of their times, within the motion."""
    first, last = motion.time[0], motion.time[-1]
    for index, event in enumerate(motion.events):
        before = motion.events[index - 1].time if index else first
        if not before <= event.time <= last:
            raise UserError(
                f"{path}: events[{index}] '{event.name}' is at {event.time:.9g} s; events come in the order of their "
                f"times, here within {before:.9g} .. {last:.9g} s"
            )


def _refuse_unfit_names(names: Mapping[str, Iterable[str]], path: Path | str) -> None:
    for field, given in names.items():
        for name in given:
            if not name or _UNFIT.search(name) or name.startswith("."):
                raise UserError(
                    f"{path}: {field} has the name {name!r}; files are named after it, so it must not be empty, begin "
                    "with a dot, or hold slashes, backslashes or control characters"
                )


def _refuse_ragged(motion: Motion | Motion3, path: Path | str) -> None:
    """Raise UserError unless every series is as long as ``time``.

    Time has two values or more and grows, but for both rows of an event.
    """
    count = len(motion.time)
    if count < 2:
        raise UserError(f"{path}: time has {count} values; a motion needs two or more")
    for field, series in _series(motion, ""):
        if len(series) != count:
            raise UserError(f"{path}: {field} has {len(series)} values, time has {count}")
    if motion.time[0] == motion.time[-1]:
        raise UserError(f"{path}: time[0] and time[-1] are both {motion.time[0]}; a motion needs two different times")
    happened = {event.time for event in motion.events}
    for index in range(1, count):
        before, now = motion.time[index - 1 : index + 1]
        if now < before or (now == before and now not in happened):
            raise UserError(
                f"{path}: time[{index}] = {now} does not come after the value before it, and no event has that time. "
                "Only right before and after an event may two rows share a time"
            )
        if now == before:
            _refuse_leap(motion, index, path)


def _refuse_leap(motion: Motion | Motion3, index: int, path: Path | str) -> None:
    """Raise UserError if a pose jumps at an event; velocities may."""
    for name, body in motion.bodies.items():
        for field, series in _pose(body):
            before, now = series[index - 1 : index + 1]
            if abs(now - before) > RETURN_TOLERANCE * max(1.0, abs(before)):
                raise UserError(
                    f"{path}: bodies.{name}.{field} jumps from {before:.6g} to {now:.6g} at the event of "
                    f"{motion.time[index]:.6g} s; velocities may jump there, poses may not"
                )


def _refuse_wrong_period(motion: Motion | Motion3, path: Path | str) -> None:
    """Raise UserError unless the period is the time spanned, and every pose returns after it.

    Angles may differ by whole turns.
    """
    if motion.period is None:
        return
    span = motion.time[-1] - motion.time[0]
    if abs(motion.period - span) > SPAN_TOLERANCE * span:
        raise UserError(
            f"{path}: period is {motion.period:.9g} s, time spans {span:.9g} s; a period is the time spanned, "
            "or null for a motion that does not repeat"
        )
    for name, body in motion.bodies.items():
        sign = _sign_after_period(body)
        for field, series in _pose(body):
            gap = (sign if field in QUATERNION else 1.0) * series[-1] - series[0]
            if field == "theta":
                gap = math.remainder(gap, math.tau)
            if abs(gap) > RETURN_TOLERANCE * max(1.0, abs(series[0])):
                raise UserError(
                    f"{path}: bodies.{name}.{field} begins at {series[0]:.6g} and ends at {series[-1]:.6g}, though "
                    f"period is {motion.period:.6g} s; make it null for a motion that does not repeat"
                )


def _pose(body: BodyMotion | BodyMotion3) -> list[tuple[str, list[float]]]:
    """Return the series that place a body, with their fields."""
    fields = PLANE if hasattr(body, "theta") else (*PLACE, *QUATERNION)
    return [(field, getattr(body, field)) for field in fields]


def _sign_after_period(body: BodyMotion | BodyMotion3) -> float:
    """Return -1 where a quaternion at the end of a period is nearer to the negative one of its start, else 1."""
    if hasattr(body, "theta"):
        return 1.0
    return math.copysign(1.0, sum(series[0] * series[-1] for field, series in _pose(body) if field in QUATERNION))


def _series(value: Any, field: str) -> Iterator[tuple[str, list[Any]]]:
    """Yield all lists that have a value for each time, with their fields."""
    if isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            if name not in _NO_SERIES:
                yield from _series(getattr(value, name), f"{field}.{name}" if field else name)
    elif isinstance(value, dict):
        for name, item in value.items():
            yield from _series(item, f"{field}.{name}")
    elif isinstance(value, list) and field.endswith((".actions", ".rows")):
        for index, item in enumerate(value):
            yield from _series(item, f"{field}[{index}]")
    elif isinstance(value, list):
        yield field, value
