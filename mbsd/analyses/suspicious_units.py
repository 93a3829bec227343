"""Suspicious values that are allowed, with a remedy: a mixed-up unit, a start that contradicts itself.

Only values that are off by more than mechanisms ever are count: sizes a hundredfold apart, masses 1e5 apart, an inertia
whose radius of gyration is 20 sizes, marker angles of whole degrees beyond a turn. Silence proves nothing.

Sides of a joint or force may lie in different planes z. A pin, a guide or a weld may be as long as it must. Teeth,
cams, rolling bodies and contacts touch in one plane, and a rod or a spring between two planes would be inclined, which
planar equations do not know.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from mbsd.analyses.findings import Finding
from mbsd.base.codes import LINE
from mbsd.base.errors import ModelWarning
from mbsd.base.warning import warn
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model

ONE_PLANE = 1e-9
"""Places nearer than this are one plane (m)."""


def apart(m: Model) -> Iterator[tuple[str, str, float, float]]:
    """Yield names and kinds whose sides must share a plane and do not, with both positions z (m)."""
    for part in (*m.joints.values(), *m.drivers.values(), *m.contacts.values(), *m.forces.values()):
        i, j = _plane(m, part.i), _plane(m, part.j)
        if i is not None and j is not None and abs(i - j) > ONE_PLANE and _needs_one(part):
            yield part.name, part.kind.name, i, j


def _plane(m: Model, marker: Marker) -> float | None:
    return None if marker.z is None and marker.body is m.ground else marker.plane


def _needs_one(part: Joint | Force) -> bool:
    if isinstance(part, Force):
        return any(element.kind == LINE for element in part.kind.elements(part))
    return part.kind.touching != "" or bool({"distance", "gear"} & set(part.kind.constraints))


LEAST_PRESSURE = 1000.0
"""Pa: a hundredth of the air's. Less is a pressure in bar, or a vacuum that nobody needs to give a number."""
STEEL = 2.1e11
"""Young's modulus of steel (Pa)."""
LOOSE = 0.1
"""Part of a bearing's radius: a running fit has about a thousandth, and worn joints some hundredths."""
THICK_BAR = 0.1
"""A spring that is stiffer than a solid steel bar as long as the mechanism and this part of it thick is none."""


def pressures(m: Model) -> Iterator[Finding]:
    """Pressures between nothing and a hundredth of the air's."""
    for name, force in m.forces.items():
        for word, value in force.given.items():
            if (
                "pressure" in word
                and word != "pressure_angle"
                and isinstance(value, int | float)
                and 0.0 < value < LEAST_PRESSURE
            ):
                yield Finding(
                    f"force '{name}'", f"{word} is {value:g} Pa, where the air has 101325",
                    "Pressures are in pascal: multiply bar by 1e5",
                )  # fmt: skip


def springs(m: Model, size: float) -> Iterator[Finding]:
    """Springs that are stiffer than a solid bar; ``size`` (m) is the mechanism's."""
    most = STEEL * THICK_BAR**2 * size
    for name, force in m.forces.items():
        stiffness = force.params.get("stiffness")
        if "free_length" in force.params and isinstance(stiffness, int | float) and stiffness > most > 0.0:
            yield Finding(
                f"spring '{name}'",
                f"its stiffness of {stiffness:.3g} N/m is more than that of a steel bar as long as the mechanism and a "
                f"tenth as thick ({most:.1e} N/m)",
                "Stiffness is in N/m: N/mm are multiplied by 1000. What does not give way is m.distance or m.weld",
            )


def plays(m: Model) -> Iterator[Finding]:
    """Bearings in which the journal has much room."""
    for name, force in m.forces.items():
        if force.kind.journal is None:
            continue
        radius, clearance = force.kind.journal(force)
        if clearance > LOOSE * (radius + clearance):
            yield Finding(
                f"force '{name}'",
                f"its clearance of {clearance:g} m is {clearance / (radius + clearance):.0%} of the bearing's radius",
                "Clearance and radius are in metres: 0.1 mm is 0.1e-3; a running fit has about a thousandth of the "
                "radius",
            )


def welds(m: Model) -> Iterator[Finding]:
    """Welds between two bodies that another joint connects as well."""
    pairs: dict[frozenset[str], list[str]] = {}
    for name, joint in m.joints.items():
        pairs.setdefault(frozenset(joint.bodies), []).append(name)
    for name, joint in m.joints.items():
        others = [other for other in pairs[frozenset(joint.bodies)] if other != name]
        if {"point", "angle"} <= set(joint.kind.constraints) and others:
            first, second = joint.bodies
            yield Finding(
                f"weld '{name}'",
                f"it fixes '{second}' to '{first}', which '{others[0]}' connects as well and then lets nothing move",
                "Leave one of the two joints out",
            )


SIZE_GAP = 100.0
"""Between neighbours in the sorted list of sizes; millimetres taken for metres are 1000 apart."""
MASS_GAP = 1e5
"""Between neighbours in the sorted list of masses."""
WIDEST_GYRATION = 20.0
"""Radius of gyration over size. There is no lower bound: a point mass has none, and tiny inertias stand for zero."""
FARTHEST = 30.0
"""Centre of mass or traced point from the body's joints, over the larger of the body's and the mechanism's size."""
SAME = 1e-9
"""Places closer than this part of the largest number are equal but for rounding."""
LARGE, THIN = 10.0, 0.05
"""A body larger than this (m) and lighter than this (kg/m) is a wire, or millimetres."""
WIDE_BORE, FAST = 1.0, 50.0
"""Bore over the length of a cylinder that is fully in, and speed of its piston at its rated flow (m/s), beyond which
they are not metres or not m^3/s."""
TURNS = 2.0
"""A marker or law turned by more turns than this, in whole degrees, was meant in degrees."""


def check(m: Model) -> list[Finding]:
    """Everything in ``m`` that looks like a mixed-up unit, in the order of the checks above."""
    sizes = body_sizes(m)
    lengths = list(_lengths_and_gravity(m, sizes))
    return [
        *lengths,
        *_masses(m),
        *_mass_properties(m, sizes),
        *_trace_places(m, sizes),
        *_marker_angles(m),
        *_law_angles(m),
        *_start_angles(m),
        *_world_places(m),
        *(() if lengths else _assemblies(m)),  # links of the wrong lengths close in no way that is meant
        *_planes(m),
        *_hydraulics(m),
        *pressures(m),
        *plays(m),
        *springs(m, max(sizes.values(), default=0.0)),
        *welds(m),
    ]


def tell(m: Model) -> None:
    """Warn of every finding, once in the life of a mechanism; the warning points at the user's line."""
    if m.findings_told:
        return
    m.findings_told = True
    for finding in check(m):
        warn(f"{m.name}: {finding}", ModelWarning)


def body_sizes(m: Model) -> dict[str, float]:
    """Return the usual distance (m) between joints of each body, or a bar's length; 0 if unknown."""
    places: dict[str, list[tuple[float, float]]] = {name: [] for name in m.bodies}
    for joint in m.joints.values():
        for marker in (joint.i, joint.j):
            places[marker.body.name].append((marker.x, marker.y))
    numbers = [number for rows in places.values() for row in rows for number in row]
    numbers += [body.length or 0.0 for body in m.bodies.values()]
    same = SAME * max(map(abs, numbers), default=0.0)
    return {name: max(_spacing(places[name], same), body.length or 0.0) for name, body in m.bodies.items()}


def _spacing(places: list[tuple[float, float]], same: float) -> float:
    """Median step from each place to the next: what it is measured in shows, how many there are does not.

    Places within ``same`` (m) are one.
    """
    if len(places) < 2:
        return 0.0
    steps = np.hypot(*np.diff(np.array(places), axis=0).T)
    return float(np.median(steps[steps > same])) if (steps > same).any() else 0.0


def _lengths_and_gravity(m: Model, sizes: dict[str, float]) -> Iterator[Finding]:
    """One finding where the whole model is in millimetres, or one for each number that stands out."""
    lengths = sizes | {f"joint {name}": float(j.params.get("length", 0.0)) for name, j in m.joints.items()}
    odd, usual = _odd_ones_out(lengths, SIZE_GAP)
    gravity = list(_gravity(m))
    wires = [
        name
        for name, body in m.bodies.items()
        if name not in odd and sizes[name] > LARGE and 0 < body.mass < THIN * sizes[name]
    ]
    others = [size for name, size in sizes.items() if size > 0 and name not in odd]
    whole = len(others) > 1 and len(wires) > 0 and float(np.median(others)) > LARGE
    if whole:
        masses = sorted({f"{m.bodies[name].mass:.3g}" for name in wires}, key=float)
        yield Finding(
            "lengths",
            f"they look like millimetres: bodies are {_metres(float(np.median(others)))} long, and {_some(wires)} of "
            f"{' .. '.join(dict.fromkeys((masses[0], masses[-1])))} kg would be wires"
            + (", gravity looks like mm/s^2" if gravity else ""),
            "Lengths are in metres: divide all of them by 1000" + (", and gravity" if gravity else ""),
        )
    else:
        yield from gravity
    for name in odd:
        yield Finding(
            name,
            f"{_metres(lengths[name])} long beside {_metres(usual)} of the others",
            "Lengths are in metres: divide millimetres by 1000",
        )
    for name in [] if whole else wires:
        yield Finding(
            name,
            f"{_metres(sizes[name])} long and {m.bodies[name].mass:g} kg heavy, a wire",
            "Lengths are in metres: divide millimetres by 1000",
        )


def _some(names: list[str]) -> str:
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _gravity(m: Model) -> Iterator[Finding]:
    size = math.hypot(*(m.gravity or (0.0, 0.0)))
    for unit, factor in (("mm/s^2", 1e3), ("cm/s^2", 1e2)):
        if 9.7 < size / factor < 9.9:
            yield Finding("gravity", f"{size:g} m/s^2 looks like {unit}", f"Gravity is in m/s^2: {size / factor:g}")


def _odd_ones_out(values: dict[str, float], gap: float) -> tuple[list[str], float]:
    """Return the smaller group of names beyond a leap by ``gap``, and a typical value of the others."""
    names = sorted((name for name, value in values.items() if value > 0), key=lambda name: values[name])
    for k in range(1, len(names)):
        if values[names[k]] >= gap * values[names[k - 1]]:
            odd, usual = (names[k:], names[:k]) if len(names) - k <= k else (names[:k], names[k:])
            return odd, float(np.median([values[name] for name in usual]))
    return [], 0.0


def _masses(m: Model) -> Iterator[Finding]:
    masses = {name: body.mass for name, body in m.bodies.items()}
    odd, usual = _odd_ones_out(masses, MASS_GAP)
    for name in odd:
        yield Finding(
            name,
            f"{masses[name]:g} kg beside {usual:g} kg of the others",
            "Masses are in kilograms: divide grams by 1000; leave a mass out to neglect it",
        )


def _mass_properties(m: Model, sizes: dict[str, float]) -> Iterator[Finding]:
    whole = float(np.median([size for size in sizes.values() if size > 0] or [0.0]))
    for name, body in m.bodies.items():
        size = max(sizes[name], whole)
        if body.mass == 0 or size == 0:
            continue
        away = _joint_distance(m, body, body.com)
        if away > FARTHEST * size:
            yield Finding(
                name,
                f"its centre of mass is {_metres(away)} from its joints, {away / size:.3g} times its size",
                "com is in metres, in the body's own frame",
            )
            continue
        gyration = math.sqrt(body.inertia / body.mass)
        reach = max(size, away)
        if gyration > WIDEST_GYRATION * reach:
            yield Finding(
                name,
                f"inertia {body.inertia:g} kg m^2 and mass {body.mass:g} kg make a radius of gyration of "
                f"{_metres(gyration)} on a body of {_metres(reach)}",
                "Inertia is about the centre of mass in kg m^2: kg mm^2 times 1e-6, g mm^2 times 1e-9; "
                f"a slender rod has {body.mass * reach**2 / 12:.3g}",
            )


def _joint_distance(m: Model, body: Body, place: tuple[float, float]) -> float:
    """From a place (m, body frame) to the nearest joint of the body (m), 0 without joints."""
    markers = [marker for j in m.joints.values() for marker in (j.i, j.j) if marker.body is body]
    return min((math.hypot(k.x - place[0], k.y - place[1]) for k in markers), default=0.0)


def _trace_places(m: Model, sizes: dict[str, float]) -> Iterator[Finding]:
    """Traced points as far from their body's joints as only another unit explains."""
    whole = float(np.median([size for size in sizes.values() if size > 0] or [0.0]))
    for name, marker in m.traces.items():
        size = max(sizes[marker.body.name], whole)
        away = _joint_distance(m, marker.body, (marker.x, marker.y))
        if size > 0 and away > FARTHEST * size:
            yield Finding(
                f"trace {name}",
                f"its point ({marker.x:g}, {marker.y:g}) on {marker.body.name} is {_metres(away)} from the joints of a "
                f"body of {_metres(size)}",
                "Places are in metres: divide millimetres by 1000",
            )


def _marker_angles(m: Model) -> Iterator[Finding]:
    named: list[tuple[str, Marker]] = [(f"trace {name}", marker) for name, marker in m.traces.items()]
    for joint in (*m.joints.values(), *m.drivers.values(), *m.forces.values()):
        named += [(joint.name, joint.i), (joint.name, joint.j)]
    for name, marker in named:
        if _in_degrees(marker.angle, 1.0):
            yield Finding(
                name,
                f"its marker on {marker.body.name} is turned by {marker.angle:g} rad",
                f"Marker angles are in radians: write math.radians({marker.angle:g})",
            )


def _law_angles(m: Model) -> Iterator[Finding]:
    for driver in m.drivers.values():
        if not _angular(driver):
            continue
        for word in ("start", "amplitude", "phase", "mean", "rise"):
            value = getattr(driver.motion, word, 0.0)
            if isinstance(value, float) and _in_degrees(value, TURNS):
                yield Finding(
                    driver.name,
                    f"{word} of its law is {value:g} rad, {abs(value) / (2 * math.pi):.3g} turns",
                    f"Laws of angles are in radians: write math.radians({value:g})",
                )


def _start_angles(m: Model) -> Iterator[Finding]:
    for name, start in m.starts.items():
        degrees = math.degrees(start.angle)
        twelfths = degrees / (math.pi / 12)
        near = round(twelfths)
        if 0 < abs(near) <= 24 and abs(100 * degrees - round(100 * degrees)) > 1e-6 and abs(twelfths - near) < 1e-3:
            yield Finding(
                name,
                f"start_near({name}={degrees:g}) is {degrees:g} degrees, and {15 * near} degrees in radians",
                f"start_near takes degrees: write {15 * near} if that is meant",
            )


def _world_places(m: Model) -> Iterator[Finding]:
    if not m.world_markers:
        return
    from mbsd.kinematics.pose.world_places import moved_markers

    for marker, (x, y, angle), (x_now, y_now) in moved_markers(m):
        there = f"at ({x_now:.6g}, {y_now:.6g}) m"
        if f"{x_now:.6g} {y_now:.6g}" == f"{x:.6g} {y:.6g}":
            there = "turned otherwise"
        yield Finding(
            marker.body.name,
            f"the marker of at_world({x:g}, {y:g}, {angle:g}) is {there} at the start",
            "Call at_world after start_near and after the joints and drivers that place the body",
        )


def _assemblies(m: Model) -> Iterator[Finding]:
    """A start that may be meant otherwise."""
    from mbsd.kinematics.pose.twins import twin

    second_assembly = twin(m)
    if second_assembly is not None:
        name = second_assembly.body
        taken, other = (f"{math.degrees(angle):.4g}" for angle in (second_assembly.taken, second_assembly.other))
        yield Finding(
            name,
            f"the links close in two ways that are as near to where they were put: with {name} at {taken} degrees, "
            f"which is taken, and at {other} degrees",
            f"Say which is meant: start_near({name}={taken}) or start_near({name}={other})",
        )


def _planes(m: Model) -> Iterator[Finding]:
    if all(body.z is None for body in m.bodies.values()):
        return

    for name, kind, i, j in apart(m):
        yield Finding(
            name,
            f"its sides lie in the planes z = {i:g} m and z = {j:g} m, and a {kind.replace('_', ' ')} acts in one",
            "Give both bodies the same z, or one of its markers a z of its own: body.at(x, y, z=...)",
        )


def _hydraulics(m: Model) -> Iterator[Finding]:
    for name, force in m.forces.items():
        if force.kind.oil is None:
            continue
        oil, p = force.kind.oil(force), force.params
        if p["bore"] > WIDE_BORE * p["retracted"]:
            yield Finding(
                name,
                f"its bore is {_metres(p['bore'])}, and fully in it is {_metres(p['retracted'])} long",
                "bore, rod, stroke and retracted are in metres: divide millimetres by 1000",
            )
        flow = oil.conductance * float(oil.orifice(np.array(p["rated_drop"])))
        if flow > FAST * oil.area_a:
            yield Finding(
                name,
                f"its valve lets {flow:.3g} m^3/s through at {p['rated_drop']:g} Pa, which moves the piston at "
                f"{flow / oil.area_a:.3g} m/s",
                "rated_flow is in m^3/s: divide litres a minute by 60000; orifice is in m^2",
            )


def _angular(driver: Joint) -> bool:
    return driver.kind.units[1] == "rad"


def _in_degrees(angle: float, turns: float) -> bool:
    """Whole degrees, and more turns than an angle in radians has a reason for."""
    return abs(angle) > turns * 2 * math.pi and angle == round(angle)


def _metres(length: float) -> str:
    return f"{length * 1000:.3g} mm" if length < 1 else f"{length:.4g} m"
