"""Outlines that an author joins to a body's plate: a leg, a chainring, a blade. They keep others away as plates do."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.assembly.body_shape import EDGES, first_made
from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.planar import Rounded, convex_hull
from shared.shapes.build import eased, extruded

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from shared.shapes.outline import Point

SAMPLES = 90
"""Points on an outline from which its convex hull is taken."""


@dataclass(frozen=True, eq=False)
class Joined:
    """One outline (mm, the body's frame)."""

    body: str
    outline: cq.Wire
    at: Point
    """The joint whose eye is within it (mm)."""
    holes: tuple[cq.Wire, ...]
    sharp: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """None: the plate need not reach round it."""
        return []

    def items(self, layout: Layout) -> Iterable[Item]:
        """Its convex hull at the height of the plate."""
        places = [self.outline.positionAt(k / SAMPLES) for k in range(SAMPLES)]
        points = np.array([(place.x, place.y) for place in places])
        shape = Rounded(convex_hull(points / layout.sizes.scale), 0.0)
        return [Item(f"the outline of {self.body}", self.body, shape, Reach((self.body,)), source=self)]

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """A part of the plate."""
        scale = plan.layout.sizes.scale
        shape = extruded(self.outline, heights.thickness * scale, holes=self.holes)
        shape = shape.newObject([shape.val().scale(1 / scale)])
        x, y = (part / scale for part in self.at)
        shape = first_made([partial(eased, shape, edge) for edge in (EDGES[-1:] if self.sharp else EDGES)])
        plan.plate(self.body, shape, (x, y, plan.layout.sizes.eye), len(self.holes))
