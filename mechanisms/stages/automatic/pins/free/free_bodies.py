"""Bodies that no joint shapes: a ball where nothing holds them, a disc about the centre of mass where springs do.

    r of a ball   (3 m / 4 pi rho)^(1/3)        r of a disc   (m / pi rho t)^(1/2)        rho of aluminium

All are made smaller or larger by one factor, so that the largest has a size that suits the mechanism, and balls never
meet on their ways if that can be helped. So sizes tell masses apart even where no such ball could weigh so much.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.pins.springs.stretching import Stud
from shared.contract.materials import MATERIALS
from shared.shapes.build import eased, extruded
from shared.shapes.outline import circle
from shared.shapes.stud import ball

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

LARGEST = (14.0, 20.0)
"""Least and most radius of the largest (rmm)."""
LEAST = 6.0
APART = 0.9
"""What the radii of two balls may be together, of their least distance."""
DENSITY = MATERIALS["aluminium"].density


@dataclass(frozen=True, eq=False)
class FreeBody:
    """A ball or disc of this radius about a body's centre of mass (rmm)."""

    body: str
    x: float
    y: float
    radius: float
    is_ball: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """A disc is where its body's plate is."""
        return [] if self.is_ball else [Anchor(self.body, self.x, self.y, self.radius)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """A ball in its layer, and in the gaps beside that if it is thicker."""
        if self.is_ball:
            thick = int(self.over(layout) > 0)
            shape = disc(self.x, self.y, self.radius)
            yield Item(f"the ball {self.body}", self.body, shape, Reach((self.body,), -thick, thick), source=self)

    def over(self, layout: Layout) -> float:
        """How far a ball reaches beyond its layer (rmm)."""
        return self.radius - layout.sizes.thickness / 2 if self.is_ball else 0.0

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for a ball above and below its layer."""
        if self.over(layout) > 0:
            for gap in (levels[self.body] - 1, levels[self.body]):
                yield Need(gap, self.over(layout) + layout.sizes.pivot.fit.axial)

    def build(self, plan: Plan, heights: Heights) -> None:
        """The whole body, or the plate round its centre of mass."""
        if self.is_ball:
            shape = ball(self.radius).translate((self.x, self.y, heights.thickness / 2))
        else:
            shape = eased(extruded(circle(self.x, self.y, self.radius), heights.thickness), 0.8)
        plan.plate(self.body, shape, (self.x, self.y, self.radius))


def free_bodies(layout: Layout) -> list[Feature]:
    """One for each body without a joint or a shape of its own."""
    m = layout.m
    held = [*m.joints.values(), *(force for force in m.forces.values() if force.kind.journal is not None)]
    shaped = {body for joint in held for body in joint.bodies}
    others = [feature for feature in layout.features if not isinstance(feature, Stud)]
    shaped |= {item.body for feature in others for item in feature.items(layout)}
    names = [name for name in layout.bodies if name not in shaped]
    if not names:
        return []
    held = {a.body for feature in layout.features for a in feature.anchors(layout)}
    scale = layout.sizes.scale * 1e-3
    radii = {}
    for name in names:
        mass = m.bodies[name].mass
        if name in held:
            radii[name] = math.sqrt(mass / (math.pi * DENSITY * layout.sizes.thickness * scale)) / scale
        else:
            radii[name] = (3 * mass / (4 * math.pi * DENSITY)) ** (1 / 3) / scale
    largest = max(radii.values())
    factor = min(max(largest, LARGEST[0]), LARGEST[1]) / largest if largest > 0 else 0.0
    radii = {name: max(factor * radius, LEAST) for name, radius in radii.items()}
    places = {name: _place(layout, name) for name in names}
    ways = {name: layout.seen(name, places[name], "ground") for name in names}
    crowded = [
        APART * float(np.linalg.norm(ways[a] - ways[b], axis=1).min()) / (radii[a] + radii[b])
        for a, b in combinations([name for name in names if name not in held], 2)
    ]
    shrink = max(min([1.0, *crowded]), LEAST / LARGEST[1])
    features: list[Feature] = []
    for name in names:
        radius = radii[name] if name in held else radii[name] * shrink
        features.append(FreeBody(name, *places[name], radius, name not in held))
    return features


def _place(layout: Layout, name: str) -> tuple[float, float]:
    x, y = layout.m.bodies[name].com
    return layout.sizes.of_metres(x), layout.sizes.of_metres(y)
