"""Welds: two plates on a spacer with two bolts; on ground a block carries the plate.

The bolts are at the weld's place, along its direction. Where pins, slots or other bolts of its bodies are in their way
they stand across, or farther away: what is welded is one rigid thing, wherever its bolts are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mbsd import Mechanism
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.items import BASE, Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, kind
from mechanisms.stages.automatic.layout.planar import around
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.shapes.pin import Head, pin
from shared.shapes.solid import placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

BOLT, HEAD = 5.0, Head(9.0, 3.0, 0.8)
"""Diameter of a bolt (rmm), and its head."""
APART = 7.0
"""From the weld's middle to either bolt."""
STEP, FARTHEST = 4.0, 80.0
"""How far bolts are moved at a time, and at most (rmm)."""
BESIDE = 1.0
"""From a spacer to the hardware of a pin (rmm)."""
BLOCK, ROUND = 6.5, 9.5
"""Radius of a spacer round its bolts, and of the plates there."""


@dataclass(frozen=True, eq=False)
class Weld(Feature):
    """Place and direction (rmm, rad) of the joint on two bodies; one may be ground."""

    name: str
    ends: tuple[tuple[str, float, float, float], tuple[str, float, float, float]]
    """In common directions: the second is turned against the first as they stand welded."""

    @property
    def movers(self) -> tuple[str, ...]:
        """The bodies that are not ground."""
        return tuple(body for body, *_ in self.ends if body != "ground")

    def bolts(self, body: str) -> list[tuple[float, float]]:
        """Return places of both bolts in the frame of one of the bodies."""
        _, x, y, angle = next(end for end in self.ends if end[0] == body)
        way = APART * math.cos(angle), APART * math.sin(angle)
        return [(x - way[0], y - way[1]), (x + way[0], y + way[1])]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return both bolts on every body."""
        return [Anchor(body, x, y, ROUND) for body, *_ in self.ends for x, y in self.bolts(body)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the room from the lower body, or the base, to the bolts' heads."""
        home = self.ends[0][0] if len(self.movers) == 2 else "ground"
        shape = around(self.bolts(home), BLOCK + 1.0)
        reach = Reach(self.movers, 1, 1) if home != "ground" else Reach(self.movers, high=1, base=True)
        bodies = frozenset(body for body, *_ in self.ends)
        what = f"the weld {self.name}"
        yield Item(what, home, shape, reach, bodies, self, stands=what if home == "ground" else "")

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for the heads under what passes over them."""
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
    """Return one feature for each joint; bolts and plates of two welded bodies touch."""
    welds: list[Feature] = []
    for joint in joints:
        first, second = ((k.body.name, *layout.place(k), k.angle) for k in (joint.i, joint.j))
        layout.pressing.add(frozenset((first[0], second[0])))
        welds.append(Weld(joint.name, (first, second)))
    return welds


def with_free_bolts(features: Sequence[Feature], layout: Layout) -> list[Feature]:
    """Return the features, with the bolts of each weld at the nearest place that is free on both bodies.

    Raises UserError for a weld without such a place.
    """
    kept = [feature for feature in features if not isinstance(feature, Weld)]
    for weld in (feature for feature in features if isinstance(feature, Weld)):
        places = [anchor for feature in kept for anchor in feature.anchors(layout)]  # what is welded is another body
        taken = {body: [anchor for anchor in places if anchor.body == body] for body, *_ in weld.ends}
        free = next((moved for moved in _moved(weld) if _is_free(moved, taken, layout)), None)
        if free is None:
            m, (first, second) = layout.m, (body for body, *_ in weld.ends)
            raise UserError(
                f"{m.name}: joint '{weld.name}': the bolts that hold '{first}' and '{second}' together find no place "
                f"within {FARTHEST * layout.sizes.scale:.3g} mm beside the pins of both; move joints apart, make pins "
                f"thinner (automatic(m, pin=...)), or write {shown_file(m.name, 'parts')}"
            )
        kept.append(free)
    order = {feature.name: feature for feature in kept if isinstance(feature, Weld)}
    return [order[feature.name] if isinstance(feature, Weld) else feature for feature in features]


def _moved(weld: Weld) -> Iterable[Weld]:
    """Yield the weld itself, across, and then farther and farther away in all directions."""
    for way in (0.0, *np.arange(STEP, FARTHEST, STEP)):
        count = 1 if way == 0.0 else 8
        for side in 2 * np.pi * np.arange(count) / count:
            for turn in (0.0, np.pi / 2, np.pi / 4, -np.pi / 4):
                ends = [
                    (body, x + way * math.cos(angle + side), y + way * math.sin(angle + side), angle + turn)
                    for body, x, y, angle in weld.ends
                ]
                yield replace(weld, ends=(ends[0], ends[1])) if way or turn else weld


def _is_free(weld: Weld, taken: Mapping[str, Sequence[Anchor]], layout: Layout) -> bool:
    """Return True if spacer and bolts stay clear of all hardware on both bodies."""
    for body, anchors in taken.items():
        (ax, ay), (bx, by) = weld.bolts(body)
        for anchor in anchors:
            along = ((anchor.x - ax) * (bx - ax) + (anchor.y - ay) * (by - ay)) / (2 * APART) ** 2
            part = min(max(along, 0.0), 1.0)
            gap = math.hypot(anchor.x - ax - part * (bx - ax), anchor.y - ay - part * (by - ay))
            if gap < BLOCK + min(anchor.radius, layout.sizes.hardware) + BESIDE:
                return False
    return True
