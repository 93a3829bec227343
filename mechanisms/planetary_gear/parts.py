"""The planetary's automatic parts, its carrier under the wheels, so that all that meshes is seen."""

from __future__ import annotations

from mechanisms.automatic import automatic
from mechanisms.planetary_gear.mechanism import Params, build
from shared.shapes.solid import Solid


def parts(p: Params) -> dict[str, list[Solid]]:
    """The bottom of a ring that turns is lowest, then come the carrier and the wheels."""
    m = build(p)
    made = automatic(m, solution=m.sweep())
    turning = p.fixed != "ring"
    if turning:
        made.layer("ring", 0)
        made.material("ring", "aluminium_red")
    made.layer("carrier", 1 if turning else 0)
    made.material("carrier", "aluminium_gold")
    for k in range(1, p.planets + 1):
        made.material(f"planet{k}", "aluminium_blue")
    made.material("sun", "aluminium_orange")
    return made.solids()
