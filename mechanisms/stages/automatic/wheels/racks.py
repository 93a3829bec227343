"""Racks with their pinions, and the solids of racks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from mbsd import Mechanism
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build
from mechanisms.stages.automatic.layout.planar import Rounded, disc
from mechanisms.stages.automatic.wheels.wheels import Wheel
from shared.shapes.build import extruded
from shared.shapes.involute import DEDENDUM, rack_outline, wire
from shared.shapes.outline import circle
from shared.shapes.solid import placed
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Racks: a toothed bar in the layer of its pinions, screwed to its body's plate or on posts of the ground.
#
# The bar is in phase with its pinions and as long as their way over it. It has a layer of its own and stands off its
# body's plate by two studs, so that a slide may guide the body right under the teeth.

BACK = 11.0
"""Height of the bar under its teeth."""
STUD = 4.5
"""Radius of a stud or post."""
LEAST = 24.0
"""Least pitch radius of a pinion (rmm): its pedestal stays clear of a slide under the rack's pitch line."""
APART = 30.0
"""Distance of the studs (rmm), where the bar is long enough."""
FAR = 0.05
"""Part of the module by which a pinion may stand off the pitch line."""


@dataclass(eq=False)
class Rack(Feature):
    """Its pitch line is the x axis of (x, y, angle) on its body (rmm, rad); the teeth point along y."""

    name: str
    body: str
    x: float
    y: float
    angle: float
    ways: list[tuple[float, float]]
    """From where to where the pinions' centres go along the pitch line."""
    module: float = 0.0
    tip: float = 0.0
    play: float = 0.0
    phase: float | None = None
    """Place of a tooth along the pitch line (rmm)."""
    mates: list[Wheel] = field(default_factory=list)

    @property
    def what(self) -> str:
        """In messages."""
        return f"the rack of {self.body} at {self.name}"

    @property
    def layer(self) -> str:
        """Name that decides the layer: its own."""
        return self.what

    @property
    def pitch(self) -> float:
        """From tooth to tooth."""
        return math.pi * self.module

    @property
    def root(self) -> float:
        """Height of the spaces (negative)."""
        return -DEDENDUM * self.module

    @property
    def teeth(self) -> tuple[int, int]:
        """Numbers of the first and last tooth that pinions come to, counted from the one at ``phase``."""
        beyond = max(math.sqrt(max(p.tip**2 - (p.radius - self.tip) ** 2, 0.0)) for p in self.mates) + self.pitch
        low, high = min(way[0] for way in self.ways) - beyond, max(way[1] for way in self.ways) + beyond
        phase = self.phase or 0.0
        return math.floor((low - phase) / self.pitch), math.ceil((high - phase) / self.pitch)

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of the bar along the pitch line: in the middle of spaces."""
        first, last = self.teeth
        return (self.phase or 0.0) + (first - 0.5) * self.pitch, (self.phase or 0.0) + (last + 0.5) * self.pitch

    def place(self, along: float, across: float) -> tuple[float, float]:
        """Return a place in the body's frame."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return self.x + c * along - s * across, self.y + s * along + c * across

    def sees(self, pinion: Wheel, layout: Layout) -> tuple[float, float]:
        """Return the pinion's place along the pitch line and its body's angle against the rack at the start."""
        along, _ = _path(self, pinion, layout)[0]
        turn = layout.poses[pinion.body][0][2] - layout.poses[self.body][0][2] - self.angle
        return float(along), float(turn)

    def seats(self, layout: Layout) -> list[tuple[float, float]]:
        """Return where studs or posts carry the bar: as near to the rest of the body as they can be."""
        low, high = (end + side * (STUD + 1.0) for end, side in zip(self.ends, (1, -1), strict=True))
        across = self.root - BACK / 2
        if self.body == "ground":
            return [self.place(low, across), self.place(high, across)]
        others = [f for f in layout.features if f is not self and not isinstance(f, Rack)]
        c, s = math.cos(self.angle), math.sin(self.angle)
        places = [a for f in others for a in f.anchors(layout) if a.body == self.body]
        along = [c * (a.x - self.x) + s * (a.y - self.y) for a in places]
        middle = sum(along) / len(along) if along else (low + high) / 2
        half = min(APART, high - low) / 2
        middle = min(max(middle, low + half), high - half)
        return [self.place(middle - half, across), self.place(middle + half, across)]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return its seats."""
        return [Anchor(self.body, x, y, STUD + 2.0) for x, y in self.seats(layout)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the bar, and what carries it."""
        (low, high), edge = self.ends, 0.2
        corners = [(low, self.root - BACK), (high, self.root - BACK), (high, self.tip), (low, self.tip)]
        bar = Rounded(np.array([self.place(*corner) for corner in corners]), edge)
        meshes = frozenset(mate.what for mate in self.mates)
        yield Item(self.what, self.body, bar, Reach((self.layer,)), source=self, meshes=meshes, spared=False)
        reach = (
            Reach((self.layer,), -1, -1, base=True) if self.body == "ground" else Reach((self.body, self.layer), 1, -1)
        )
        for x, y in self.seats(layout):
            yield Item(f"a stud of {self.what}", self.body, disc(x, y, STUD), reach, source=self, spared=False)


def add_way(m: Mechanism, rack: Rack, pinion: Wheel, joint: Joint, layout: Layout) -> None:
    """Add the pinion's way along the rack.

    Raises UserError if its centre is not always its radius above the pitch line.
    """
    path = _path(rack, pinion, layout)
    rack.ways.append((float(path[:, 0].min()), float(path[:, 0].max())))
    off = float(np.abs(path[:, 1] - pinion.radius).max())
    if off > FAR * pinion.radius / 9:
        at = int(np.abs(path[:, 1] - pinion.radius).argmax())
        scale = layout.sizes.scale
        raise UserError(
            f"{m.name}: {joint.kind.name} '{joint.name}': at t={layout.times[at]:.3g} s the pinion's centre is "
            f"{path[at, 1] * scale:.4g} mm above the rack's x axis, its pitch line; "
            f"teeth need that to be the pitch radius, {pinion.radius * scale:.4g} mm; "
            f"move the rack's marker or the pinion, or write {shown_file(m.name, 'parts')}"
        )


def _path(rack: Rack, pinion: Wheel, layout: Layout) -> np.ndarray:
    """Return (T, 2) the pinion's centre along and across the pitch line."""
    seen = layout.seen(pinion.body, (pinion.x, pinion.y), rack.body) - np.array([rack.x, rack.y])
    c, s = math.cos(rack.angle), math.sin(rack.angle)
    return np.stack([c * seen[:, 0] + s * seen[:, 1], c * seen[:, 1] - s * seen[:, 0]], axis=1)


# The solids of a rack (rmm): the toothed bar, and the studs or posts that carry it.


@build.register(Rack)
def build_rack(rack: Rack, plan: Plan, heights: Heights) -> None:
    """Build a steel bar; in its body's layer it is part of the plate."""
    first, last = rack.teeth
    outline = rack_outline(
        last - first + 1,
        rack.module,
        rack.tip,
        rack.root,
        BACK,
        rack.play / 2,
        (rack.phase or 0.0) + first * rack.pitch,
    )
    bar = placed(extruded(wire(outline), heights.thickness), rack.x, rack.y, turn=math.degrees(rack.angle))
    z, seat = heights.bottom(rack.layer), plan.layout.sizes.pivot.fit.seat
    if rack.body == "ground":
        low, high = seat, z - seat
    elif heights.bottom(rack.body) == z:
        plan.plate(rack.body, bar, (rack.x, rack.y, 0.0))
        return
    else:
        low, high = heights.between(rack.body, rack.layer, seat, seat)
    plan.make(rack.body, f"rack_{rack.name}", placed(bar, z=z), "steel", 0)
    for k, (x, y) in enumerate(rack.seats(plan.layout)):
        stud = extruded(circle(x, y, STUD), high - low, low)
        plan.make(rack.body, f"stud_{rack.name}_{k + 1}", stud, "aluminium", 0)
        if rack.body == "ground":
            plan.feet.append(Foot("", x, y, STUD + 2.0))
