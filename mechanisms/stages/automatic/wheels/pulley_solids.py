"""The solids of pulleys (rmm): a disc with a web, and the rim round it, grooved for a round belt or cut for a chain."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.wheels.gear_solids import build_wheel, shape_of, with_hub
from mechanisms.stages.automatic.wheels.pulleys import BELT, Pulley
from shared.shapes.build import extruded, turned
from shared.shapes.involute import wire
from shared.shapes.outline import circle
from shared.shapes.solid import Hold, Solid, placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from shared.shapes.link import Eye

EDGE, FLOOR = 0.7, 1.3
"""What stays beside a groove, and half the width of the groove's floor."""
MARKS, LEAST_MARK, LARGEST_MARK = 3, 1.0, 2.5
"""Small holes between hub and rim, and their radii."""
SPROCKET = 0.45
"""Thickness of a sprocket's teeth as a part of the plate's."""
SEAT = 5
"""Points of a sprocket's seat for a roller."""


@shape_of.register(Pulley)
def pulley_disc(pulley: Pulley, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """From z = 0 up, with its eyes, and its number of through holes. One without windows has small holes, so that one
    sees it turn.
    """
    shape, holes = with_hub(extruded(circle(0, 0, pulley.root), thickness), pulley.root, thickness, eyes)
    room = pulley.root - Sizes.hardware
    if holes > 1 or 0.3 * room < LEAST_MARK or any(math.hypot(x, y) > 0.01 for x, y, _ in eyes):
        return shape, holes
    for k in range(MARKS):
        tool = extruded(circle(pulley.root - 0.5 * room, 0, min(0.3 * room, LARGEST_MARK)), thickness + 2.0, -1.0)
        shape = shape.cut(placed(tool, turn=360.0 * k / MARKS))
    return shape, holes + MARKS


@build.register(Pulley)
def build_pulley(pulley: Pulley, plan: Plan, heights: Heights) -> None:
    """Disc and rim."""
    build_wheel(pulley, plan, heights)
    build_rim(pulley, plan, heights)


def build_rim(pulley: Pulley, plan: Plan, heights: Heights) -> None:
    """The rim about its disc."""
    seat = plan.layout.sizes.pivot.fit.seat
    plan.add(pulley.body, rim_of(pulley, heights.thickness, heights.bottom(pulley.layer), seat))


def rim_of(pulley: Pulley, thickness: float, z: float, seat: float) -> Solid:
    """The rim of a pulley from z up, ``seat`` around its disc."""
    inner = pulley.root + seat
    middle, radius = z + thickness / 2, BELT
    if pulley.teeth:
        height = SPROCKET * thickness
        outline = wire(sprocket_outline(pulley.teeth, pulley.radius, pulley.tooth, pulley.phase or 0.0))
        shape = extruded(outline, height, (thickness - height) / 2, [circle(0, 0, inner)])
        radius = min(pulley.tooth, BELT)
    else:
        floor, lip = pulley.radius - 1.1 * BELT, pulley.lip
        groove = [(lip, thickness - EDGE), (floor, thickness / 2 + FLOOR), (floor, thickness / 2 - FLOOR), (lip, EDGE)]
        shape = turned([(inner, 0.0), (inner, thickness), (lip, thickness), *groove, (lip, 0.0)])
    hold = Hold(pulley.belt, middle, radius)
    material = "steel" if pulley.teeth else "aluminium"
    rim = placed(shape, pulley.x, pulley.y, z)
    return Solid(f"rim_{pulley.name}", rim, material, 1, holds=(hold,))


def sprocket_outline(teeth: int, radius: float, tooth: float, phase: float) -> np.ndarray:
    """(n, 2): round seats for rollers on the pitch circle, the first at the angle ``phase``, and teeth between them."""
    seat, pitch = 0.95 * tooth, 2 * math.pi / teeth
    turn = np.linspace(-100.0, 100.0, SEAT) * math.pi / 180 + math.pi  # about the roller, inner half
    bed = np.stack([radius + seat * np.cos(turn), seat * np.sin(turn)], axis=1)[::-1]
    tip, half = radius + tooth, 0.12 * pitch
    crest = [(tip * math.cos(a), tip * math.sin(a)) for a in (pitch / 2 - half, pitch / 2 + half)]
    span = np.concatenate([bed, crest])
    angles = phase + pitch * np.arange(teeth)
    return np.concatenate([span @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]]) for a in angles])
