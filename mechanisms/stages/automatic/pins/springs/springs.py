"""Springs, dampers, actuators and ropes between two points: the room in which the film draws them, and studs at both
ends. A driver of a distance is an actuator, too.

What stretches has a layer of its own, over both of its bodies where there is an order of layers that allows it. Its
barrel is thicker than a layer, so it takes a part of the gaps beside its own.

    radius    of a coil, 9 rmm, at most 0.17 of its least length; 0.6 of that for cylinders and rods
    barrel    from 0.1 to 0.9 of the way between the ends; beyond it a wire or rod on the axis
    rope      the triangle of its ends and the corner to which the tangents of its parabola go; a line where it is taut
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import LINEAR, ROPE, stretching
from mechanisms.stages.automatic.layout.features import contact_kind, driver_kind, force_kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.pins.pins import SAME, Pin
from mechanisms.stages.automatic.pins.springs.stretching import BALL, Stretching, Stud

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

RADIUS, BROAD = 9.0, 0.17
"""Radius of a coil's middle line: at most (rmm), and at most as a part of its least length."""
WIRE, CYLINDER = 0.2, 0.6
"""Radius of the wire, and of a cylinder, in radii of a coil."""
ASIDE = 0.05
"""How far a point may leave the axis along which gas or an actuator pushes it (rmm)."""
CORD = 1.5
"""Radius of a rope (rmm)."""
LEAST = 4.0
"""Lengths of the balls at its ends that what stretches has at least; what gets shorter has no studs."""


def _sags(path: np.ndarray, length: float, down: tuple[float, float]) -> np.ndarray:
    """(T, 2) twice the sag of a rope of this length (rmm) along ``down``, or more: its parabola is longer than the two
    straight lines to its vertex, which are as long as the rope here.
    """
    strength = float(np.hypot(*down))
    if strength == 0:
        return np.zeros((len(path), 2))
    way, half = np.array(down) / strength, (path[:, 1] - path[:, 0]) / 2
    low, high = np.zeros(len(path)), np.full(len(path), length)
    for _ in range(40):
        middle = (low + high) / 2
        vertex = middle[:, None] * way
        long = np.hypot(*(half + vertex).T) + np.hypot(*(half - vertex).T) > length
        low, high = np.where(long, low, middle), np.where(long, middle, high)
    return 2 * low[:, None] * way


def _stretching(force: Force | Joint, layout: Layout) -> Stretching | None:
    """None where it acts along no line, or its ends are on one place at some time, or nearly so."""
    if force.name in layout.springs.left_out:
        return None
    ends = [(marker.body.name, *layout.place(marker)) for marker in (force.i, force.j)]
    path = np.stack([layout.seen(body, (x, y), "ground") for body, x, y in ends], axis=1)
    along_axis = force.kind.name in ("gas", "gas_cycle") or force.params.get("along_axis")
    if along_axis and _aside(force, path, layout) > ASIDE:
        return None
    least = float(np.linalg.norm(path[:, 1] - path[:, 0], axis=1).min())
    if least < LEAST * BALL:
        return None
    if force.kind.name == ROPE:
        long = layout.sizes.of_metres(force.params["length"])
        sags = _sags(path, long, layout.m.gravity or (0.0, 0.0))
        return Stretching(force.name, CORD, CORD, (ends[0], ends[1]), path, sags)
    radius = min(RADIUS, BROAD * least)
    outer = radius * (1 + WIRE) if _is_coil(force) else radius * CYLINDER
    return Stretching(force.name, radius, outer, (ends[0], ends[1]), path)


def _aside(force: Force | Joint, path: np.ndarray, layout: Layout) -> float:
    """How far its second point leaves the x axis of its first marker at most (rmm)."""
    angle = layout.poses[force.i.body.name][:, 2] + force.i.angle
    away = path[:, 1] - path[:, 0]
    return float(np.abs(away[:, 1] * np.cos(angle) - away[:, 0] * np.sin(angle)).max())


def _is_coil(force: Force | Joint) -> bool:
    """Whether the film draws a coil: what holds energy."""
    if force.kind.name == "spring":
        return "stiffness" in force.laws or force.params.get("stiffness", 0.0) > 0
    return force.kind.name == "curve_of_length" and "of_length" in force.laws


@force_kind("spring")
@force_kind("spring_law")
@force_kind("curve_of_length")
@force_kind("actuator")
@force_kind("gas")
@force_kind("gas_cycle")
@force_kind("gas_strut")
@force_kind("hydraulic_cylinder")
def gather(m: Mechanism, forces: list[Force], layout: Layout) -> list[Feature]:
    """Those of all kinds at the first of them, since they share studs."""
    return _all_at(forces[0], m, layout)


@contact_kind(ROPE)
@driver_kind(LINEAR)
def gather_others(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Ropes and linear drivers, in the same way."""
    return _all_at(joints[0], m, layout)


def _all_at(first: Force | Joint, m: Mechanism, layout: Layout) -> list[Feature]:
    """Studs first, then what they hold; nothing at another than the first."""
    between = stretching(m, layout.apart)
    if first is not between[0]:
        return []
    springs = [spring for force in between if (spring := _stretching(force, layout)) is not None]
    layout.springs.names[:] = [spring.force for spring in springs]
    for spring in springs:
        layout.extra.append(spring.layer)
        layout.poses[spring.layer] = np.zeros((len(layout.times), 3))
    return [*_studs(springs, layout), *springs]


def _studs(springs: Sequence[Stretching], layout: Layout) -> list[Feature]:
    """Ends that share a place of a body, or a pin, share a stud."""
    pins = [feature for feature in layout.features if isinstance(feature, Pin)]
    places: list[tuple[str, float, float, Pin | None, list[tuple[Stretching, int]]]] = []
    for spring in springs:
        for k, (body, x, y) in enumerate(spring.ends):
            pin = next((p for p in pins if body in p.places and math.dist(p.places[body], (x, y)) < SAME), None)
            if pin is not None:
                body, (x, y) = pin.home, pin.places[pin.home]
            for place in places:
                if place[0] == body and math.dist(place[1:3], (x, y)) < SAME:
                    place[4].append((spring, k))
                    break
            else:
                places.append((body, x, y, pin, [(spring, k)]))
    return [Stud(body, x, y, tuple(ends), pin) for body, x, y, pin, ends in places]
