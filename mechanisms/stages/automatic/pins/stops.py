"""Stops of revolute joints: for each end of the way a stop pin on either body, or on a post.

    R    distance of all stop pins from the axis        r    their radius        c    the clearance where they meet
    d    2 R sin(d / 2) = 2 r + c      the angle between two of them that meet

The pin of the second body stands in the direction b of that body. So at the lower end l the other one is in the
direction l + b - d of the first body, and at the upper end u in the direction u + b + d. There are none where the whole
way, with d at both ends, is a turn or more.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from mbsd import Mechanism
from mechanisms.stages.automatic.layout import motion
from mechanisms.stages.automatic.layout.items import BASE, PIVOT, Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.layout.sizes import CLEAR
from shared.shapes.link import Eye
from shared.shapes.pin import pin
from shared.shapes.solid import placed

AWAY, RADIUS, EYE = 17.8, 3.2, 6.2
"""R and r, and the radius of the plate round a stop pin (rmm)."""
DEEP = 5.0
"""How far a stop pin reaches out of its plate towards a post (rmm)."""
MEET = 4.0
"""Least height of a gap in which two of them meet (rmm)."""
WAYS = 24
"""Directions that are tried for the stop pin of the second body."""

type Place = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Stop(Feature):
    """The stop pins of one joint (rmm, in the frames of their bodies)."""

    name: str
    first: str
    second: str
    ends: tuple[tuple[str, Place], ...]
    """Stop pins of the first body: "lower" or "upper", and where."""
    nose: Place
    """Stop pin of the second body."""

    @property
    def whats(self) -> tuple[str, str]:
        """Names of its items: on the first body, and on the second."""
        return f"the stop {self.name}", f"the stop pin of {self.second} at {self.name}"

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return plates round them, and what posts need on the base."""
        radius = RADIUS + 1.0 if self.first == "ground" else EYE
        return [Anchor(self.second, *self.nose, EYE), *(Anchor(self.first, *at, radius) for _, at in self.ends)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield all between the two plates, or from the base to the plate."""
        still, moving = self.whats
        if self.first == "ground":
            post, nose = Reach((self.second,), -1, -1, base=True), Reach((self.second,), -1, -1)
        else:
            post = nose = Reach((self.first, self.second), 1, -1)
        for _, at in self.ends:
            shape = disc(*at, RADIUS + 0.4)
            stands = PIVOT if self.first == "ground" else ""
            yield Item(still, self.first, shape, post, source=self, meshes=frozenset((moving,)), stands=stands)
        shape = disc(*self.nose, RADIUS + 0.4)
        yield Item(moving, self.second, shape, nose, source=self, meshes=frozenset((still,)))

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room in which they meet."""
        axial = layout.sizes.pivot.fit.axial
        if self.first == "ground":
            level = levels[self.second]
            yield Need(level - 1, DEEP + 2 * axial + (2.0 if level - 1 == BASE else 0.0))
        else:
            yield Need(min(levels[self.first], levels[self.second]), MEET)

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build pins pressed into the plates, or standing on the base."""
        fit = plan.layout.sizes.pivot.fit
        low, high = heights.bottom(self.second), heights.top(self.second)
        if self.first == "ground":
            self._pin(plan, self.second, "", self.nose, low - DEEP, high - 0.3)
            for end, (x, y) in self.ends:
                shape = pin(2 * RADIUS, low - fit.axial - fit.seat, chamfer=0.6)
                plan.make("ground", f"stop_{self.name}_{end}", placed(shape, x, y, fit.seat), "brass", 0)
                plan.feet.append(Foot("", x, y, RADIUS + 1.0))
            return
        under, over = heights.bottom(self.first), heights.top(self.first)
        above = low > under
        for end, at in self.ends:
            z = (under + 0.3, low - fit.axial) if above else (high + fit.axial, over - 0.3)
            self._pin(plan, self.first, end, at, *z)
        z = (over + fit.axial, high - 0.3) if above else (low + 0.3, under - fit.axial)
        self._pin(plan, self.second, "", self.nose, *z)

    def _pin(self, plan: Plan, body: str, end: str, at: Place, low: float, high: float) -> None:
        plan.eye(body, *at, Eye(EYE, 2 * RADIUS + plan.layout.sizes.pivot.fit.press))
        name = "_".join(word for word in ("stop", self.name, end or body) if word)
        plan.make(body, name, placed(pin(2 * RADIUS, high - low, chamfer=0.5), *at, low), "brass", 0)


def stops(m: Mechanism, features: list[Feature], layout: Layout) -> list[Feature]:
    """Return stops of all revolute joints with limits or stops; ``features`` are those of the joints."""
    taken = [anchor for feature in features for anchor in feature.anchors(layout)]
    stop_pins: list[Feature] = []
    for joint in m.joints.values():
        if joint.kind.pair != "pin" or layout.apart.intersection(joint.bodies):
            continue
        ends = motion.turning(joint, m)
        (i, j), swap = (joint.i, joint.j), joint.j.body.name == "ground"
        if swap:
            i, j, ends = j, i, (None if ends[1] is None else -ends[1], None if ends[0] is None else -ends[0])
        if ends == (None, None) or joint.name in layout.springs.left_out:
            continue
        first, second = i.body.name, j.body.name
        angle = layout.poses[second][:, 2] - layout.poses[first][:, 2]
        apart = 2 * RADIUS + CLEAR * layout.sizes.pivot.fit.running
        meet = 2 * math.asin(apart / (2 * AWAY))
        least, most = min(angle.min(), *_given(ends)), max(angle.max(), *_given(ends))
        if most - least + 2 * meet > 2 * math.pi:
            continue
        way = _way([a for a in taken if a.body == second], layout.place(j), layout)
        at = [
            (word, end + way + side * meet)
            for word, end, side in zip(("lower", "upper"), ends, (-1, 1), strict=True)
            if end is not None
        ]
        stop_pins.append(
            Stop(
                joint.name,
                first,
                second,
                tuple((word, _polar(layout.place(i), direction)) for word, direction in at),
                _polar(layout.place(j), way),
            )
        )
        layout.springs.names.append(joint.name)
    return stop_pins


def _given(ends: motion.Limits) -> list[float]:
    return [end for end in ends if end is not None]


def _way(taken: list[Anchor], axis: Place, layout: Layout) -> float:
    """Return where the second body has its stop pin (rad).

    Towards a far joint, where its plate is anyway, else where it is farthest from all that is on the body.
    """
    others = np.array([[a.x - axis[0], a.y - axis[1]] for a in taken if math.dist((a.x, a.y), axis) > 0.1])
    if not len(others):
        return 0.0
    for x, y in others:
        way = math.atan2(y, x)
        if np.hypot(*(others - _polar((0.0, 0.0), way)).T).min() > layout.sizes.hardware + RADIUS + 1.0:
            return way
    ways = [2 * math.pi * k / WAYS for k in range(WAYS)]
    return max(ways, key=lambda way: round(float(np.hypot(*(others - _polar((0.0, 0.0), way)).T).min()), 6))


def _polar(axis: Place, angle: float) -> Place:
    return axis[0] + AWAY * math.cos(angle), axis[1] + AWAY * math.sin(angle)
