"""The solids of a slide (rmm): rail, gibs, and what carries the rail or the block on ground."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.slides.slides import BEAM, GIB, RAIL, RAIL_HEIGHT, STOP, Slide
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

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
    if heights.levels[slide.rail] < heights.levels[slide.block]:
        z0, z1 = heights.top(slide.rail) + fit.seat, heights.bottom(slide.block) - fit.axial
        face = heights.bottom(slide.block) - fit.seat
        gibs = face - DEPTH, face
    else:
        z0, z1 = heights.top(slide.block) + fit.axial, heights.bottom(slide.rail) - fit.seat
        face = heights.top(slide.block) + fit.seat
        gibs = face, face + DEPTH
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
    """A bar with round ends and eased edges between two heights."""
    (x0, y0), (x1, y1) = ends
    shape = extruded(outline.hull([(x0, y0, radius), (x1, y1, radius)]), z1 - z0, z0)
    return eased(shape, min(0.6, 0.2 * (z1 - z0)), ">Z", chamfer=True)
