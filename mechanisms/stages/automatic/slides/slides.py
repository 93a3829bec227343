"""Sliding joints: rails, the carriages on them, and their solids."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout import motion
from mechanisms.stages.automatic.layout.items import Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build
from mechanisms.stages.automatic.layout.planar import Rounded
from mechanisms.stages.automatic.layout.sizes import CLEAR
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.solid import placed

# Prismatic joints: a block with two gibs on a rail, which is on the body of the first marker.
#
# On ground the rail stands on the base, or on two posts where the block is high. Between moving bodies the rail is
# screwed to its body's plate on the side of the block. Where the second marker is on ground, the block stands there,
# and the rail hangs under its body. Limits and stops are blocks beside the rail, which the gibs meet. Rails on ground
# that would cross are the grooves of a plate (rails.py).

RAIL = 12.0
"""Width of a rail."""
RAIL_HEIGHT = 6.0
"""Least height of a rail that is screwed to a plate."""
BEAM = 8.0
"""Height of a rail that stands on posts."""
HALF_LENGTH = 23.0
"""Half the length of a block."""
GIB = (28.0, 4.4)
"""Length and width of a gib."""
POST = 6.0
"""How far a rail's post reaches inwards from the middle of the rail's round end."""
STOP = 8.0
"""Length of a stop beside the rail."""
WALL = 3.0
"""Width of a rail's plate beside the rail (rmm)."""


@dataclass(frozen=True, eq=False)
class Slide(Feature):
    """A rail on one body and a block on another: places, directions (rmm, rad) and the travel."""

    name: str
    rail: str
    block: str
    rail_at: tuple[float, float, float]
    block_at: tuple[float, float, float]
    travel: tuple[float, float]
    """Travel of the block's middle along the rail, from its marker; as far as its stops where it has any."""
    ends: motion.Limits = (None, None)
    """Where stops on the rail end that travel, before and behind."""
    shorter: tuple[float, float] = (0.0, 0.0)
    """By how much its round ends begin earlier, before and behind: where the rail's own body has a pin there; below 0
    where other blocks run on it, too, or where it lies above another rail.
    """
    guests: tuple[Slide, ...] = ()
    """Other slides on its rail."""
    host: str = ""
    """The slide whose rail this one runs on; empty: its own."""

    def rail_ends(self) -> list[tuple[float, float]]:
        """Return middles of the rail's round ends, in its body's frame: the block never leaves it."""
        first, last = self.travel[0] - HALF_LENGTH, self.travel[1] + HALF_LENGTH
        return [self.rail_place(first + self.shorter[0]), self.rail_place(last - self.shorter[1])]

    def posts(self) -> list[list[tuple[float, float]]]:
        """Return middles of the round ends of both posts, which reach inwards from the rail's ends."""
        a, b = np.array(self.rail_ends())
        inwards = POST * (b - a) / np.hypot(*(b - a))
        return [[(float(x), float(y)) for x, y in foot] for foot in ((a, a + inwards), (b, b - inwards))]

    def rail_place(self, distance: float) -> tuple[float, float]:
        """Return a place on the rail, that far from its marker, in its body's frame."""
        return _along(self.rail_at, distance)

    def block_place(self, distance: float) -> tuple[float, float]:
        """Return a place on the line of the block, that far from its marker, in its body's frame."""
        return _along(self.block_at, distance)

    def stops(self, layout: Layout) -> list[tuple[str, float]]:
        """Return each stop on the rail: its name, and the distance of its middle from the rail's marker."""
        beyond = GIB[0] / 2 + CLEAR * layout.sizes.pivot.fit.running + STOP / 2
        words = (("lower", -beyond), ("upper", beyond))
        return [(word, end + off) for (word, off), end in zip(words, self.ends, strict=True) if end is not None]

    def across(self, distance: float) -> list[tuple[float, float]]:
        """Return two places beside the rail, that far from its marker, in its body's frame."""
        x, y, angle = *self.rail_place(distance), self.rail_at[2] + math.pi / 2
        return [_along((x, y, angle), side) for side in (-RAIL / 2 - GIB[1] / 2, RAIL / 2 + GIB[1] / 2)]

    def block_ends(self, radius: float) -> list[tuple[float, float]]:
        """Return middles of the block's round ends, in its body's frame."""
        reach = HALF_LENGTH - radius
        return [self.block_place(-reach), self.block_place(reach)]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the block's plate, and a plate under the rail."""
        eye = layout.sizes.eye
        anchors = [Anchor(self.block, x, y, eye) for x, y in self.block_ends(eye)]
        if self.rail != "ground":
            anchors += [Anchor(self.rail, x, y, RAIL / 2 + WALL) for x, y in self.rail_ends()]
        return anchors

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the rail, its posts, and the gibs of the block."""
        rail = Rounded(np.array(self.rail_ends()), RAIL / 2 + 1.0)
        block = Rounded(np.array(self.block_ends(layout.sizes.eye)), layout.sizes.eye)
        what, gibs = f"the rail of {self.host or self.name}", f"the block of {self.name}"
        on_it = (self, *self.guests)  # nothing else of these bodies passes through the rail
        sliding = frozenset(name for slide in on_it for name in (slide.block, f"the block of {slide.name}"))
        if self.host:
            reach = Reach((self.block,), -1, -1) if self.rail == "ground" else Reach((self.rail, self.block), 1, -1)
            meshes = frozenset((what,) if self.rail == "ground" else (what, self.rail))
            yield Item(gibs, self.block, block, reach, source=self, meshes=meshes)
            return
        at_end = [Rounded(np.array(self.across(s)), STOP / 2 + 0.5) for _, s in self.stops(layout)]
        if self.rail == "ground":
            below = Reach((self.block,), -1, -1)
            posts = Reach((self.block,), -1, -1, base=True)
            yield Item(what, "ground", rail, below, source=self, meshes=sliding, stands=what)
            for foot in self.posts():
                post = Rounded(np.array(foot), RAIL / 2)
                yield Item(what, "ground", post, posts, source=self, meshes=sliding, stands=what)
            for stop in at_end:
                yield Item(what, "ground", stop, below, source=self, meshes=sliding, stands=what)
            yield Item(gibs, self.block, block, below, source=self, meshes=frozenset((what,)))
        elif self.block == "ground":
            reach = Reach((self.rail,), -1, -1, base=True)
            for shape in (rail, *at_end):
                yield Item(what, self.rail, shape, Reach((self.rail,), -1, -1), source=self, meshes=sliding)
            yield Item(gibs, "ground", block, reach, source=self, meshes=frozenset((what, self.rail)), stands=what)
        else:
            between = Reach((self.rail, self.block), 1, -1)
            for shape in (rail, *at_end):
                yield Item(what, self.rail, shape, between, source=self, meshes=sliding)
            yield Item(gibs, self.block, block, between, source=self, meshes=frozenset((what, self.rail)))

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for the rail under, or between, the plates."""
        axial = layout.sizes.pivot.fit.axial
        if self.rail == "ground":
            yield Need(levels[self.block] - 1, BEAM + 2 * axial)
        elif self.block == "ground":
            yield Need(levels[self.rail] - 1, RAIL_HEIGHT + 2 * axial + 2.0)
        else:
            low = min(levels[self.rail], levels[self.block])
            if abs(levels[self.rail] - levels[self.block]) == 1:
                yield Need(low, RAIL_HEIGHT + 2 * axial)


def _along(at: tuple[float, float, float], distance: float) -> tuple[float, float]:
    return at[0] + distance * math.cos(at[2]), at[1] + distance * math.sin(at[2])


# The solids of a slide (rmm): rail, gibs, and what carries the rail or the block on ground.

DEPTH = 4.8
"""How far gibs reach down beside the rail."""


@build.register(Slide)
def slide_solids(slide: Slide, plan: Plan, heights: Heights) -> None:
    """Rail, gibs and what carries them."""
    if slide.rail == "ground":
        fixed_rail(slide, plan, heights)
    elif slide.block == "ground":
        fixed_block(slide, plan, heights)
    else:
        moving_rail(slide, plan, heights)


def fixed_rail(slide: Slide, plan: Plan, heights: Heights) -> None:
    """A rail on ground under the block's plate: a bed on the base, or a beam on two posts."""
    fit = plan.layout.sizes.pivot.fit
    ends, top = slide.rail_ends(), heights.bottom(slide.block) - fit.axial
    low = heights.levels[slide.block] == 0
    bottom = fit.seat if low else top - BEAM
    if not slide.host:
        plan.make("ground", f"rail_{slide.name}", _bar(ends, RAIL / 2, bottom, top), "steel", 0)
        _stops(slide, bottom, top, plan)
    for k, ((x, y), foot) in enumerate([] if slide.host else zip(ends, slide.posts(), strict=True), start=1):
        plan.feet.append(Foot("", x, y, RAIL / 2 + 2.0))
        if not low:
            post = _bar(foot, RAIL / 2 - 1.0, fit.seat, bottom - fit.seat)
            plan.make("ground", f"post_{slide.name}_{k}", post, "aluminium", 0)
    z = heights.bottom(slide.block) - fit.seat
    _gibs(slide, slide.block, slide.block_at, z - DEPTH, z, plan)


def fixed_block(slide: Slide, plan: Plan, heights: Heights) -> None:
    """A rail under a moving plate, in a block that stands on the base."""
    sizes = plan.layout.sizes
    fit, radius = sizes.pivot.fit, sizes.eye
    rail_top = heights.bottom(slide.rail) - fit.seat
    floor = rail_top - RAIL_HEIGHT - fit.axial
    plan.make(
        slide.rail, f"rail_{slide.name}", _bar(slide.rail_ends(), RAIL / 2, floor + fit.axial, rail_top), "steel", 0
    )
    _stops(slide, floor + fit.axial, rail_top, plan)
    ends = slide.block_ends(radius)
    plan.make("ground", f"block_{slide.name}", _bar(ends, radius, fit.seat, floor), "aluminium", 0)
    plan.feet += [Foot("", x, y, radius + 2.0) for x, y in ends]
    _gibs(slide, "ground", slide.block_at, floor + fit.seat, floor + fit.seat + DEPTH, plan)


def moving_rail(slide: Slide, plan: Plan, heights: Heights) -> None:
    """A rail on a moving plate, on the side where the block is."""
    fit = plan.layout.sizes.pivot.fit
    z0, z1 = heights.between(slide.rail, slide.block, fit.seat, fit.axial)
    low, high = heights.between(slide.rail, slide.block, 0.0, fit.seat)
    above = heights.levels[slide.rail] < heights.levels[slide.block]
    gibs = (high - DEPTH, high) if above else (low, low + DEPTH)
    if not slide.host:
        plan.make(slide.rail, f"rail_{slide.name}", _bar(slide.rail_ends(), RAIL / 2, z0, z1), "steel", 0)
        _stops(slide, z0, z1, plan)
    _gibs(slide, slide.block, slide.block_at, *gibs, plan)


def _gibs(slide: Slide, body: str, at: tuple[float, float, float], z0: float, z1: float, plan: Plan) -> None:
    """Two strips beside the rail, with room to slide."""
    length, width = GIB
    aside = RAIL / 2 + plan.layout.sizes.pivot.fit.axial / 2 + width / 2
    strip = cq.Workplane().box(length, width, z1 - z0).edges("|Z").chamfer(0.8)
    for side in (1, 2):
        offset = aside if side == 1 else -aside
        x, y = at[0] - offset * math.sin(at[2]), at[1] + offset * math.cos(at[2])
        shape = placed(strip, x, y, (z0 + z1) / 2, math.degrees(at[2]))
        plan.make(body, f"gib_{slide.name}_{side}", shape, "bronze", 0)


def _stops(slide: Slide, z0: float, z1: float, plan: Plan) -> None:
    """Two blocks beside the rail at either end of its way: the gibs meet them."""
    layout, angle = plan.layout, slide.rail_at[2]
    seat = layout.sizes.pivot.fit.seat
    width = GIB[1] + layout.sizes.pivot.fit.axial / 2 - seat
    block = cq.Workplane().box(STOP, width, z1 - z0).edges("|Z").chamfer(0.6)
    for word, distance in slide.stops(layout):
        x, y = slide.rail_place(distance)
        for side in (1, 2):
            off = (RAIL / 2 + seat + width / 2) * (1 if side == 1 else -1)
            at = x - off * math.sin(angle), y + off * math.cos(angle)
            shape = placed(block, *at, (z0 + z1) / 2, math.degrees(angle))
            plan.make(slide.rail, f"stop_{slide.name}_{word}_{side}", shape, "brass", 0)


def _bar(ends: list[tuple[float, float]], radius: float, z0: float, z1: float) -> cq.Workplane:
    """Return a bar with round ends and eased edges between two heights."""
    return eased(bar(ends, radius, z0, z1), min(0.6, 0.2 * (z1 - z0)), ">Z", chamfer=True)


def bar(ends: list[tuple[float, float]], radius: float, z0: float, z1: float) -> cq.Workplane:
    """Return a bar with round ends and sharp edges between two heights."""
    return extruded(outline.hull([(x, y, radius) for x, y in ends]), z1 - z0, z0)
