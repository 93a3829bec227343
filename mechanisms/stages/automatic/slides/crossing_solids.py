"""The solids of crossing slides (rmm): a plate with grooves on the base, and a tongue under each shuttle."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.slides.crossings import CORE, TONGUE, TONGUE_DEPTH, WALL, Crossing, Ends
from shared.shapes import outline
from shared.shapes.build import eased, extruded

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan


@build.register(Crossing)
def crossed(crossing: Crossing, plan: Plan, heights: Heights) -> None:
    """A cross with a round middle, its grooves cut into it, and the tongues."""
    fit = plan.layout.sizes.pivot.fit
    face = heights.bottom(crossing.blocks[0])
    top, bottom = face - fit.axial, fit.seat
    plate = extruded(outline.circle(*crossing.middle, CORE), top - bottom, bottom)
    for slide in crossing.slides:
        plate = plate.union(_bar(crossing.groove(slide), TONGUE / 2 + WALL, bottom, top))
    plate = eased(plate, 0.8, ">Z", chamfer=True)
    floor = top - TONGUE_DEPTH
    for slide in crossing.slides:
        plate = plate.cut(_bar(crossing.groove(slide), (TONGUE + fit.running) / 2, floor, top + 1.0))
        plan.feet += [Foot("", x, y, TONGUE / 2 + WALL) for x, y in crossing.groove(slide)]
        tongue = _bar(crossing.tongue(slide), TONGUE / 2, floor + fit.axial, face - fit.seat)
        plan.make(slide.block, f"tongue_{slide.name}", eased(tongue, 0.5, "<Z", chamfer=True), "bronze", 0)
    plan.make("ground", f"grooves_{crossing.name}", plate, "aluminium", 0)


def _bar(ends: Ends, radius: float, z0: float, z1: float) -> cq.Workplane:
    (x0, y0), (x1, y1) = ends
    return extruded(outline.hull([(x0, y0, radius), (x1, y1, radius)]), z1 - z0, z0)
