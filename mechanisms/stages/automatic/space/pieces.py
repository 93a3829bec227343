"""Pieces in space before they are solids: ends of bodies, stands on ground, links of joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.space import round as shapes
from mechanisms.stages.automatic.space.moves import Array, Sizes

Line = tuple[Array, Array, float]
"""Two places and a radius (mm): a round part, for looking whether it meets others."""
Part = tuple[str, cq.Workplane, str, int]
"""Name, shape, material and through holes of a piece besides the main one."""


@dataclass
class End:
    """End of a body at a joint, in the body's frame (mm)."""

    joint: str
    node: Array
    """Where the body's rods arrive."""
    adds: list[cq.Shape] = field(default_factory=list)
    cuts: list[cq.Shape] = field(default_factory=list)
    holes: int = 0
    parts: list[Part] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)
    bush: Array | None = None
    """Axis of a bush, out of which a shaft comes at both sides."""


@dataclass(eq=False)
class Stand:
    """Part that a joint asks of ground: one whose middle a post must hold."""

    joint: str
    place: Array
    axis: Array
    shape: Callable[[Array], tuple[cq.Workplane, int]]
    """Function of the direction to the post: the part, and its through holes."""
    reach: float
    """Radius of the part about its place."""
    material: str = "aluminium"
    ends: tuple[Array, ...] = ()
    """Places where posts arrive, if not at ``place``."""
    bore: float = 0.0
    """Radius of the bore (mm) out of which a shaft comes at both sides along the axis; 0 without."""


@dataclass
class Link:
    """The massless link of a joint: its main piece first, in its frame (mm)."""

    joint: str
    parts: list[Part]
    lines: list[Line]
    body: str = "ground"
    """Body to which its z axis is nearly fixed; its x axis goes from the first to the second place of the joint."""
    z: Array = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    """Direction of this axis in the body's frame."""


def gather_blocks(stands: list[Stand], sliding: set[str], sizes: Sizes) -> list[Stand]:
    """Return stands with one block for three bores or more side by side, as in a pump.

    ``sliding`` names the joints that are slides.
    """
    out = list(stands)
    for first in stands:
        own = [
            stand for stand in out
            if {first.joint, stand.joint} <= sliding and stand.bore and first.bore
            and abs(stand.axis @ first.axis) > 1 - 1e-9
            and abs((stand.place - first.place) @ first.axis) < sizes.rod
        ]  # fmt: skip
        if len(own) >= 3 and first in own:
            out = [stand for stand in out if stand not in own] + [_common_block(own, sizes)]
    return out


def _common_block(own: list[Stand], sizes: Sizes) -> Stand:
    middle, axis = np.mean([stand.place for stand in own], axis=0), own[0].axis
    radius = max(float(np.linalg.norm(stand.place - middle)) + stand.reach for stand in own)

    def shape(way: Array) -> tuple[cq.Workplane, int]:
        bores = [shapes.disc(stand.place, axis, stand.bore, sizes.block + sizes.rod) for stand in own]
        return shapes.fused([shapes.disc(middle, axis, radius, sizes.block)], bores), len(own)

    return Stand(f"{own[0].joint}_block", middle, axis, shape, radius, bore=own[0].bore)
