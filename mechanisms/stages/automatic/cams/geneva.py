"""Geneva: the crank carries a pin with a roller, and at the height of the wheel a locking disc round its own axis."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.cams.own_plates import refuse_ground
from mechanisms.stages.automatic.layout.extents import Extent, distance, extent
from mechanisms.stages.automatic.layout.features import kind
from mechanisms.stages.automatic.layout.items import Anchor, Item, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.pins.free.rim_marks import Face
from mechanisms.stages.automatic.slides.common_pins import passed
from mechanisms.stages.automatic.slides.slots import Slot
from shared.shapes.geneva import Geneva

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.items import Levels
    from mechanisms.stages.automatic.layout.layout import Layout

WALL = 4.0
"""Wall of the wheel's tips beside the slots (rmm), at least."""
HUB, PIN_CIRCLE, NEAR = 25.0, 28.0, 14.5
"""Least distances (rmm): the bottom of the slots from the wheel's axis, pin from crank, wheel from the crank's axis."""
LOOSE = 1.5
"""Gap between locking disc and wheel, in running fits."""


@dataclass(frozen=True, eq=False)
class GenevaDrive:
    """Centres and directions of pin and slot in the frames of crank and wheel (rmm, rad)."""

    name: str
    crank: str
    wheel: str
    crank_at: tuple[float, float, float]
    wheel_at: tuple[float, float, float]
    shape: Geneva

    @property
    def fills(self) -> str:
        """The body whose layer leaves no room for teeth."""
        return self.wheel

    def face_of(self, body: str, layout: Layout) -> Face | None:
        """Face of the wheel: within its slots."""
        bottom = self.shape.bottom
        return Face(*self.wheel_at[:2], bottom - 1.0) if body == self.wheel else None

    @property
    def pin(self) -> Slot:
        """The pin in a slot, as far as its hardware goes; the wheel has its slots already."""
        x, y, angle = self.crank_at
        at = x + self.shape.radius * math.cos(angle), y + self.shape.radius * math.sin(angle)
        return Slot(self.name, self.wheel, self.crank, np.array([self.wheel_at[:2]]), at)

    @property
    def runs_through(self) -> Slot:
        """The wheel's slots."""
        return self.pin

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Eyes for the axes, and one that holds the pin."""
        eye = layout.sizes.eye
        anchors = [Anchor(body, at[0], at[1], eye) for body, at in self._ends()]
        return [*anchors, Anchor(self.crank, *self.pin.pin_at, eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The wheel, the pin through it, the locking disc; and a rule: the crank, whose disc stands in the wheel's
        layer, is in another one even where its arm never comes near the wheel.
        """
        both, between = frozenset((self.crank, self.wheel)), Reach((self.crank, self.wheel))
        wheel, lock = disc(*self.wheel_at[:2], self.shape.rim), disc(*self.crank_at[:2], self.shape.lock)
        yield Item(f"the wheel of {self.name}", self.wheel, wheel, Reach((self.wheel,)), source=self)
        apart = disc(*self.wheel_at[:2], self.shape.distance)
        rule = f"the layer of the wheel of {self.name}"
        yield Item(rule, self.wheel, apart, Reach((self.wheel,)), source=self, only=frozenset((self.crank,)))
        yield Item(f"the locking disc of {self.name}", self.crank, lock, between, both, self)
        pin = disc(*self.pin.pin_at, layout.sizes.hardware)
        reach, meshes = Reach((self.crank, self.wheel), 1, 1), passed(self.pin, layout)
        yield Item(f"the pin of {self.name}", self.crank, pin, reach, both, self, meshes)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """As a pin in a slot."""
        return self.pin.needs_under(self, levels, layout)

    def _ends(self) -> list[tuple[str, tuple[float, float, float]]]:
        return [(self.crank, self.crank_at), (self.wheel, self.wheel_at)]


@kind("geneva")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """One for each joint."""
    drives: list[Feature] = []
    for joint in joints:
        refuse_ground(m, joint, joint.i.body.name, joint.j.body.name)
        sizes = layout.sizes
        ends = [(*layout.place(marker), marker.angle) for marker in (joint.i, joint.j)]
        apart = layout.seen(joint.j.body.name, ends[1][:2], joint.i.body.name)[0]
        shape = Geneva(
            slots=joint.params["slots"],
            distance=math.hypot(apart[0] - ends[0][0], apart[1] - ends[0][1]),
            radius=sizes.of_metres(joint.params["radius"]),
            slot=sizes.roller + sizes.pivot.fit.running,
            wall=WALL,
            gap=LOOSE * sizes.pivot.fit.running,
        )
        drives.append(GenevaDrive(joint.name, joint.i.body.name, joint.j.body.name, ends[0], ends[1], shape))
    return drives


@extent("geneva")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """The pin's circle and the wheel; room for hubs where the two come near each other's axes."""
    apart, radius, slots = distance(joint, solution), joint.params["radius"], joint.params["slots"]
    rim = apart * math.cos(math.pi / slots)
    return Extent(
        ((joint.i, radius), (joint.j, rim)),
        ((apart - radius, HUB), (radius, PIN_CIRCLE), (apart - rim, NEAR)),
    )
