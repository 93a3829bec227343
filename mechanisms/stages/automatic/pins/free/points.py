"""Points that no joint shapes: traced points get a stylus, free ends of bars and lone centres of mass a weight."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.pins.free.free_bodies import FreeBody
from mechanisms.stages.automatic.pins.free.rim_marks import face_at, rim_mark
from shared.shapes.link import Eye
from shared.shapes.pin import Head, pin, stylus
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

SHANK = 4.0
"""Diameter of what holds a stylus (rmm)."""
TIP = 14.4
"""Height of a stylus above its plate (rmm), at least."""
BOSS = 1.5
WEIGHT = 4.0
"""Height of a weight above its plate (rmm)."""


@dataclass(frozen=True, eq=False)
class Stylus:
    """A traced point: a brass tip where all above can pass, else a brass pin flush with the plate."""

    name: str
    body: str
    x: float
    y: float
    tall: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """A small eye."""
        return [Anchor(self.body, self.x, self.y, layout.sizes.stylus_eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """All above it, if it is tall."""
        if not self.tall:
            return []
        shape = disc(self.x, self.y, layout.sizes.stylus_eye - 1.0)
        return [Item(f"the stylus of {self.name}", self.body, shape, Reach((self.body,), 1, top=True), source=self)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """The stylus in an eye."""
        press = plan.layout.sizes.pivot.fit.press
        seat, top = plan.layout.sizes.pivot.fit.seat, heights.top(self.body)
        if not self.tall:
            plan.eye(self.body, self.x, self.y, Eye(7.0, SHANK + press))
            shape = pin(SHANK, heights.thickness - 0.2, chamfer=0.3)
            plan.make(
                self.body, f"point_{self.name}", placed(shape, self.x, self.y, top - heights.thickness), "brass", 0
            )
            return
        plan.eye(self.body, self.x, self.y, Eye(7.0, SHANK + press, above=BOSS, boss=5.2))
        highest = heights.bottoms[-1] + heights.thickness + 6.0
        height = max(TIP, highest - top - BOSS)
        shape = stylus(SHANK, heights.thickness + 1.0, height, 0.9)
        plan.make(self.body, f"stylus_{self.name}", placed(shape, self.x, self.y, top + BOSS + seat), "brass", 0)


@dataclass(frozen=True, eq=False)
class Weight:
    """A brass weight at the free end of a bar, or at the centre of mass of a body with one joint."""

    body: str
    x: float
    y: float

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """An eye as large as a joint's."""
        return [Anchor(self.body, self.x, self.y, layout.sizes.eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The weight's head above the plate."""
        shape = disc(self.x, self.y, layout.sizes.eye)
        return [Item(f"the weight of {self.body}", self.body, shape, Reach((self.body,), 1, 1), source=self)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for its head."""
        level = levels[self.body]
        if layout.is_covered(self, 2 * (level + 1), levels, 1):
            yield Need(level, WEIGHT + layout.sizes.pivot.fit.seat + layout.sizes.pivot.fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """A plug with a wide head."""
        sizes = plan.layout.sizes
        fit = sizes.pivot.fit
        plan.eye(self.body, self.x, self.y, Eye(sizes.eye, sizes.pivot.held))
        head = Head(2 * sizes.eye - 3.0, WEIGHT, 1.6)
        bolt = pin(sizes.pivot.pin, heights.thickness - 0.3 + fit.seat, head)
        plan.make(
            self.body, f"weight_{self.body}", placed(bolt, self.x, self.y, heights.bottom(self.body) + 0.3), "brass", 0
        )


def styluses(layout: Layout, tall: bool, pointers: bool) -> list[Feature]:
    """One for every traced point of a moving body, except where a joint's eye or a weight is, and on balls. Points on
    rims get marks there (rim_marks.py), with ``pointers`` where these are wanted.
    """
    features: list[Feature] = []
    balls = {feature.body for feature in layout.features if isinstance(feature, FreeBody) and feature.is_ball}
    taken = [a for feature in layout.features for a in feature.anchors(layout)]
    for name, marker in layout.m.traces.items():
        body, (x, y) = marker.body.name, layout.place(marker)
        near = layout.sizes.eye + layout.sizes.stylus_eye
        face = face_at(body, x, y, layout) if body in layout.moving else None
        if face is not None:
            mark = rim_mark(name, body, x, y, face, taken, pointers, layout)
            features += [mark] if mark else []
            continue
        if (
            body not in layout.moving
            or body in balls
            or any(a.body == body and math.hypot(a.x - x, a.y - y) < near for a in taken)
        ):
            continue
        features.append(Stylus(name, body, x, y, tall))
    return features


def weights(layout: Layout, heavy: bool) -> list[Feature]:
    """For bars with a free end, and for bodies with one joint, but no wheels or tyres, whose centre of mass is
    elsewhere.

    ``heavy``: only for ends of bars where their centre of mass is, even if they are traced.
    """
    features: list[Feature] = []
    free = {feature.body for feature in layout.features if isinstance(feature, FreeBody)}
    round_bodies = {*layout.wheels, *(body for body, _, _ in layout.rounds)}
    taken = [a for feature in layout.features for a in feature.anchors(layout)]
    for name in layout.bodies:
        body = layout.m.bodies[name]
        here = [a for a in taken if a.body == name]
        centre = (layout.sizes.of_metres(body.com[0]), layout.sizes.of_metres(body.com[1]))
        if body.length is not None:
            ends = [(0.0, 0.0), (layout.sizes.of_metres(body.length), 0.0)]
        elif len(here) < 2 and name not in free and name not in round_bodies:
            ends = [centre]
        else:
            continue
        for x, y in ends:
            if heavy and (body.length is None or math.dist((x, y), centre) > layout.sizes.eye):
                continue
            if all(math.hypot(a.x - x, a.y - y) > 2 * layout.sizes.eye for a in here):
                features.append(Weight(name, x, y))
    return features
