"""A bench vice: cast body and sliding jaw, steel cheeks, a screw with its bar."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from render.blender.scene.world.painted_light import Lamp, Shine, painted
from render.blender.scene.world.shapes import Thing

ENAMEL, STEEL = (0.030, 0.073, 0.064), (0.10, 0.102, 0.106)
AROUND = 0.04
"""Light that comes from no lamp."""


def build(thing: Thing, lamps: Sequence[Lamp], scale: float = 1.0) -> None:
    """On the floor at the origin of ``thing``, its screw towards -y; about 0.5 wide and 0.45 high at scale 1.

    ``lamps`` are in the axes of ``thing``; their light is painted on it (painted_light.py).
    """
    middle = (0.0, 0.0, 0.25 * scale * thing.radius)
    enamel = painted("enamel", ENAMEL, lamps, middle, AROUND, Shine(0.9, 20.0))
    steel = painted("cheek", STEEL, lamps, middle, AROUND, Shine(5.0, 9.0))

    def box(low: Any, high: Any, paint: Any, bevel: float) -> None:
        thing.box(tuple(scale * c for c in low), tuple(scale * c for c in high), paint, scale * bevel)

    def rod(start: Any, end: Any, widths: list[tuple[float, float]], paint: Any) -> None:
        turned = [(part, scale * r) for part, r in widths]
        thing.rod(tuple(scale * c for c in start), tuple(scale * c for c in end), turned, paint)

    rod((0, 0.06, 0.0), (0, 0.06, 0.09), [(0, 0.21), (0.6, 0.21), (0.75, 0.19), (1, 0.15)], enamel)
    for x, y in ((-0.165, 0.06), (0.165, 0.06)):
        rod((x, y, 0.05), (x, y, 0.085), [(0, 0.026), (0.9, 0.026), (1, 0.02)], steel)
    box((-0.105, -0.06, 0.085), (0.105, 0.25, 0.24), enamel, 0.03)
    box((-0.18, 0.05, 0.20), (0.18, 0.17, 0.40), enamel, 0.022)
    box((-0.17, 0.012, 0.315), (0.17, 0.052, 0.405), steel, 0.004)
    box((-0.075, -0.34, 0.10), (0.075, 0.0, 0.215), enamel, 0.02)
    box((-0.18, -0.19, 0.19), (0.18, -0.085, 0.40), enamel, 0.022)
    box((-0.17, -0.086, 0.315), (0.17, -0.048, 0.405), steel, 0.004)
    rod(
        (0, -0.33, 0.155),
        (0, -0.43, 0.155),
        [(0, 0.058), (0.3, 0.058), (0.35, 0.045), (0.92, 0.045), (1, 0.036)],
        steel,
    )
    rod((-0.20, -0.40, 0.235), (0.17, -0.40, 0.07), [(0, 0.016), (1, 0.016)], steel)
    for place, other in (((-0.20, -0.40, 0.235), (-0.225, -0.40, 0.246)), ((0.17, -0.40, 0.07), (0.195, -0.40, 0.059))):
        rod(place, other, [(0, 0.02), (0.2, 0.03), (0.8, 0.03), (1, 0.02)], steel)
