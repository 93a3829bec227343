"""The ground under a road that needs no back plate: a slab as long as the road, and so deep that nothing tips (mm)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.standing.dimensions import AROUND, CLEAR, FOOT, FOOT_HEIGHT, foot_spans
from mechanisms.stages.automatic.standing.named import named
from mechanisms.stages.automatic.standing.standing_masses import standing
from shared.shapes.solid import Solid
from shared.shapes.stand import foot

if TYPE_CHECKING:
    import numpy as np

    from mechanisms.stages.automatic.standing.back_plate import Upright

SLAB = "concrete"
"""What it is made of."""


@dataclass(frozen=True)
class GroundSlab:
    """Under all that is on ground; ``poses`` (T, 3) (mm, rad) say how bodies move."""

    upright: Upright
    poses: Mapping[str, np.ndarray]
    unit: float
    seat: float
    tolerance: float | None = None

    def __call__(self, bodies: Mapping[str, Sequence[Solid]]) -> list[Solid]:
        """The solids of ground with the slab, on which its lowest one lies."""
        load = standing(bodies, self.poses, self.upright)
        fixed = standing({"ground": bodies["ground"]}, {}, self.upright)
        over = min(fixed.low[1] - self.seat, load.moving - CLEAR * self.unit)
        deep = max(FOOT * self.unit, FOOT_HEIGHT * float(fixed.high[0] - fixed.low[0]))
        right, _, near = foot_spans(load, over - deep)
        around = AROUND * self.unit
        x = min(right[0], fixed.low[0] - around), max(right[1], fixed.high[0] + around)
        z = min(near[0], fixed.low[2] - around), max(near[1], fixed.high[2] + around)
        slab = foot(x, (over - deep, over), z, min(9.0 * self.unit, 0.3 * (z[1] - z[0])), 1.2 * self.unit)
        made = Solid("ground_slab", self.upright.in_model(slab), SLAB, 0, tolerance=self.tolerance, fitted=True)
        return [*bodies["ground"], *named([made], bodies)]
