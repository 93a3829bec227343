"""Pulleys: wheels with a rim for a round belt, or for a chain where the joint has teeth; what the belt needs of room.

The rim is a piece of its own and says where the film lays the belt (render/film/tubes/belts.py), which is no solid:
its strands keep other parts out of their layer, and the clearance knows it as a band (stages/clearance/belts.py).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.planar import Rounded
from mechanisms.stages.automatic.wheels.wheels import Wheel

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

LEAST = 19.0
"""Least pitch radius of a pulley (rmm)."""
BELT = 1.8
"""Radius of a round belt (rmm)."""
RIM = 5.5
"""From the pitch circle in to where the rim begins."""
STAYS = 0.02
"""A strand is at rest in a body if the centres move by less in it (rmm)."""


@dataclass(eq=False)
class Pulley(Wheel):
    """A pulley; with ``teeth`` a sprocket. Only its pitch radius and what is inside of it are a wheel's."""

    belt: str = ""

    @property
    def what(self) -> str:
        """In messages."""
        return f"the pulley of {self.body} at {self.name}"

    @property
    def root(self) -> float:
        """Where the rim begins."""
        return self.radius - RIM - self.tooth

    @property
    def tooth(self) -> float:
        """Height of a sprocket's teeth above the pitch circle, and depth of their spaces below it."""
        return 0.3 * 2 * math.pi * self.radius / self.teeth if self.teeth else 0.0

    @property
    def lip(self) -> float:
        """The rim's outer radius."""
        return self.radius + (self.tooth if self.teeth else 0.6 * BELT)


@dataclass(frozen=True, eq=False)
class Belt:
    """The strands of a belt between two pulleys: what must stay out of their way."""

    name: str
    pulleys: tuple[Pulley, Pulley]
    crossed: bool

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """None."""
        return []

    def items(self, layout: Layout) -> Iterable[Item]:
        """Both strands, in a body in which they rest; none where there is no such body."""
        first, second = self.pulleys
        for body in layout.poses:
            ends = [layout.seen(pulley.body, (pulley.x, pulley.y), body) for pulley in self.pulleys]
            if max(float(np.ptp(end, axis=0).max()) for end in ends) > STAYS:
                continue
            a, b = ends[0][0], ends[1][0]
            away = float(np.hypot(*(b - a)))
            turn, radius = math.atan2(b[1] - a[1], b[0] - a[0]), second.radius
            lean = math.acos(min(max((first.radius + (radius if self.crossed else -radius)) / away, -1.0), 1.0))
            names = frozenset(pulley.what for pulley in self.pulleys)
            for side in (1.0, -1.0):
                u = np.array([math.cos(turn + side * lean), math.sin(turn + side * lean)])
                core = np.array([a + first.radius * u, b + (-radius if self.crossed else radius) * u])
                shape = Rounded(core, 2 * BELT)
                yield Item(f"the belt of {self.name}", body, shape, Reach((first.layer,)), source=self, meshes=names)
            return

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """None."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """Nothing: the film lays it."""
