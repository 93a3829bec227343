"""Round bodies that roll or touch: their discs, and the solids of these."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, cast

from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan, build
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.layout.sizes import CLEAR
from mechanisms.stages.automatic.pins.free_bodies import Face
from shared.shapes.build import extruded
from shared.shapes.outline import circle
from shared.shapes.pin import washer
from shared.shapes.screw import ball as sphere
from shared.shapes.solid import placed
from shared.stage.errors import UserError

# Round parts that touch something: a ball that is free, a wheel with a tyre, a disc on a body that has joints.
#
# They are made with the clearance of a cam and its roller from what they touch.

type Look = Literal["ball", "wheel", "disc"]

ROLLING = ("rolling_disc", "rolling_on_curve")
"""Kinds of joints that put no pin through the middle."""
HUB = 0.3
"""Radius of the hub of a wheel without an axle, in its own."""
WITHIN = 0.8
"""Radius of the end of a plate within a disc, in the disc's."""
TYRE = 0.16
"""Thickness of a tyre as a part of the wheel's radius; 5 rmm at most, or as much as it is pressed in."""
RIM = 1.0
"""Width of the wheel that stays between its hub and a tyre that is pressed in far (rmm)."""
OVER = 0.4
"""How far a wall reaches above the middle of a ball, in its radii."""


@dataclass(eq=False)
class Round(Feature):
    """A circle about a place of a body (rmm). ``radius`` is that of the model, ``short`` what is left off."""

    name: str
    body: str
    at: tuple[float, float]
    radius: float
    short: float
    look: Look
    pinned: bool = True
    """True if a pin goes through its middle."""
    meets: set[str] = field(default_factory=set)
    """Bodies with discs that touch it."""
    pressed: float = 0.0
    """How far it is seen to be pressed in (rmm)."""

    @property
    def fills(self) -> str:
        """The body whose layer leaves no room for teeth."""
        return self.body

    @property
    def built_radius(self) -> float:
        """The radius as it is made."""
        return self.radius - self.short

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the middle, within what touches."""
        return [Anchor(self.body, *self.at, min(self.hub(layout), self.built_radius))]

    def face_of(self, body: str, layout: Layout) -> Face | None:
        """Return the face within the tyre of a wheel; a disc but for its edge."""
        if body != self.body or self.look == "ball":
            return None
        return Face(*self.at, self.rim(layout) - 0.5 if self.look == "wheel" else self.built_radius - 0.5)

    def tyre(self, layout: Layout) -> float:
        """Return how thick a wheel's tyre is (rmm): thicker where it is pressed in, as far as it can be."""
        running = layout.sizes.pivot.fit.running
        return max(
            min(TYRE * self.built_radius, 5.0), min(self.pressed + running, self.built_radius - self.hub(layout) - RIM)
        )

    def rim(self, layout: Layout) -> float:
        """Return the radius of a wheel within its tyre (rmm)."""
        return self.built_radius - self.tyre(layout) - layout.sizes.pivot.fit.seat

    def hub(self, layout: Layout) -> float:
        """Return the radius of the solid middle (rmm)."""
        if self.look == "wheel":
            return layout.sizes.eye if self.pinned else HUB * self.built_radius
        return min(layout.sizes.eye, WITHIN * self.built_radius)

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the circle at the height of its body; a ball is higher than that."""
        reach = Reach((self.body,), -1, 1) if self.look == "ball" else Reach((self.body,))
        yield Item(
            f"the {self.look} of {self.name}",
            self.body,
            disc(*self.at, self.built_radius),
            reach,
            frozenset(self.meets),
            self,
        )

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room of a ball below and above the layer."""
        if self.look == "ball":
            level, beyond = (
                levels[self.body],
                self.built_radius - layout.sizes.thickness / 2 + layout.sizes.pivot.fit.axial,
            )
            yield Need(level - 1, beyond)
            yield Need(level, beyond)

    def top(self, heights: Heights) -> float:
        """Return how high what it touches must reach (rmm)."""
        if self.look == "ball":
            return max(
                heights.top(self.body), heights.bottom(self.body) + heights.thickness / 2 + OVER * self.built_radius
            )
        return heights.top(self.body)


def round_at(
    layout: Layout, name: str, body: str, at: tuple[float, float], radius: float, look: Look, pressed: float = 0.0
) -> tuple[Round, bool]:
    """Return the round part at a place of a body, and whether it is a new one.

    ``radius`` and ``pressed`` in rmm.

    Where there is one already, it becomes as small as all that it touches ask for, and a wheel if one of them does.
    """
    short = CLEAR * layout.sizes.pivot.fit.running + pressed
    key = (body, round(at[0], 3), round(at[1], 3))
    if key not in layout.rounds:
        held = [joint for joint in layout.m.joints.values() if joint.kind.name not in ROLLING]
        ends = [marker for joint in held for marker in (joint.i, joint.j)]
        pinned = any(marker.body.name == body and math.dist(layout.place(marker), at) < 0.01 for marker in ends)
        new = layout.rounds[key] = Round(name, body, at, radius, short, look, pinned)
        return new, True
    there = cast(Round, layout.rounds[key])
    least = min(there.built_radius, radius - short)
    there.radius = min(there.radius, radius)
    there.short = there.radius - least
    there.look = "wheel" if "wheel" in (there.look, look) else there.look
    return there, False


# The solids of balls, wheels with tyres, and discs (rmm).

HOLES = 5
WIDE = 9.0
"""A wheel with so much between hub and tyre (rmm), and with nothing but its axle on it, has round holes."""


@build.register(Round)
def round_solids(part: Round, plan: Plan, heights: Heights) -> None:
    """As it looks."""
    plan.outer[part] = plan.main[part.body]
    {"ball": ball, "wheel": tyred_wheel, "disc": plain_disc}[part.look](part, plan, heights)


def tyred_wheel(wheel: Round, plan: Plan, heights: Heights) -> None:
    """A disc with holes becomes its body's plate, with a tyre round it.

    Raises UserError if it is pressed in farther than a tyre can be thick.
    """
    fit, (x, y), hub = plan.layout.sizes.pivot.fit, wheel.at, wheel.hub(plan.layout)
    tyre = wheel.tyre(plan.layout)
    if wheel.pressed > tyre:
        scale = plan.layout.sizes.scale
        raise UserError(
            f"{plan.layout.m.name}: '{wheel.name}' lets the wheel of {wheel.body} be pressed "
            f"{wheel.pressed * scale:.4g} mm into what it runs on; with a radius of "
            f"{wheel.built_radius * scale:.4g} mm its tyre is {tyre * scale:.4g} mm thick at most; "
            "make the contact stiffer or the radius larger, or let the wheel start nearer to the surface"
        )
    rim = wheel.rim(plan.layout)
    shape = extruded(circle(0, 0, rim), heights.thickness).faces("|Z").edges().chamfer(0.4)
    alone = all(math.hypot(a.x - x, a.y - y) < 0.01 for a in plan.layout.anchors[wheel.body])
    holes = HOLES if alone and rim - hub > WIDE else 0
    for k in range(holes):
        tool = extruded(circle((hub + rim) / 2, 0, 0.3 * (rim - hub)), heights.thickness + 2.0, -1.0)
        shape = shape.cut(placed(tool, turn=360.0 * k / holes))
    plan.plate(wheel.body, placed(shape, x, y), (x, y, hub + 0.1 if holes else rim - 0.5), holes)
    band = washer(2 * (rim + fit.seat), 2 * wheel.built_radius, heights.thickness, chamfer=0.25 * tyre)
    plan.outer[wheel] = plan.make(
        wheel.body, f"tyre_{wheel.name}", placed(band, x, y, heights.bottom(wheel.body)), "rubber", 1
    )


def ball(ball: Round, plan: Plan, heights: Heights) -> None:
    """A ball is its body, its middle in the middle of the layer."""
    (x, y), z = ball.at, heights.thickness / 2
    shape = sphere(ball.built_radius)
    plan.plate(ball.body, placed(shape, x, y, z), (x, y, ball.built_radius + 0.1))


def plain_disc(disc: Round, plan: Plan, heights: Heights) -> None:
    """A disc is part of its body's plate."""
    x, y = disc.at
    edge = min(0.4, 0.1 * disc.built_radius)
    shape = extruded(circle(x, y, disc.built_radius), heights.thickness).faces("|Z").edges().chamfer(edge)
    plan.plate(disc.body, shape, (x, y, disc.built_radius + 0.1))
