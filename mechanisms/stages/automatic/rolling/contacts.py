"""Rolling and touching contacts: discs on roads, tracks and walls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.laws.curve import Curve
from mechanisms.stages.automatic.cams import pushing_cam, pushing_extent, with_room
from mechanisms.stages.automatic.layout.curves import curve_path, farthest, on_body, profile_path, turns_left
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import contact_kind, force_kind, kind
from mechanisms.stages.automatic.layout.sizes import CLEAR, Extent, extent
from mechanisms.stages.automatic.pins.pins import pins_at
from mechanisms.stages.automatic.rolling.roads import THICK, Road, along
from mechanisms.stages.automatic.rolling.rounds import Look, Round, round_at
from mechanisms.stages.automatic.rolling.tracks import circle, rolled_road, touched_path, touched_road, track
from shared.shapes.outline import distances
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Straight walls on ground from contacts with lines: as long as the way along them, and meeting in mitred corners.
#
# The lines of one disc leave it the region in which it is on the free side of them all. So each wall ends where it
# crosses another one, and has its matter outside.

BEYOND = 1.2
"""How far a wall goes on beyond the way of what touches it, in that one's radii."""
CORNER = 3.0
"""A wall that ends nearer than this to another one (radii) goes on to it."""
SHARPEST = math.radians(20.0)
"""Walls at a smaller angle have no mitred corner."""
PARALLEL = 1e-3
"""Walls at a smaller angle (rad) do not meet."""
NOSE = 4.0
"""The least radius of what touches (rmm), without a pin in its middle; the wall of a smaller one lies back by the
difference."""


@dataclass(eq=False)
class Line:
    """A line on ground (rmm): a place, its direction, the round parts on it and their ways along it."""

    name: str
    start: np.ndarray
    way: np.ndarray
    rounds: list[Round] = field(default_factory=list)
    travel: list[tuple[float, float]] = field(default_factory=list)

    @property
    def free(self) -> np.ndarray:
        """(2,) the unit vector to the free side."""
        return np.array([-self.way[1], self.way[0]])

    def carry(self, part: Round, places: np.ndarray) -> None:
        """Add a round part that goes along (T, 2) places."""
        along = (places - self.start) @ self.way
        beyond = BEYOND * part.radius
        self.rounds.append(part)
        self.travel.append((float(along.min()) - beyond, float(along.max()) + beyond))

    def is_same(self, other: Line) -> bool:
        """Return True if both are one line with one free side."""
        return bool(np.abs(self.way - other.way).max() < 1e-9 and abs((other.start - self.start) @ self.free) < 1e-6)


def roads(lines: Sequence[Line]) -> list[Road]:
    """Return a wall for each line."""
    walls = []
    for line in lines:
        low, high = min(low for low, _ in line.travel), max(high for _, high in line.travel)
        shared = [other for other in lines if other is not line and {*other.rounds} & {*line.rounds}]
        reach = CORNER * max(part.radius for part in line.rounds)
        behind = [THICK * -line.free] * 2  # of the last and of the first place
        first, last = low - reach, high + reach
        for other in shared:
            turn = float(line.way @ other.free)  # sine of the angle between them; below 0: it ends here
            if abs(turn) < PARALLEL:
                continue
            at = float((other.start - line.start) @ other.free) / turn
            if turn < 0 and at < last:
                high, behind[0], last = at, _mitre(line, other), at
            elif turn > 0 and at > first:
                low, behind[1], first = at, _mitre(line, other), at
        path = np.array([line.start + low * line.way, line.start + high * line.way])
        walls.append(Road(line.name, line.rounds, path, np.array([path[1] + behind[0], path[0] + behind[1]])))
    return walls


def _mitre(line: Line, other: Line) -> np.ndarray:
    """Return (2,) from where two walls meet to where their outer faces meet.

    Square where that would be far.
    """
    cosine = float(line.free @ other.free)
    if math.pi - math.acos(max(-1.0, min(1.0, cosine))) < SHARPEST:
        return -THICK * line.free
    return -THICK * (line.free + other.free) / (1.0 + cosine)


# Contacts of discs with surfaces and with each other: walls, roads, tracks, balls, wheels and discs.
#
# A surface is where the model has it. What touches is smaller by a clearance (cams.py), and where a contact hardly
# yields also by as much as it presses in; where one sees that, the two pieces may touch by design. A body without
# joints is a ball, or where there is friction, which turns it, a wheel with a tyre; one with joints, or with several
# places that touch, gets discs. What touches a disc that is itself on ground, or a yielding profile of a moving body,
# has no parts.

type Touch = Force | Joint

BALL, DISC, WHEEL = 12.0, 18.0, 22.0
"""Least radii (rmm)."""
YIELDS = 0.3
"""Bodies that press further into each other (rmm) do so in the film, too."""


@contact_kind("rigid_contact")
def rigid_lines(m: Mechanism, touches: list[Joint], layout: Layout) -> list[Feature]:
    """Return walls, and what touches them."""
    return _on_lines(m, touches, layout)


@force_kind("contact")
@force_kind("tyre")
def yielding(m: Mechanism, touches: list[Force], layout: Layout) -> list[Feature]:
    """Return walls and roads, and what presses on them."""
    features = _on_lines(m, [touch for touch in touches if "profile" not in touch.laws], layout)
    for touch in touches:
        profile = touch.laws.get("profile")
        if isinstance(profile, Curve) and _is_on_ground(touch):
            features += _on_profile(m, touch, profile, layout)
    return features


@contact_kind("rigid_terrain")
def terrains(m: Mechanism, touches: list[Joint], layout: Layout) -> list[Feature]:
    """Return roads and what touches them; a closed curve of a moving body is a cam that pushes a roller."""
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
    """Return two balls or discs of moving bodies, on one layer.

    Rings round discs, and discs on ground, are tracks.
    """
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
    """Return a road as long as the profile's points, and as the way of what runs on it."""
    start = np.array(layout.place(touch.i))
    way = np.array([math.cos(touch.i.angle), math.sin(touch.i.angle)])
    run = (_places(touch, layout) - start) @ way / layout.sizes.of_metres(1.0)
    beyond = BEYOND * touch.params["radius"]
    first, last = min(profile.x[0], run.min() - beyond), max(profile.x[-1], run.max() + beyond)
    return _on_road(m, touch, on_body(profile_path(profile, float(first), float(last)), touch.i, layout), layout)


def _in_ring(m: Mechanism, touch: Joint, layout: Layout) -> list[Feature]:
    """Return a disc inside a ring, or one that touches a disc of ground."""
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
    """Return a road on ground, or a track of another body or along a closed curve.

    Without a ``path`` (n, 2) (rmm, the frame of its body) it is along the contact's open curve.
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
    """Return True if a closed curve of a moving body has what touches it outside, as a cam has."""
    closed = touch.params["closed"] and "ground" not in touch.bodies
    return closed and not turns_left(np.array(touch.params["points"], dtype=float))


def _round(m: Mechanism, touch: Touch, layout: Layout, gap: float) -> tuple[Round, bool]:
    """Return the round body that touches; ``gap`` is the least one (rmm), below 0 where it presses in."""
    body = touch.j.body.name
    turned = touch.params.get("friction", 0.0) > 0.0
    look: Look = "wheel" if touch.kind.name == "tyre" else _look(m, body, turned)
    pressed, pair = max(0.0, -gap), frozenset(touch.bodies)
    seen = pressed if pressed > YIELDS else 0.0
    if seen:
        layout.yielding.add(pair)
    if pair in layout.touching | layout.yielding:
        pressed = 0.0
    radius = layout.sizes.of_metres(touch.params["radius"]) + _set_back(touch, layout)
    part, new = round_at(layout, touch.name, body, layout.place(touch.j), radius, look, pressed)
    part.pressed = max(part.pressed, seen)
    return part, new


def _look(m: Mechanism, body: str, turned: bool) -> Look:
    """Return the look of what touches without being a tyre."""
    if _is_held(m, body) or _feet(m, body) > 1:
        return "disc"
    return "wheel" if turned else "ball"


def _is_held(m: Mechanism, body: str) -> bool:
    return any(body in joint.bodies for joint in m.joints.values())


def _feet(m: Mechanism, body: str) -> int:
    """Return at how many of its places a body touches something: one with several cannot roll."""
    touches = [touch for touch in (*m.contacts.values(), *m.forces.values()) if "radius" in touch.params]
    return len({(touch.j.x, touch.j.y) for touch in touches if touch.j.body.name == body})


def _set_back(touch: Touch, layout: Layout) -> float:
    """Return how far the surface lies behind the model's (rmm), as what touches is larger than there."""
    return max(0.0, _least_radius(touch, layout) - layout.sizes.of_metres(touch.params["radius"]))


def _least_radius(touch: Touch, layout: Layout) -> float:
    """Return the least radius of what touches (rmm): a nose's, or one that holds the eye of a pin."""
    sizes, is_pinned = layout.sizes, bool(pins_at(layout, touch.j.body.name, layout.place(touch.j)))
    return sizes.eye + CLEAR * sizes.pivot.fit.running + YIELDS if is_pinned else NOSE


def _places(touch: Touch, layout: Layout) -> np.ndarray:
    return layout.seen(touch.j.body.name, layout.place(touch.j), touch.i.body.name)


def _is_on_ground(touch: Touch) -> bool:
    return touch.i.body.name == "ground" and touch.j.body.name != "ground"


def _normals(path: np.ndarray) -> np.ndarray:
    """Return (n, 2) unit vectors to the left of a path."""
    way = np.gradient(path, axis=0)
    return np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]


@extent("rigid_discs")
def extent_of_discs(touch: Joint, solution: Solution) -> Extent:
    """Return both discs."""
    radii = ((touch.i, touch.params["radius_i"]), (touch.j, touch.params["radius_j"]))
    return Extent(radii, tuple((radius, DISC) for _, radius in radii if radius > 0))  # a ring is larger than its disc


@extent("rigid_contact")
@extent("rigid_terrain")
@extent("contact")
@extent("tyre")
def extent_of(touch: Touch, solution: Solution) -> Extent:
    """Return the extent of a disc that touches, and of the closed curve that it touches."""
    radius = touch.params["radius"]
    closed = touch.params.get("closed", False)
    if closed and _pushes(touch):
        return pushing_extent(touch)
    least = WHEEL if touch.kind.name == "tyre" or touch.params.get("friction", 0.0) > 0.0 else BALL
    round_it = ((touch.i, farthest(touch.params["points"])),) if closed else ()
    return Extent(((touch.j, radius), *round_it), ((radius, least),) if radius > 0 else ())


# Discs that roll on a line or a curve: a wheel with a tyre, and the road as a wall on the base, or on a moving body;
# closed curves are rings round the wheel, or discs (tracks.py).
#
# Wheel and road touch by design; they are made with the clearance of a cam and its roller.

BEYOND_TRAVEL = 0.8
"""How far a straight road goes on beyond the wheel's travel, in the wheel's radii."""
LEAST = 17.0
"""Least radius of a wheel (rmm): an eye lies within its tyre."""


@kind("rolling_disc")
def on_lines(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return a wheel and a road for each joint."""
    features: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        start, angle = np.array(layout.place(joint.i)), joint.i.angle
        way = np.array([math.cos(angle), math.sin(angle)])
        travel = (layout.seen(joint.j.body.name, layout.place(joint.j), joint.i.body.name) - start) @ way
        beyond = BEYOND_TRAVEL * layout.sizes.of_metres(joint.params["radius"])
        ends = np.array([travel.min() - beyond, travel.max() + beyond])
        features += _rolling(joint, start + ends[:, None] * way, False, layout)
    return features


@kind("rolling_on_curve")
def on_curves(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return a wheel and a road for each joint."""
    features: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        closed = bool(joint.params["closed"])
        path = on_body(curve_path(joint.params["points"], True), joint.i, layout) if closed else None
        features += _rolling(joint, path, closed, layout)
    return features


def _rolling(joint: Joint, path: np.ndarray | None, closed: bool, layout: Layout) -> list[Feature]:
    """Return the wheel and road; without a ``path`` the road is along the joint's open curve."""
    radius = layout.sizes.of_metres(joint.params["radius"])
    wheel, new = round_at(layout, joint.name, joint.j.body.name, layout.place(joint.j), radius, "wheel")
    body, features = joint.i.body.name, [wheel] if new else []
    if path is not None and closed:
        return [*features, track(joint.name, body, wheel, path, True)]
    road = rolled_road(joint, wheel, layout) if path is None else along(joint.name, [wheel], path)
    if body == "ground":
        return [*features, road]
    return [*features, track(joint.name, body, wheel, road.path, False, road)]


def _refuse(m: Mechanism, joint: Joint) -> None:
    if joint.j.body.name == "ground":
        raise UserError(
            f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')} whose disc is on ground; "
            f"it has no automatic parts yet; write {shown_file(m.name, 'parts')}"
        )


@extent("rolling_disc")
@extent("rolling_on_curve")
def extent_of_rolling(joint: Joint, solution: Solution) -> Extent:
    """Return the wheel, and a closed curve."""
    radius = joint.params["radius"]
    round_it = ((joint.i, farthest(joint.params["points"])),) if joint.params.get("closed") else ()
    return Extent(((joint.j, radius), *round_it), ((radius, LEAST),))
