"""Springs, dampers, actuators and ropes between two points: the room in which the film draws them, and studs at both
ends. A driver of a distance is an actuator, too.

What stretches has a layer of its own, over both of its bodies where there is an order of layers that allows it. Its
barrel is thicker than a layer, so it takes a part of the gaps beside its own.

    radius    of a coil, 9 rmm, at most 0.17 of its least length; 0.6 of that for cylinders and rods
    barrel    from 0.1 to 0.9 of the way between the ends; beyond it a wire or rod on the axis
    rope      the triangle of its ends and the corner to which the tangents of its parabola go; a line where it is taut
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import LINEAR, ROPE, stretching
from mechanisms.stages.automatic.layout.features import Feature, Need, contact_kind, driver_kind, force_kind
from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.planar import Rounded
from mechanisms.stages.automatic.pins.stud_solids import BALL
from mechanisms.stages.automatic.pins.studs import Stud, studs

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.force import Force
    from mbsd.joint import Joint
    from mechanisms.stages.automatic.layout.features import Anchor
    from mechanisms.stages.automatic.layout.heights import Heights
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.plan import Plan

RADIUS, BROAD = 9.0, 0.17
"""Of a coil's middle line: at most (rmm), and at most as a part of its least length."""
WIRE, CYLINDER = 0.2, 0.6
"""Radius of the wire, and of a cylinder, in radii of a coil."""
HOOK = 0.1
"""Part of the way at either end where there is no barrel yet."""
ASIDE = 0.05
"""How far a point may leave the axis along which gas or an actuator pushes it (rmm)."""
CORD = 1.5
"""Radius of a rope (rmm)."""
LEAST = 4.0
"""Lengths of the balls at its ends that what stretches has at least; what gets shorter has no studs."""


@dataclass(frozen=True, eq=False)
class Stretching:
    """One spring, damper or actuator: its ends (body, x, y in its frame) and their ways in the world, in rmm."""

    force: str
    radius: float
    """Of the coil that the film draws, or from which it draws a cylinder."""
    outer: float
    """Of all that it draws."""
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
        """Of its barrel and of its whole length on the axis."""
        return f"the spring {self.force}", f"the ends of spring {self.force}"

    def z(self, heights: Heights) -> float:
        """Height (rmm) of its axis: the middle of its layer."""
        return heights.bottom(self.layer) + heights.thickness / 2

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """None: the studs have them."""
        return []

    def items(self, layout: Layout) -> Iterable[Item]:
        """Its barrel in its layer and both gaps beside it, and its whole length in its layer."""
        barrel, ends = self.names
        held = self._studs(layout)
        own = {stud.what for stud in held} | {stud.pin.what for stud in held if stud.pin}
        others = [f for f in layout.features if isinstance(f, Stretching) and f is not self]
        first, last = self.path[:, :1], self.path[:, 1:]
        inner = np.concatenate([first + HOOK * (last - first), last - HOOK * (last - first)], axis=1)
        if self.sags is not None and self.sags.any():
            inner = _corners(inner, (first + last) / 2 + self.sags[:, None])
        layer, beside = Reach((self.layer,)), Reach((self.layer,), -1, 1)
        studs_alone = frozenset(stud.what for stud in held)
        yield Item(ends, self.layer, Rounded(self.path, BALL + 0.4), layer, source=self, meshes=studs_alone)
        wide = Rounded(inner, self.outer)
        meshes = frozenset(own | {one.names[0] for one in others})
        yield Item(barrel, self.layer, wide, beside, source=self, meshes=meshes)
        if others:
            cores = frozenset(_core(one) for one in others)
            yield Item(_core(self), self.layer, wide, layer, source=self, only=cores)

    def _studs(self, layout: Layout) -> list[Stud]:
        return [f for f in layout.features if isinstance(f, Stud) and any(one is self for one, _ in f.ends)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for its barrel, beside that of another and above a pin that its end stands on."""
        sizes, level, over = layout.sizes, levels[self.layer], self.over(layout)
        others = [f for f in layout.features if isinstance(f, Stretching) and f is not self]
        pins = [max(levels[body] for body in stud.pin.movers) for stud in self._studs(layout) if stud.pin]
        for gap, next_to in ((level - 1, level - 1), (level, level + 1)):
            beside = [one.over(layout) for one in others if levels[one.layer] == next_to]
            extra = max([0.0, *beside, *(sizes.end_room for top in pins if top == gap)])
            if over + extra > 0:
                yield Need(gap, over + sizes.pivot.fit.axial + extra)

    def over(self, layout: Layout) -> float:
        """How far it reaches beyond its layer, up and down (rmm)."""
        return self.outer - layout.sizes.thickness / 2

    def build(self, plan: Plan, heights: Heights) -> None:
        """Nothing: the film draws it."""


def _core(one: Stretching) -> str:
    return f"{one.names[0]} in its layer"


def _corners(ends: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """(T, 3, 2) triangles, counter-clockwise, of two ends (T, 2, 2) and a corner (T, 1, 2)."""
    way, off = ends[:, 1] - ends[:, 0], corner[:, 0] - ends[:, 0]
    left = way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0] >= 0
    return np.concatenate([np.where(left[:, None, None], ends, ends[:, ::-1]), corner], axis=1)


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
    along_axis = force.kind.name == "gas" or force.params.get("along_axis")
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
    found = [one for force in between if (one := _stretching(force, layout)) is not None]
    layout.springs.found[:] = [one.force for one in found]
    for one in found:
        layout.extra.append(one.layer)
        layout.poses[one.layer] = np.zeros((len(layout.times), 3))
    return [*studs(found, layout), *found]
