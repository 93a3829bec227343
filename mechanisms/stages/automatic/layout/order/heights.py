"""From layers to heights: every gap as high as what is in it needs, and no higher."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from mechanisms.stages.automatic.layout.items import Levels, Need

ROOF = 12.0
"""From the highest layer to bridges above it (rmm): room for heads of pins, weights and the like."""


@dataclass(frozen=True)
class Heights:
    """Heights above the base plate (rmm)."""

    levels: Levels
    thickness: float
    bottoms: tuple[float, ...]
    """Underside of each layer."""

    @property
    def roof(self) -> float:
        """Underside of bridges."""
        return self.bottoms[-1] + self.thickness + ROOF

    def bottom(self, body: str) -> float:
        """Underside of a body's plate."""
        return self.bottoms[self.levels[body]]

    def top(self, body: str) -> float:
        """Upper face of a body's plate."""
        return self.bottom(body) + self.thickness

    def gap_above(self, body: str) -> float:
        """Height free above a body's plate, below the next layer; infinite above the highest."""
        level = self.levels[body]
        return self.bottoms[level + 1] - self.top(body) if level + 1 < len(self.bottoms) else float("inf")


def heights(
    levels: Mapping[str, int], bodies: Iterable[str], thickness: float, needs: Iterable[Need], least: float
) -> Heights:
    """Stack the layers; ``least`` is the smallest gap (rmm)."""
    count = max((levels[body] for body in bodies), default=0) + 1
    gaps = dict.fromkeys(range(-1, count - 1), least)
    for need in needs:
        if need.gap in gaps:
            gaps[need.gap] = max(gaps[need.gap], need.height)
    z, bottoms = 0.0, []
    for level in range(count):
        z += gaps[level - 1]
        bottoms.append(z)
        z += thickness
    return Heights(levels, thickness, tuple(bottoms))
