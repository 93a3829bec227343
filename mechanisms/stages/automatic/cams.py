"""Cams with followers, and Geneva drives: their plates and pins."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.cams import CamProfile
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.curves import axes_of, curve_path, on_body, set_back, turns_left
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan, build, kind
from mechanisms.stages.automatic.layout.planar import Rounded, around, disc
from mechanisms.stages.automatic.layout.sizes import CLEAR, Extent, distance, extent
from mechanisms.stages.automatic.pins.free_bodies import Face
from mechanisms.stages.automatic.slides.slots import Slot, passed, slot_pin
from shared.shapes import outline
from shared.shapes.build import bore, eased, extruded
from shared.shapes.cams import Geneva, cam_disc, evenly
from shared.shapes.outline import circle
from shared.shapes.solid import placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Bodies whose plate is a wheel or a cam: what such joints have in common.


def refuse_ground(m: Mechanism, joint: Joint, *bodies: str) -> None:
    """Raise UserError if one of ``bodies`` is ground, which has no plate in a layer."""
    if "ground" in bodies:
        raise UserError(
            f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')} with a part on ground, which has "
            f"no automatic parts yet; let a body that is fixed (weld) carry it, or write {shown_file(m.name, 'parts')}"
        )


# Cams: the disc has the computed profile; a roller on a pin runs on it, or a shoe with a flat face.
#
# Disc and roller roll on each other by design. They are made with a clearance, so that they are two things that never
# touch: :data:`sizes.CLEAR`.

SHOE = 6.0
"""Half of the height of a shoe behind its face (rmm)."""
HULL = 60
"""Points of a cam's outline in the plane."""
BASE, ROLLER, POINT = 15.0, 6.5, 4.2
"""Least radii (rmm) of base circle and roller; how far a cam that a point touches is set back, about."""


@dataclass(frozen=True, eq=False)
class Cam(Feature):
    """A disc and its follower: places and directions in their frames (rmm, rad)."""

    name: str
    cam: str
    follower: str
    outline: np.ndarray
    """(n, 2) in the frame of the cam's body."""
    centre: tuple[float, float]
    """Centre of the cam."""
    base: float
    """Radius of its base circle."""
    at: tuple[float, float, float]
    """The roller's centre, or a place of the face and its direction."""
    roller: float | None
    """Radius as it is made; None where a face touches."""
    face: tuple[float, float]
    """Where the cam touches the face, from ``at`` along it."""
    clear: float
    bare: bool = False
    """True if the pin itself runs on the cam."""

    @property
    def fills(self) -> str:
        """The body whose layer leaves no room for teeth."""
        return self.cam

    def face_of(self, body: str, layout: Layout) -> Face | None:
        """Return the face of the cam, within the base circle."""
        return Face(*self.centre, self.base - 1.0) if body == self.cam else None

    @property
    def pin(self) -> Slot:
        """The pin of the roller, as one that runs at the height of the cam."""
        return Slot(self.name, self.cam, self.follower, np.array([self.centre]), self.at[:2])

    def shoe(self) -> list[tuple[float, float]]:
        """Return middles of the shoe's round ends, in the follower's frame."""
        x, y, angle = self.at
        along, up = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        ends = [np.array([x, y]) + s * along + (self.clear + SHOE) * up for s in self.face]
        return [(float(end[0]), float(end[1])) for end in ends]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the cam's hub; an eye that holds the roller's pin, or a plate behind the shoe."""
        eye = layout.sizes.eye
        anchors = [Anchor(self.cam, *self.centre, eye)]
        if self.roller is not None:
            return [*anchors, Anchor(self.follower, *self.at[:2], eye)]
        return [*anchors, *(Anchor(self.follower, x, y, SHOE + 1.0) for x, y in self.shoe())]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the cam, and what touches it at its height."""
        both = frozenset((self.cam, self.follower))
        hull = around([(x, y) for x, y in evenly(self.outline, HULL)], 0.3)
        yield Item(f"the cam of {self.name}", self.cam, hull, Reach((self.cam,)), source=self)
        if self.roller is not None:
            shape, what = disc(*self.at[:2], self.roller), f"the roller of {self.name}"
        else:
            shape, what = Rounded(np.array(self.shoe()), SHOE), f"the shoe of {self.name}"
        yield Item(what, self.follower, shape, Reach((self.follower,)), source=self)  # never on the cam's layer
        yield Item(what, self.follower, shape, Reach((self.follower, self.cam)), both, self)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Return the same as for a pin in a slot."""
        return self.pin.needs_under(self, levels, layout) if self.roller is not None else []


@kind("cam_roller")
@kind("cam_flat")
def gather_cams(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return one feature for each joint."""
    return [_cam(m, joint, layout) for joint in joints]


def _cam(m: Mechanism, joint: Joint, layout: Layout) -> Cam:
    refuse_ground(m, joint, joint.i.body.name, joint.j.body.name)
    profile, sizes = _profile(joint), layout.sizes
    centre, clear = layout.place(joint.i), CLEAR * sizes.pivot.fit.running
    outline = cut_outline(m, joint, joint.i, sizes.of_metres(1.0)) + centre
    at = (*layout.place(joint.j), joint.j.angle)
    names = joint.i.body.name, joint.j.body.name
    roller, face = None, (0.0, 0.0)
    if profile.flat:
        face = _touched(outline, at, names, layout)
    else:
        roller = sizes.of_metres(profile.sizes["roller_radius"]) - clear
    base = sizes.of_metres(profile.sizes["base_radius"])
    return Cam(joint.name, *names, outline, centre, base, at, roller, face, clear)


def cut_outline(m: Mechanism, joint: Joint, marker: Marker, metre: float) -> np.ndarray:
    """Return (n, 2) the outline of a joint's cam about its centre, a ``metre`` as the unit.

    It is in the axes of the body of ``marker``. Raises UserError for a cam that cannot be cut.
    """
    profile = _profile(joint)
    if profile.undercut:
        raise UserError(f"{m.name}: cam of joint '{joint.name}' cannot be cut: {profile.problems[0]}")
    return metre * profile.outline @ axes_of(marker)


def pushing_cam(touch: Joint, layout: Layout) -> list[Feature]:
    """Return the cam of a contact whose closed curve pushes a disc that may leave it.

    Returns an empty list if the disc runs inside.

    A point is the bare end of a pin, and the cam is smaller by that pin's radius. Raises UserError where nothing of
    the cam would be left.
    """
    outline = on_body(curve_path(touch.params["points"], True), touch.i, layout)
    if turns_left(outline):
        return []
    centre, clear = layout.place(touch.i), CLEAR * layout.sizes.pivot.fit.running
    at = (*layout.place(touch.j), touch.j.angle)
    roller = layout.sizes.of_metres(touch.params["radius"]) - clear
    bare = touch.params["radius"] == 0
    if bare:
        roller = layout.sizes.pivot.pin / 2
        outline = with_room(outline, roller + clear, touch, layout)
    base = float(np.hypot(*(outline - centre).T).min())
    names = touch.i.body.name, touch.j.body.name
    return [Cam(touch.name, *names, outline, centre, base, at, roller, (0.0, 0.0), clear, bare)]


def with_room(path: np.ndarray, back: float, touch: Joint | Force, layout: Layout) -> np.ndarray:
    """Return a closed curve set back (rmm) from what touches it, because that is larger than in the model.

    Raises UserError where nothing of it would be left.
    """
    moved = set_back(path, back)
    if len(moved):
        return moved
    m, scale = layout.m, layout.sizes.scale
    raise UserError(
        f"{m.name}: contact '{touch.name}': what touches its closed curve is {back * scale:.3g} mm larger in radius "
        "than in the model; nothing of the curve is left when it is set back by that; make the curve larger, or write "
        f"{shown_file(m.name, 'parts')}"
    )


def pushing_extent(touch: Joint | Force) -> Extent:
    """Return what :func:`cam_extent` does, for a contact with a closed curve."""
    away, roller = np.hypot(*np.array(touch.params["points"], dtype=float).T), touch.params["radius"]
    least = ((float(away.min()), BASE), (roller, ROLLER)) if roller > 0 else ((float(away.min()), BASE + POINT),)
    return Extent(((touch.i, float(away.max())), (touch.j, roller)), least)


def _touched(
    outline: np.ndarray, at: tuple[float, float, float], names: tuple[str, str], layout: Layout
) -> tuple[float, float]:
    """Return the range in which a cam touches a face, along it from the face's marker."""
    x, y, angle = at
    along, up = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
    points = evenly(outline, 4 * HULL)
    seen = np.stack([layout.seen(names[0], (u, v), names[1]) for u, v in points], axis=1) - [x, y]
    nearest = np.argmax(seen @ up, axis=1)
    where = np.take_along_axis(seen @ along, nearest[:, None], axis=1)
    return float(where.min()), float(where.max())


def _profile(joint: Joint) -> CamProfile:
    from mbsd.cams import cam_from

    return cam_from(joint.params["profile"])


@extent("cam_roller")
@extent("cam_flat")
def cam_extent(joint: Joint, solution: Solution) -> Extent:
    """Return the disc with a hub in its base circle, and the roller with a pin in it where there is one."""
    profile = _profile(joint)
    farthest, base = float(np.hypot(*profile.outline.T).max()), (profile.sizes["base_radius"], BASE)
    if profile.flat:
        return Extent(((joint.i, farthest),), (base,))
    roller = profile.sizes["roller_radius"]
    return Extent(((joint.i, farthest), (joint.j, roller)), (base, (roller, ROLLER)))


# The solids of a cam (rmm): its disc, and the roller on its pin, or the shoe.


@build.register(Cam)
def cam_solids(cam: Cam, plan: Plan, heights: Heights) -> None:
    """The disc becomes its body's plate; roller or shoe move with the follower, at the height of the disc."""
    x, y = cam.centre
    hub = float(np.hypot(cam.outline[:, 0] - x, cam.outline[:, 1] - y).min())
    plan.plate(cam.cam, cam_disc(cam.outline, heights.thickness), (x, y, hub - 1.0))
    if cam.roller is not None:
        slot_pin(cam.pin, plan, heights, 0.0 if cam.bare else 2 * cam.roller)
        return
    seat = plan.layout.sizes.pivot.fit.seat
    if heights.bottom(cam.follower) > heights.bottom(cam.cam):
        z0, z1 = heights.bottom(cam.cam), heights.bottom(cam.follower) - seat
    else:
        z0, z1 = heights.top(cam.follower) + seat, heights.top(cam.cam)
    ends = cam.shoe()
    shape = extruded(outline.hull([(u, v, SHOE) for u, v in ends]), z1 - z0, z0)
    plan.make(cam.follower, f"shoe_{cam.name}", eased(shape, 0.5, chamfer=True), "bronze", 0)


# Geneva: the crank carries a pin with a roller, and at the height of the wheel a locking disc round its own axis.

WALL = 4.0
"""Wall of the wheel's tips beside the slots (rmm), at least."""
HUB, PIN_CIRCLE, NEAR = 25.0, 28.0, 14.5
"""Least distances (rmm): the bottom of the slots from the wheel's axis, pin from crank, wheel from the crank's axis."""
LOOSE = 1.5
"""Gap between locking disc and wheel, in running fits."""


@dataclass(frozen=True, eq=False)
class GenevaDrive(Feature):
    """Centres and directions of pin and slot in the frames of crank and wheel (rmm, rad)."""

    name: str
    crank: str
    wheel: str
    crank_at: tuple[float, float, float]
    wheel_at: tuple[float, float, float]
    shape: Geneva

    @property
    def fills(self) -> str:
        """The body whose layer leaves no room for teeth."""
        return self.wheel

    def face_of(self, body: str, layout: Layout) -> Face | None:
        """Return the face of the wheel: within its slots."""
        bottom = self.shape.bottom
        return Face(*self.wheel_at[:2], bottom - 1.0) if body == self.wheel else None

    @property
    def pin(self) -> Slot:
        """The pin in a slot, as far as its hardware goes; the wheel has its slots already."""
        x, y, angle = self.crank_at
        at = x + self.shape.radius * math.cos(angle), y + self.shape.radius * math.sin(angle)
        return Slot(self.name, self.wheel, self.crank, np.array([self.wheel_at[:2]]), at)

    @property
    def runs_through(self) -> Slot:
        """The wheel's slots."""
        return self.pin

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return eyes for the axes, and one that holds the pin."""
        eye = layout.sizes.eye
        axes = Anchor(self.crank, *self.crank_at[:2], eye), Anchor(self.wheel, *self.wheel_at[:2], eye)
        return [*axes, Anchor(self.crank, *self.pin.pin_at, eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the wheel, the pin through it and the locking disc, and a rule.

        The rule: the crank, whose disc stands in the wheel's layer, is in another one even where its arm never comes
        near the wheel.
        """
        both, between = frozenset((self.crank, self.wheel)), Reach((self.crank, self.wheel))
        wheel, lock = disc(*self.wheel_at[:2], self.shape.rim), disc(*self.crank_at[:2], self.shape.lock)
        yield Item(f"the wheel of {self.name}", self.wheel, wheel, Reach((self.wheel,)), source=self)
        apart = disc(*self.wheel_at[:2], self.shape.distance)
        rule = f"the layer of the wheel of {self.name}"
        yield Item(rule, self.wheel, apart, Reach((self.wheel,)), source=self, only=frozenset((self.crank,)))
        yield Item(f"the locking disc of {self.name}", self.crank, lock, between, both, self)
        pin = disc(*self.pin.pin_at, layout.sizes.hardware)
        reach, meshes = Reach((self.crank, self.wheel), 1, 1), passed(self.pin, layout)
        yield Item(f"the pin of {self.name}", self.crank, pin, reach, both, self, meshes)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Return the same as for a pin in a slot."""
        return self.pin.needs_under(self, levels, layout)


@kind("geneva")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return one feature for each joint."""
    drives: list[Feature] = []
    for joint in joints:
        refuse_ground(m, joint, joint.i.body.name, joint.j.body.name)
        sizes = layout.sizes
        ends = [(*layout.place(marker), marker.angle) for marker in (joint.i, joint.j)]
        apart = layout.seen(joint.j.body.name, ends[1][:2], joint.i.body.name)[0]
        shape = Geneva(
            slots=joint.params["slots"],
            distance=math.hypot(apart[0] - ends[0][0], apart[1] - ends[0][1]),
            radius=sizes.of_metres(joint.params["radius"]),
            slot=sizes.roller + sizes.pivot.fit.running,
            wall=WALL,
            gap=LOOSE * sizes.pivot.fit.running,
        )
        drives.append(GenevaDrive(joint.name, joint.i.body.name, joint.j.body.name, ends[0], ends[1], shape))
    return drives


@extent("geneva")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Return the pin's circle and the wheel; room for hubs where the two come near each other's axes."""
    apart, radius, slots = distance(joint, solution), joint.params["radius"], joint.params["slots"]
    rim = apart * math.cos(math.pi / slots)
    return Extent(
        ((joint.i, radius), (joint.j, rim)), ((apart - radius, HUB), (radius, PIN_CIRCLE), (apart - rim, NEAR))
    )


# The solids of a Geneva drive (rmm): wheel, locking disc with its collar, pin and roller.

ROOM = 1.0
"""Between what stands on the crank's axis and the locking disc round it."""
COLLAR = 2.5
"""Wall of the collar that carries the locking disc."""


@build.register(GenevaDrive)
def geneva_solids(drive: GenevaDrive, plan: Plan, heights: Heights) -> None:
    """The wheel becomes its body's plate; all else moves with the crank."""
    fit, shape = plan.layout.sizes.pivot.fit, drive.shape
    x, y, angle = drive.wheel_at
    wheel = placed(shape.wheel(heights.thickness), x, y, turn=math.degrees(angle))
    plan.plate(drive.wheel, wheel, (x, y, shape.bottom))
    slot_pin(drive.pin, plan, heights)
    x, y, angle = drive.crank_at
    hole = plan.layout.sizes.hardware + ROOM
    disc = shape.locking_disc(heights.thickness, hole)
    low = heights.bottom(drive.wheel)
    plan.make(drive.crank, f"lock_{drive.name}", placed(disc, x, y, low, math.degrees(angle)), "steel", 1)
    start, end = heights.between(drive.crank, drive.wheel, fit.seat, fit.seat)
    collar = extruded(circle(0, 0, hole + COLLAR), end - start).cut(bore(2 * hole, 0.0, end - start))
    plan.make(drive.crank, f"collar_{drive.name}", placed(collar, x, y, start), "steel", 1)
