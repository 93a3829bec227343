"""A layout with its features: those of joints and forces, then what free bodies, weights and traced points show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.gathered import gathered
from mechanisms.stages.automatic.layout.layout import Layout
from mechanisms.stages.automatic.pins.free.free_bodies import free_bodies
from mechanisms.stages.automatic.pins.free.points import styluses, weights
from mechanisms.stages.automatic.pins.rods import add_poses
from mechanisms.stages.automatic.wheels.sharing import with_own_layers

if TYPE_CHECKING:
    from mechanisms.stages.automatic.assembly.joined import Joined


def laid_out(layout: Layout, joined: Sequence[Joined], tubes: bool, tall: bool, pointers: bool) -> Layout:
    """The layout with all that takes room in it. Raises UserError for what has no part.

    ``joined``: pieces that the author added; ``tubes``: wheels stand on tubes; ``tall``: with styluses that stand up,
    not flush ones; ``pointers``: with those of points on rims.
    """
    add_poses(layout)
    layout.features = gathered(layout)
    layout.features += free_bodies(layout)
    layout.features += weights(layout, heavy=True)
    layout.features += styluses(layout, tall, pointers)
    layout.features += weights(layout, heavy=False)
    layout.features += joined
    return with_own_layers(layout, tubes)
