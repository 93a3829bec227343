"""Springs, dampers and other elements between two points, with the studs that carry their ends."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mbsd import Mechanism
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build, contact_kind, driver_kind, force_kind
from mechanisms.stages.automatic.layout.planar import Rounded, disc
from mechanisms.stages.automatic.layout.sizes import LINEAR, ROPE, stretching
from mechanisms.stages.automatic.pins.pin_solids import upper_end
from mechanisms.stages.automatic.pins.pins import SAME, Pin, pins_at
from shared.shapes.base import column
from shared.shapes.link import Eye
from shared.shapes.screw import Collar, ball_stud
from shared.shapes.solid import Hold, Solid, placed

# Elements that stretch between two points, and the ball studs that hold its ends: in a body's plate, on a post on
# ground, or on the end of a joint's pin.

BALL = 3.8
"""Radius of a stud's ball."""
SHANK, COLLAR_HEIGHT = 4.6, 1.4
"""Diameter of a stud's shank, and height of the collar between a plate and a ball."""
EYE, POST, FOOT = 9.0, 5.5, 9.0
"""Radii of a stud's eye, of the room for studs and posts, and of a post's foot."""
HOOK = 0.1
"""Part of the way at either end where there is no barrel yet."""


@dataclass(frozen=True, eq=False)
class Stretching(Feature):
    """One spring, damper or actuator: its ends (body, x, y) and their ways in the world (rmm)."""

    force: str
    radius: float
    """Radius of the coil that the film draws, or from which it draws a cylinder."""
    outer: float
    """Outer radius of all that it draws."""
    ends: tuple[tuple[str, float, float], tuple[str, float, float]]
    path: np.ndarray
    """(T, 2, 2): both ends at every pose."""
    sags: np.ndarray | None = None
    """(T, 2): of a rope, from the middle between its ends to the corner of its tangents."""

    @property
    def layer(self) -> str:
        """The name of its layer, and of what takes its room."""
        return f"spring {self.force}"

    @property
    def names(self) -> tuple[str, str]:
        """Names of its barrel and of its whole length on the axis."""
        return f"the spring {self.force}", f"the ends of spring {self.force}"

    def z(self, heights: Heights) -> float:
        """Return the height (rmm) of its axis: the middle of its layer."""
        return heights.bottom(self.layer) + heights.thickness / 2

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield its barrel in its layer and both gaps beside it, and its whole length in its layer."""
        barrel, ends = self.names
        held = self._studs(layout)
        own = {stud.what for stud in held} | {stud.pin.what for stud in held if stud.pin}
        others = [f for f in layout.select(Stretching) if f is not self]
        first, last = self.path[:, :1], self.path[:, 1:]
        inner = np.concatenate([first + HOOK * (last - first), last - HOOK * (last - first)], axis=1)
        if self.sags is not None and self.sags.any():
            inner = _corners(inner, (first + last) / 2 + self.sags[:, None])
        layer, beside = Reach((self.layer,)), Reach((self.layer,), -1, 1)
        studs_alone = frozenset(stud.what for stud in held)
        yield Item(ends, self.layer, Rounded(self.path, BALL + 0.4), layer, source=self, meshes=studs_alone)
        wide = Rounded(inner, self.outer)
        meshes = frozenset(own | {spring.names[0] for spring in others})
        yield Item(barrel, self.layer, wide, beside, source=self, meshes=meshes)
        if others:
            cores = frozenset(_core(spring) for spring in others)
            yield Item(_core(self), self.layer, wide, layer, source=self, only=cores)

    def _studs(self, layout: Layout) -> list[Stud]:
        return [f for f in layout.select(Stud) if any(spring is self for spring, _ in f.ends)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for its barrel, beside that of another and above a pin that its end stands on."""
        sizes, level, over = layout.sizes, levels[self.layer], self.over(layout)
        others = [f for f in layout.select(Stretching) if f is not self]
        pins = [max(levels[body] for body in stud.pin.movers) for stud in self._studs(layout) if stud.pin]
        for gap, next_to in ((level - 1, level - 1), (level, level + 1)):
            beside = [spring.over(layout) for spring in others if levels[spring.layer] == next_to]
            extra = max([0.0, *beside, *(sizes.end_room for top in pins if top == gap)])
            if over + extra > 0:
                yield Need(gap, over + sizes.pivot.fit.axial + extra)

    def over(self, layout: Layout) -> float:
        """Return how far it reaches beyond its layer, up and down (rmm)."""
        return self.outer - layout.sizes.thickness / 2


def _core(spring: Stretching) -> str:
    return f"{spring.names[0]} in its layer"


def _corners(ends: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """Return (T, 3, 2) triangles, counter-clockwise, of two ends (T, 2, 2) and a corner (T, 1, 2)."""
    way, off = ends[:, 1] - ends[:, 0], corner[:, 0] - ends[:, 0]
    left = way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0] >= 0
    return np.concatenate([np.where(left[:, None, None], ends, ends[:, ::-1]), corner], axis=1)


@dataclass(frozen=True, eq=False)
class Stud(Feature):
    """One place of a body (rmm) and the ends (0 or 1) that it holds; ``pin`` where a joint's pin is there."""

    body: str
    x: float
    y: float
    ends: tuple[tuple[Stretching, int], ...]
    pin: Pin | None

    @property
    def name(self) -> str:
        """Name of its first end."""
        spring, end = self.ends[0]
        return f"{spring.force}_{end + 1}"

    @property
    def what(self) -> str:
        """Name of its item."""
        return f"the stud {self.name}"

    @property
    def layers(self) -> tuple[str, ...]:
        """Layers of all that it holds."""
        return tuple(dict.fromkeys(spring.layer for spring, _ in self.ends))

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return an eye in the plate, or the foot of a post."""
        if self.pin is not None:
            return []
        return [Anchor(self.body, self.x, self.y, FOOT if self.body == "ground" else EYE)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield all between its body, or its pin, and what it holds; and that this lies over it."""
        held = frozenset(spring.names[1] for spring, _ in self.ends)
        if self.pin is not None:
            under = Reach(self.pin.movers, high=1, base=True)
            reach, spares = Reach((*self.pin.movers, *self.layers), 1, -1), frozenset(self.pin.places)
        elif self.body == "ground":
            under, reach, spares = None, Reach(self.layers, -1, -1, base=True), frozenset[str]()
        else:
            under = Reach((self.body,), base=True) if layout.springs.above else None
            reach, spares = Reach((self.body, *self.layers), 1, -1), frozenset[str]()
        stands = "post" if self.pin is None and self.body == "ground" else ""
        yield Item(self.what, self.body, disc(self.x, self.y, POST), reach, spares, self, stands=stands)
        if under is not None:
            yield Item(f"{self.what} from below", self.body, disc(self.x, self.y, EYE), under, spares, self, only=held)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for its collar between its plate and a ball in the next layer.

        Springs and pins ask for the rest.
        """
        if self.pin is not None or self.body == "ground":
            return
        fit, ball = layout.sizes.pivot.fit, math.sqrt(BALL**2 - (SHANK / 2) ** 2)
        for layer in self.layers:
            if abs(levels[layer] - levels[self.body]) == 1:
                height = COLLAR_HEIGHT + 2 * fit.seat + ball - layout.sizes.thickness / 2
                yield Need(min(levels[layer], levels[self.body]), height)


# Springs, dampers, actuators and ropes between two points: the room in which the film draws them, and studs at both
# ends. A driver of a distance is an actuator, too.
#
# Such an element has a layer of its own, over both of its bodies where there is an order of layers that allows it. Its
# barrel is thicker than a layer, so it takes a part of the gaps beside its own.
#
#     radius    of a coil, 9 rmm, at most 0.17 of its least length; 0.6 of that for cylinders and rods
#     barrel    from 0.1 to 0.9 of the way between the ends; beyond it a wire or rod on the axis
#     rope      the triangle of its ends and the corner where the tangents of its parabola meet; a line where it is taut

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
    """Return (T, 2) twice the sag of a rope of this length (rmm) along ``down``, or more.

    Its parabola is longer than the two straight lines to its vertex, which are as long as the rope here.
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
    """Return None where it acts along no line, or its ends are on one place at some time, or nearly so."""
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
    """Return how far its second point leaves the x axis of its first marker at most (rmm)."""
    angle = layout.poses[force.i.body.name][:, 2] + force.i.angle
    away = path[:, 1] - path[:, 0]
    return float(np.abs(away[:, 1] * np.cos(angle) - away[:, 0] * np.sin(angle)).max())


def _is_coil(force: Force | Joint) -> bool:
    """Return True if the film draws a coil: what holds energy."""
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
@contact_kind(ROPE)
@driver_kind(LINEAR)
def gather(m: Mechanism, things: Sequence[Force | Joint], layout: Layout) -> list[Feature]:
    """Return studs, then the springs, ropes and drivers that share them, at the first of these kinds."""
    between = stretching(m, layout.apart)
    if things[0] is not between[0]:
        return []
    springs = [spring for force in between if (spring := _stretching(force, layout)) is not None]
    layout.springs.names[:] = [spring.force for spring in springs]
    for spring in springs:
        layout.extra.append(spring.layer)
        layout.poses[spring.layer] = np.zeros((len(layout.times), 3))
    return [*_studs(springs, layout), *springs]


def _studs(springs: Sequence[Stretching], layout: Layout) -> list[Feature]:
    """Gather studs: ends that share a place of a body, or a pin, share one."""
    places: list[tuple[str, float, float, Pin | None, list[tuple[Stretching, int]]]] = []
    for spring in springs:
        for k, (body, x, y) in enumerate(spring.ends):
            pin = next(iter(pins_at(layout, body, (x, y))), None)
            if pin is not None:
                body, (x, y) = pin.home, pin.places[pin.home]
            for place in places:
                if place[0] == body and math.dist(place[1:3], (x, y)) < SAME:
                    place[4].append((spring, k))
                    break
            else:
                places.append((body, x, y, pin, [(spring, k)]))
    return [Stud(body, x, y, tuple(ends), pin) for body, x, y, pin, ends in places]


# The solids of ball studs and their posts (rmm).

COLLAR = 4.6
"""Radius of the collars on its shank."""


@build.register(Stud)
def stud_solids(stud: Stud, plan: Plan, heights: Heights) -> None:
    """A stud with a ball at the height of each end."""
    if stud.pin is not None:
        stud_on_pin(stud, stud.pin, plan, heights)
    elif stud.body == "ground":
        stud_on_post(stud, plan, heights)
    else:
        stud_in_plate(stud, plan, heights)


def stud_in_plate(stud: Stud, plan: Plan, heights: Heights) -> None:
    """Pressed through the plate, with a collar on each side that a ball is on."""
    fit, lines = plan.layout.sizes.pivot.fit, _lines(stud, heights)
    low, high = heights.bottom(stud.body), heights.top(stud.body)
    plan.eye(stud.body, stud.x, stud.y, Eye(EYE, SHANK + fit.press))
    collars = []
    if lines[-1] > high:
        collars.append(Collar(high + fit.seat, COLLAR_HEIGHT, COLLAR))
    if lines[0] < low:
        collars.append(Collar(low - fit.seat - COLLAR_HEIGHT, COLLAR_HEIGHT, COLLAR))
    start, end = (low + 0.3 if lines[0] > low else lines[0]), (high - 0.3 if lines[-1] < high else lines[-1])
    _add(stud, stud.body, ball_stud(SHANK, start, end, lines, BALL, collars), plan, heights)


def stud_on_post(stud: Stud, plan: Plan, heights: Heights) -> None:
    """On a post on the base."""
    fit, lines = plan.layout.sizes.pivot.fit, _lines(stud, heights)
    top = max(lines[0] - BALL - 1.5, 2.0)
    slim, above = POST - 0.5, top - heights.bottoms[0]
    foot = min(FOOT, slim + 0.5 * top / above) if above > 0 else FOOT  # within POST from the lowest layer up
    post = column(top - fit.seat, SHANK + fit.press, 2 * slim, 2 * foot)
    plan.make("ground", f"post_{stud.name}", placed(post, stud.x, stud.y, fit.seat), "aluminium", 1)
    plan.feet.append(Foot("", stud.x, stud.y, FOOT))
    _add(stud, "ground", ball_stud(SHANK, 0.5, lines[-1], lines, BALL, []), plan, heights)


def stud_on_pin(stud: Stud, pin: Pin, plan: Plan, heights: Heights) -> None:
    """On the upper end of a joint's pin."""
    holder, z = upper_end(pin, plan, heights)
    lines = _lines(stud, heights)
    start = z + plan.layout.sizes.pivot.fit.seat
    shape = ball_stud(SHANK, start, lines[-1], lines, BALL, [Collar(start, COLLAR_HEIGHT, COLLAR)])
    _add(stud, holder, shape, plan, heights, pin.places[holder])


def _lines(stud: Stud, heights: Heights) -> list[float]:
    """Return heights of its balls, from below."""
    return sorted({spring.z(heights) for spring, _ in stud.ends})


def _add(
    stud: Stud, body: str, shape: cq.Workplane, plan: Plan, heights: Heights, at: tuple[float, float] | None = None
) -> None:
    x, y = at or (stud.x, stud.y)
    holds = tuple(Hold(spring.force, spring.z(heights), spring.radius) for spring, _ in stud.ends)
    plan.add(body, Solid(f"stud_{stud.name}", placed(shape, x, y), "steel", 0, holds))
