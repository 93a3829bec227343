"""Contacts of discs with surfaces and with each other: walls, roads, tracks, balls, wheels and discs.

A surface is where the model has it. What touches is smaller by a clearance (cams.py), and where a contact hardly yields
also by as much as it presses in; where one sees that, the two pieces may touch by design. A body without joints is a
ball, or where there is friction, which turns it, a wheel with a tyre; one with joints, or with several places that
touch, gets discs. What touches a disc that is itself on ground, or a yielding profile of a moving body, has no parts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mbsd.model.laws.curve import Curve
from mechanisms.stages.automatic.cams.cams import pushing_cam, pushing_extent, with_room
from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.layout.features import contact_kind, force_kind
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.profiles import curve_path, farthest, on_body, profile_path, turns_left
from mechanisms.stages.automatic.rolling.rounds import Look, Round, round_at
from mechanisms.stages.automatic.rolling.surfaces import touched_path, touched_road
from mechanisms.stages.automatic.rolling.tracks import circle, track
from mechanisms.stages.automatic.rolling.walls import NOSE, Line, roads
from shared.shapes.polyline import distances

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

    type Touch = Force | Joint

BALL, DISC, WHEEL = 12.0, 18.0, 22.0
"""Least radii (rmm)."""
YIELDS = 0.3
"""Bodies that press further into each other (rmm) do so in the film, too."""
BEYOND = 1.2
"""How far a road goes on beyond the way of its wheel, in the wheel's radii."""


@contact_kind("rigid_contact")
def rigid_lines(m: Mechanism, touches: list[Joint], layout: Layout) -> list[Feature]:
    """Walls, and what touches them."""
    return _on_lines(m, touches, layout)


@force_kind("contact")
@force_kind("tyre")
def yielding(m: Mechanism, touches: list[Force], layout: Layout) -> list[Feature]:
    """Walls and roads, and what presses on them."""
    features = _on_lines(m, [touch for touch in touches if "profile" not in touch.laws], layout)
    for touch in touches:
        profile = touch.laws.get("profile")
        if isinstance(profile, Curve) and _is_on_ground(touch):
            features += _on_profile(m, touch, profile, layout)
    return features


@contact_kind("rigid_terrain")
def terrains(m: Mechanism, touches: list[Joint], layout: Layout) -> list[Feature]:
    """Roads and what touches them; a closed curve of a moving body is a cam that pushes a roller."""
    features: list[Feature] = []
    for touch in touches:
        closed = touch.params["closed"]
        if _pushes(touch) and (touch.params["radius"] > 0 or _is_held(m, touch.j.body.name)):
            features += pushing_cam(touch, layout)
        elif touch.j.body.name != "ground":
            path = on_body(curve_path(touch.params["points"], True), touch.i, layout) if closed else None
            features += _on_road(m, touch, path, layout, closed)
    return features


@contact_kind("rigid_discs")
def discs(m: Mechanism, touches: list[Joint], layout: Layout) -> list[Feature]:
    """Two balls or discs of moving bodies, on one layer; rings round discs, and discs on ground, are tracks."""
    features: list[Feature] = []
    for touch in touches:
        if touch.params["inside"] or "ground" in touch.bodies:
            features += _in_ring(m, touch, layout)
            continue
        for marker, other, radius in ((touch.i, touch.j, "radius_i"), (touch.j, touch.i, "radius_j")):
            body, long = marker.body.name, max(layout.sizes.of_metres(touch.params[radius]), NOSE)
            look = _look(m, body, touch.params["friction"] > 0.0)
            part, new = round_at(layout, touch.name, body, layout.place(marker), long, look)
            part.meets.add(other.body.name)
            features += [part] if new else []
        layout.together.append(touch.bodies)
    return features


def _on_lines(m: Mechanism, touches: Sequence[Touch], layout: Layout) -> list[Feature]:
    features: list[Feature] = []
    lines: list[Line] = []
    for touch in touches:
        if touch.j.body.name == "ground":
            continue
        places = _places(touch, layout)
        way = np.array([math.cos(touch.i.angle), math.sin(touch.i.angle)])
        line = Line(touch.name, np.array(layout.place(touch.i)), way)
        gap = (places - line.start) @ line.free - layout.sizes.of_metres(touch.params["radius"])
        part, new = _round(m, touch, layout, float(gap.min()))
        line.start = line.start - _set_back(touch, layout) * line.free
        features += [part] if new else []
        if not _is_on_ground(touch):
            line.carry(part, places)
            ends = np.array(line.travel[0])
            features.append(track(touch.name, touch.i.body.name, part, line.start + ends[:, None] * way, False))
            continue
        line = next((other for other in lines if other.is_same(line)), line)
        lines += [] if line in lines else [line]
        line.carry(part, places)
    return [*features, *roads(lines)]


def _on_profile(m: Mechanism, touch: Force, profile: Curve, layout: Layout) -> list[Feature]:
    """A road as long as the profile's points, and as the way of what runs on it."""
    start = np.array(layout.place(touch.i))
    way = np.array([math.cos(touch.i.angle), math.sin(touch.i.angle)])
    run = (_places(touch, layout) - start) @ way / layout.sizes.of_metres(1.0)
    beyond = BEYOND * touch.params["radius"]
    first, last = min(profile.x[0], run.min() - beyond), max(profile.x[-1], run.max() + beyond)
    return _on_road(m, touch, on_body(profile_path(profile, float(first), float(last)), touch.i, layout), layout)


def _in_ring(m: Mechanism, touch: Joint, layout: Layout) -> list[Feature]:
    """A disc inside a ring, or one that touches a disc of ground."""
    inside, (ring, disc) = touch.params["inside"], ("radius_i", "radius_j")
    i, j = touch.i, touch.j
    if not inside and j.body.name == "ground":
        i, j, ring, disc = j, i, disc, ring
    if j.body.name == "ground":
        return []
    radius, short = (layout.sizes.of_metres(touch.params[name]) for name in (ring, disc))
    look = _look(m, j.body.name, touch.params["friction"] > 0.0)
    part, new = round_at(layout, touch.name, j.body.name, layout.place(j), max(short, NOSE), look)
    wide = radius + (1 if inside else -1) * max(0.0, NOSE - short)
    if wide < NOSE:
        return [part] if new else []
    path = circle(layout.place(i), wide, inside)
    return [*([part] if new else []), track(touch.name, i.body.name, part, path, True)]


def _on_road(
    m: Mechanism, touch: Touch, path: np.ndarray | None, layout: Layout, closed: bool = False
) -> list[Feature]:
    """A road on ground, or a track of another body or along a closed curve; without a ``path`` (n, 2) (rmm, the frame
    of its body) it is along the contact's open curve.
    """
    places, radius = _places(touch, layout), layout.sizes.of_metres(touch.params["radius"])
    if path is None:
        path = touched_path(touch, places, radius, layout)
    whole = np.vstack([path, path[:1]]) if closed else path
    gap = distances(places, whole) - radius
    part, new = _round(m, touch, layout, float(gap.min()))
    features, back, body = [part] if new else [], _set_back(touch, layout), touch.i.body.name
    if closed:
        path = with_room(path, back, touch, layout) if back > 0 else path
        return [*features, track(touch.name, body, part, path, True)]
    road = touched_road(touch, part, path - back * _normals(path), places, layout)
    return [*features, road if _is_on_ground(touch) else track(touch.name, body, part, road.path, False, road)]


def _pushes(touch: Touch) -> bool:
    """Whether a closed curve of a moving body has what touches it outside, as a cam has."""
    closed = touch.params["closed"] and "ground" not in touch.bodies
    return closed and not turns_left(np.array(touch.params["points"], dtype=float))


def _round(m: Mechanism, touch: Touch, layout: Layout, gap: float) -> tuple[Round, bool]:
    """What touches; ``gap`` is the least one (rmm), below 0 where it presses in."""
    body = touch.j.body.name
    turned = touch.params.get("friction", 0.0) > 0.0
    look: Look = "wheel" if touch.kind.name == "tyre" else _look(m, body, turned)
    pressed, pair = max(0.0, -gap), frozenset(touch.bodies)
    seen = pressed if pressed > YIELDS else 0.0
    if seen:
        layout.yielding.add(pair)
    if pair in layout.touching | layout.yielding:
        pressed = 0.0
    radius = max(layout.sizes.of_metres(touch.params["radius"]), NOSE)
    part, new = round_at(layout, touch.name, body, layout.place(touch.j), radius, look, pressed)
    part.pressed = max(part.pressed, seen)
    return part, new


def _look(m: Mechanism, body: str, turned: bool) -> Look:
    """Look of what touches without being a tyre."""
    if _is_held(m, body) or _feet(m, body) > 1:
        return "disc"
    return "wheel" if turned else "ball"


def _is_held(m: Mechanism, body: str) -> bool:
    return any(body in joint.bodies for joint in m.joints.values())


def _feet(m: Mechanism, body: str) -> int:
    """At how many places of it a body touches something: one with several cannot roll."""
    touches = [touch for touch in (*m.contacts.values(), *m.forces.values()) if "radius" in touch.params]
    return len({(touch.j.x, touch.j.y) for touch in touches if touch.j.body.name == body})


def _set_back(touch: Touch, layout: Layout) -> float:
    """How far the surface lies behind that of the model (rmm), because what touches is larger than there."""
    return max(0.0, NOSE - layout.sizes.of_metres(touch.params["radius"]))


def _places(touch: Touch, layout: Layout) -> np.ndarray:
    return layout.seen(touch.j.body.name, layout.place(touch.j), touch.i.body.name)


def _is_on_ground(touch: Touch) -> bool:
    return touch.i.body.name == "ground" and touch.j.body.name != "ground"


def _normals(path: np.ndarray) -> np.ndarray:
    """(n, 2) unit vectors to the left of a path."""
    way = np.gradient(path, axis=0)
    return np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]


@extent("rigid_discs")
def extent_of_discs(touch: Joint, solution: Solution) -> Extent:
    """Both discs."""
    radii = ((touch.i, touch.params["radius_i"]), (touch.j, touch.params["radius_j"]))
    return Extent(radii, tuple((radius, DISC) for _, radius in radii if radius > 0))  # a ring is larger than its disc


@extent("rigid_contact")
@extent("rigid_terrain")
@extent("contact")
@extent("tyre")
def extent_of(touch: Touch, solution: Solution) -> Extent:
    """What touches."""
    radius = touch.params["radius"]
    closed = touch.params.get("closed", False)
    if closed and _pushes(touch):
        return pushing_extent(touch)
    least = WHEEL if touch.kind.name == "tyre" or touch.params.get("friction", 0.0) > 0.0 else BALL
    round_it = ((touch.i, farthest(touch.params["points"])),) if closed else ()
    return Extent(((touch.j, radius), *round_it), ((radius, least),) if radius > 0 else ())
