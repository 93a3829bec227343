"""One mechanism in other words: its mirror image, other units, other names, another order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.base.errors import ModelError
from mbsd.model.body import Body, Marker
from mbsd.model.mechanism import Start, StartVelocity
from mbsd.saving.document import build, document
from tools.random_mechanisms.described import raised, seen_from

# One mechanism in other words: its mirror image, other units of length and mass, other names.


Dimension = tuple[int, int]
"""Powers of length and mass; times keep their unit."""
LENGTH, RATIO, FORCE, MOMENT, PER_LENGTH = (1, 0), (0, 0), (1, 1), (2, 1), (0, 1)
DIMENSIONS: dict[str, dict[str, Dimension]] = {
    "revolute": {},
    "weld": {},
    "prismatic": {"limits": LENGTH},
    "pin_in_slot": {"limits": LENGTH},
    "distance": {"length": LENGTH},
    "angle_lock": {},
    "gear_pair": {"radius_i": LENGTH, "radius_j": LENGTH, "module": LENGTH, "teeth": RATIO, "phase": RATIO},
    "belt": {"radius_i": LENGTH, "radius_j": LENGTH, "phase": RATIO},
    "cable_span": {"radius_i": LENGTH, "radius_j": LENGTH},
    "slack_span": {"radius_i": LENGTH, "radius_j": LENGTH, "slack": LENGTH, "restitution": RATIO},
    "turn_ratio": {"ratio": RATIO, "together": RATIO},
    "travel_ratio": {"travel": LENGTH, "total": LENGTH},
    "rolling_disc": {"radius": LENGTH, "phase": RATIO},
    "drive_angle": {},
    "drive_relative_angle": {},
    "drive_coordinate": {"law": LENGTH},
    "drive_distance": {"law": LENGTH},
    "spring": {"stiffness": PER_LENGTH, "damping": PER_LENGTH, "free_length": LENGTH},
    "torsion_spring": {"stiffness": MOMENT, "damping": MOMENT, "free_angle": RATIO},
    "torque": {"torque": MOMENT, "law": MOMENT},
    "force": {"force": FORCE, "law": FORCE, "direction": RATIO},
    "rope": {"length": LENGTH, "restitution": RATIO},
    "rigid_contact": {"radius": LENGTH, "restitution": RATIO, "friction": RATIO, "static_friction": RATIO},
}
"""Numbers of the kinds that can be given in other units; ``law``: of all laws and motions."""
TURNED = {"free_angle", "phase", "fires_at", "offset", "direction", "travel", "together"}
"""Numbers that have the other sign in a mirror: angles, and what counts to the left."""
ANGULAR = {"torque", "drive_angle", "drive_relative_angle"}
"""Kinds whose laws have the other sign in a mirror."""
MIRRORED = {
    "revolute", "weld", "prismatic", "pin_in_slot", "distance", "angle_lock", "gear_pair", "belt", "bushing", "spring",
    "torsion_spring", "force", "drive_coordinate", "drive_distance", "gravitation", "rope", "rigid_discs", "gas_cycle",
    "cable_span", "slack_span", "turn_ratio", "travel_ratio",
} | ANGULAR  # fmt: skip
"""Kinds that have no side of their own, as the upper one of a line."""


def mirrored(m: Mechanism) -> Mechanism | None:
    """Return the mirror image about the x axis.

    None where a kind has a side, or a function of the user sees the world.
    """
    if m.events or any(entry.kind.name not in MIRRORED for entry in _entries(m)):
        return None

    def entry_of(entry: Any) -> Any:
        params = {key: _negative(value) if key in TURNED else value for key, value in entry.params.items()}
        for key in params.keys() & {"clockwise", "clockwise_i", "clockwise_j"}:
            params[key] = not params[key]
        if entry.kind.name == "revolute" and params.get("limits") is not None:
            low, high = params["limits"]
            params["limits"] = _negative(high), _negative(low)
        sign = -1.0 if entry.kind.name in ANGULAR else 1.0
        if "torque" in params:
            params["torque"] = _negative(params["torque"])
        return _with_laws(replace(entry, params=params), sign)

    return _rebuilt(m, lambda x, y, angle: (x, -y, -angle), lambda body: (body.mass, body.inertia), entry_of)


def in_units(m: Mechanism, length: float, mass: float) -> Mechanism | None:
    """Return the same with numbers of length and mass so many times as large.

    None where a kind's numbers are not known.
    """
    if m.events or not all(_is_known(entry) for entry in _entries(m)):
        return None

    def factor(dimension: Dimension) -> float:
        return length ** dimension[0] * mass ** dimension[1]

    def entry_of(entry: Any) -> Any:
        own = DIMENSIONS[entry.kind.name]
        params = {key: _times(value, factor(own[key])) if key in own else value for key, value in entry.params.items()}
        return _with_laws(replace(entry, params=params), factor(own.get("law", RATIO)))

    return _rebuilt(
        m,
        lambda x, y, angle: (length * x, length * y, angle),
        lambda body: (mass * body.mass, mass * length**2 * body.inertia),
        entry_of,
    )


def new_names(m: Mechanism) -> dict[str, str]:
    """Return other names for everything, by the old ones, in another order of the alphabet."""
    tables = (m.bodies, m.joints, m.drivers, m.forces, m.contacts, m.traces)
    names = [name for name in dict.fromkeys(name for table in tables for name in table) if name != "ground"]
    return {name: f"{chr(ord('z') - k % 26)} {len(names) - k} {name}" for k, name in enumerate(names)}


def renamed(m: Mechanism) -> Mechanism | None:
    """The same with other names for everything (``new_names``); None where no file could hold the model."""
    new = new_names(m)

    def with_new_names(value: Any) -> Any:
        if isinstance(value, dict):
            return {
                new.get(key, key) if isinstance(inner, dict) else key: with_new_names(inner)
                for key, inner in value.items()
            }
        if isinstance(value, list | tuple):
            return [with_new_names(part) for part in value]
        return new.get(value, value) if isinstance(value, str) else value

    try:
        return build(with_new_names(document(m)), Mechanism)
    except ModelError:
        return None


def _entries(m: Mechanism) -> list[Any]:
    return [*m.joints.values(), *m.drivers.values(), *m.forces.values(), *m.contacts.values()]


def _is_known(entry: Any) -> bool:
    own = DIMENSIONS.get(entry.kind.name)
    if own is None or (entry.kind.name == "revolute" and entry.params.get("limits") is not None):
        return False
    numbers = {key for key, value in entry.params.items() if value is not None and not isinstance(value, bool | str)}
    return numbers <= own.keys() and ("law" in own or not getattr(entry, "laws", {}))


def _rebuilt(
    m: Mechanism,
    frame: Callable[[float, float, float], tuple[float, float, float]],
    inertia: Callable[[Body], tuple[float, float]],
    entry_of: Callable[[Any], Any],
) -> Mechanism:
    """A mechanism of its own, with all frames, masses and entries in other words."""
    out = Mechanism(m.name)
    out.gravity = frame(*(m.gravity or (0.0, 0.0)), 0.0)[:2]
    for name, body in m.bodies.items():
        if name != "ground":
            mass, moment = inertia(body)
            out.bodies[name] = Body(name, m.name, mass, frame(*body.com, 0.0)[:2], moment)

    def marker(old: Marker) -> Marker:
        return out.bodies[old.body.name].at(*frame(old.x, old.y, old.angle))

    for table, new in _tables(m, out):
        for name, entry in table.items():
            new[name] = replace(entry_of(entry), i=marker(entry.i), j=marker(entry.j))
    out.traces.update({name: marker(old) for name, old in m.traces.items()})
    for name, start in m.starts.items():
        x, y, angle = frame(*(start.place or (0.0, 0.0)), start.angle)
        out.starts[name] = Start(angle, None if start.place is None else (x, y))
    for name, velocity in m.velocities.items():
        x, y, omega = frame(*(velocity.place or (0.0, 0.0)), velocity.omega)
        out.velocities[name] = StartVelocity(omega, None if velocity.place is None else (x, y))
    return out


def _tables(m: Mechanism, out: Mechanism) -> list[tuple[Mapping[str, Any], dict[str, Any]]]:
    return [(m.joints, out.joints), (m.drivers, out.drivers), (m.forces, out.forces), (m.contacts, out.contacts)]  # pyright: ignore[reportReturnType]


def _with_laws(entry: Any, factor: float) -> Any:
    if factor == 1.0:
        return entry
    if getattr(entry, "motion", None) is not None:
        return replace(entry, motion=raised(entry.motion, 0.0, factor))
    laws = getattr(entry, "laws", {})
    return replace(entry, laws={key: raised(law, 0.0, factor) for key, law in laws.items()}) if laws else entry


def _times(value: Any, factor: float) -> Any:
    if value is None or isinstance(value, bool | str):
        return value
    if isinstance(value, list | tuple):
        return type(value)(_times(part, factor) for part in value)
    return value if factor == 1.0 else factor * value


def _negative(value: Any) -> Any:
    return _times(value, -1.0)


# One mechanism in other words: its parts in another order, the ends of joints and forces exchanged.


SYMMETRIC = {
    "revolute",
    "weld",
    "distance",
    "angle_lock",
    "prismatic",
    "belt",
    "spring",
    "curve_of_length",
    "gravitation",
    "drive_distance",
    "rope",
}
"""Kinds whose ends may be exchanged as they are; limits change their sign."""


def shuffled(m: Mechanism, rng: np.random.Generator) -> Mechanism:
    """Bodies, joints, drivers and forces in another order."""
    out = seen_from(m, {})
    for name in ("bodies", "joints", "drivers", "forces", "contacts"):
        table = getattr(out, name)
        keys = list(table)
        order = [keys[k] for k in rng.permutation(len(keys))]
        if name == "bodies":
            order = ["ground", *(key for key in order if key != "ground")]
        entries = {key: table[key] for key in order}
        table.clear()
        table.update(entries)
    return out


def exchanged(m: Mechanism, rng: np.random.Generator) -> Mechanism:
    """First and second marker exchanged of half of what allows it."""
    out = seen_from(m, {})
    used = {force.params.get(key) for force in out.forces.values() for key in ("joint", "valve")}
    for table in (out.joints, out.drivers, out.forces, out.contacts):
        for name, joint in table.items():
            if rng.random() < 0.5 and name not in used:
                table[name] = _turned_round(joint)
    return out


def _turned_round(joint: Any) -> Any:
    """The same joint or force with its ends exchanged; as it is where the kind does not allow it."""
    params, kind = dict(joint.params), joint.kind.name
    if kind == "drive_relative_angle":
        return replace(joint, i=joint.j, j=joint.i, motion=raised(joint.motion, 0.0, sign=-1.0))
    if kind == "torsion_spring" and "free_angle" not in joint.laws:
        params["free_angle"] = -params.get("free_angle", 0.0)
        return replace(joint, i=joint.j, j=joint.i, params=params)
    if kind in ("gear_pair", "rigid_discs"):
        if params.get("internal") or params.get("inside"):
            return joint
    elif kind not in SYMMETRIC:
        return joint
    if "radius_i" in params:
        params["radius_i"], params["radius_j"] = params["radius_j"], params["radius_i"]
    for pair in ("teeth", "phase"):
        if params.get(pair) is not None:
            params[pair] = tuple(reversed(params[pair]))
    if params.get("limits") is not None:
        low, high = params["limits"]
        params["limits"] = (None if high is None else -high, None if low is None else -low)
    return replace(joint, i=joint.j, j=joint.i, params=params)
