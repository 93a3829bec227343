"""Welds: two plates, one above the other, on a spacer with two bolts; on ground a block carries the plate."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.layout.items import BASE, Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.layout.planar import around
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.shapes.pin import Head, pin
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

BOLT, HEAD = 5.0, Head(9.0, 3.0, 0.8)
"""Diameter of a bolt (rmm), and its head."""
APART = 7.0
"""From the weld's middle to either bolt."""
BLOCK, ROUND = 6.5, 9.5
"""Radius of a spacer round its bolts, and of the plates there."""


@dataclass(frozen=True, eq=False)
class Weld:
    """Place and direction (rmm, rad) of the joint on two bodies; one may be ground."""

    name: str
    ends: tuple[tuple[str, float, float, float], tuple[str, float, float, float]]

    @property
    def movers(self) -> tuple[str, ...]:
        """The bodies that are not ground."""
        return tuple(body for body, *_ in self.ends if body != "ground")

    def bolts(self, body: str) -> list[tuple[float, float]]:
        """Places of both bolts in the frame of one of the bodies."""
        _, x, y, angle = next(end for end in self.ends if end[0] == body)
        way = APART * math.cos(angle), APART * math.sin(angle)
        return [(x - way[0], y - way[1]), (x + way[0], y + way[1])]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Both bolts on every body."""
        return [Anchor(body, x, y, ROUND) for body, *_ in self.ends for x, y in self.bolts(body)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """From the lower body, or the base, to the bolts' heads."""
        home = self.ends[0][0] if len(self.movers) == 2 else "ground"
        shape = around(self.bolts(home), BLOCK + 1.0)
        reach = Reach(self.movers, 1, 1) if home != "ground" else Reach(self.movers, high=1, base=True)
        bodies = frozenset(body for body, *_ in self.ends)
        what = f"the weld {self.name}"
        yield Item(what, home, shape, reach, bodies, self, stands=what if home == "ground" else "")

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Room for the heads under what passes over them."""
        fit, top = layout.sizes.pivot.fit, max(levels[body] for body in self.movers)
        if layout.is_covered(self, 2 * (top + 1), levels, 1):
            yield Need(top, HEAD.height + fit.seat + fit.axial)
        if len(self.movers) == 1 and top == 0:
            yield Need(BASE, layout.sizes.pedestal)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Spacer and bolts, which belong to the lower body."""
        fit, stack = plan.layout.sizes.pivot.fit, sorted(self.movers, key=heights.bottom)
        home = stack[0] if len(stack) == 2 else "ground"
        low = heights.top(stack[0]) if len(stack) == 2 else 0.0
        high, top = heights.bottom(stack[-1]) - fit.seat, heights.top(stack[-1]) + fit.seat
        places = self.bolts(home)
        hull = outline.hull([(x, y, BLOCK) for x, y in places])
        holes = [outline.circle(x, y, (BOLT + fit.press) / 2) for x, y in places]
        spacer = extruded(hull, high - low - fit.seat, low + fit.seat, holes)
        plan.make(home, f"spacer_{self.name}", spacer, "aluminium", 2)
        for body in stack:
            for x, y in self.bolts(body):
                plan.eye(body, x, y, Eye(ROUND, BOLT + fit.press))
        start = heights.bottom(stack[0]) + 0.3 if len(stack) == 2 else 0.5
        for k, (x, y) in enumerate(places, start=1):
            plan.make(
                home,
                f"bolt_{self.name}_{k}",
                placed(pin(BOLT, top - start, HEAD, chamfer=0.4), x, y, start),
                "steel",
                0,
            )
        if home == "ground":
            plan.feet += [Foot("", x, y, ROUND) for x, y in places]


@kind("weld")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """One for each joint; bolts and plates of two welded bodies touch."""
    found: list[Feature] = []
    for joint in joints:
        first, second = ((k.body.name, *layout.place(k), k.angle) for k in (joint.i, joint.j))
        layout.pressing.add(frozenset((first[0], second[0])))
        found.append(Weld(joint.name, (first, second)))
    return found
