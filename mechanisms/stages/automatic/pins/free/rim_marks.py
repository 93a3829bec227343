"""Traced points on the rim of a wheel, a disc or a cam, where an eye would break teeth or meet the road.

A brass pointer stands on a collar over the face of the wheel, its tip at the point; a pin within the rim holds it. It
stays over what the wheel rolls on or meshes with. Where that gap has no room, the pin alone marks the radius of the
point. Hub and pins of a small wheel may leave no room for either; then the film's trail alone shows the point.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Layout
from mechanisms.stages.automatic.layout.order.heights import Heights
from mechanisms.stages.automatic.layout.plan import Plan
from mechanisms.stages.automatic.layout.planar import Rounded
from mechanisms.stages.automatic.pins.pins import Pin
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.shapes.pin import pin
from shared.shapes.solid import placed

HEIGHT, TIP = 1.4, 0.5
"""Height of a pointer, and radius of its tip (rmm)."""
SHANK, LEAST = 2.0, 0.5
"""Most and least radius of its pin (rmm)."""
WALL, BASE = 0.8, 0.8
"""Between the pin and the rim's end, and of the pointer round its pin (rmm)."""
BESIDE = 0.5
"""From the pointer to the hardware of a pin (rmm)."""
SEEN = 0.05
"""How far a pointer's tip stands out from its collar at least (rmm)."""


class Face(NamedTuple):
    """Face of a wheel, in its body's frame (rmm): what lies within ``inner`` is solid and touches nothing; beyond
    ``outer`` the body may have an arm.
    """

    x: float
    y: float
    inner: float
    outer: float = math.inf


@dataclass(frozen=True, eq=False)
class RimMark:
    """A traced point (rmm), and the place and radius of the pin in the rim; ``raised``: with its pointer."""

    name: str
    body: str
    x: float
    y: float
    at: tuple[float, float]
    radius: float
    raised: bool

    @property
    def points(self) -> bool:
        """Whether there is a pointer: none where the pin is at the point."""
        return self.raised and math.dist(self.at, (self.x, self.y)) > TIP

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """The pin, within the rim."""
        return [Anchor(self.body, *self.at, self.radius + WALL)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The pointer, over the face of its wheel."""
        if self.points:
            shape = Rounded(np.array([self.at, (self.x, self.y)]), self.radius + BASE)
            own = frozenset(
                joint_pin.what
                for joint_pin in layout.features
                if isinstance(joint_pin, Pin) and self._is_clear_of(joint_pin)
            )
            yield Item(
                f"the pointer of {self.name}", self.body, shape, Reach((self.body,), 1, 1), source=self, meshes=own,
                spared=False,
            )  # fmt: skip

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for the pointer."""
        level = levels[self.body]
        if self.points and layout.is_covered(self, 2 * (level + 1), levels, 1):
            fit = layout.sizes.pivot.fit
            yield Need(level, HEIGHT + 2 * fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """A pin flush with the face, or a pointer with its shank."""
        fit, top, (x, y) = plan.layout.sizes.pivot.fit, heights.top(self.body), self.at
        plan.eye(self.body, x, y, Eye(self.radius + WALL, 2 * self.radius + fit.press))
        if not self.points:
            shape = pin(2 * self.radius, heights.thickness - 0.2, chamfer=0.15 * self.radius)
            plan.make(self.body, f"point_{self.name}", placed(shape, x, y, top - heights.thickness), "brass", 0)
            return
        needle = outline.hull([(x, y, self.radius + BASE), (self.x, self.y, TIP)])
        depth = heights.thickness - 0.4
        low = top + fit.axial
        shank = extruded(outline.circle(x, y, self.radius), low + 0.5 - (top - depth), top - depth)
        collar = extruded(outline.circle(x, y, self.radius + BASE), low + 0.5 - (top + fit.seat), top + fit.seat)
        shape = extruded(needle, HEIGHT, low).union(collar).union(shank)
        plan.make(self.body, f"pointer_{self.name}", shape, "brass", 0)

    def _is_clear_of(self, joint_pin: Pin) -> bool:
        """Whether a pin of its body is near, from whose hardware it keeps away by its place."""
        return self.body in joint_pin.places and math.dist(joint_pin.places[self.body], self.at) < math.dist(
            joint_pin.places[self.body], (self.x, self.y)
        )


def face_at(body: str, x: float, y: float, layout: Layout) -> Face | None:
    """The face of the wheel on whose rim, or beyond whose working surface, an eye at a place of a body would be."""
    eye = layout.sizes.stylus_eye
    for feature in layout.features:
        face_of = getattr(feature, "face_of", None)
        face = face_of(body, layout) if face_of else None
        if face is None:
            continue
        away = math.hypot(x - face.x, y - face.y)
        if face.inner < away + eye and away - eye < face.outer + layout.sizes.room:
            return face
    return None


def rim_mark(
    name: str, body: str, x: float, y: float, face: Face, taken: Sequence[Anchor], raised: bool, layout: Layout
) -> RimMark | None:
    """As near to the point as the rim leaves room; None where hub and pins leave none."""
    away, hardware = math.hypot(x - face.x, y - face.y), layout.sizes.hardware
    own = [anchor for anchor in taken if anchor.body == body]
    held = any(math.hypot(a.x - face.x, a.y - face.y) < 0.02 and a.radius > hardware for a in own)
    low, high = hardware + BESIDE + BASE if held else 0.0, face.inner - WALL
    radius = min(SHANK, (high - low) / 2)
    if radius < LEAST or away < radius:
        return None
    reach, hidden = min(high - radius, away), radius + BASE - TIP + SEEN
    if raised and TIP < away - reach < hidden:  # the tip would be under the collar
        inwards = away - radius - BASE
        reach, raised = (inwards, True) if inwards > low + radius else (reach, False)
    part = reach / away
    at = face.x + part * (x - face.x), face.y + part * (y - face.y)
    beside = [a for a in own if math.hypot(a.x - face.x, a.y - face.y) > 0.02]
    needed = radius + BASE + BESIDE
    if any(math.hypot(a.x - at[0], a.y - at[1]) < needed + min(a.radius, hardware) for a in beside):
        return None
    return RimMark(name, body, x, y, at, radius, raised)
