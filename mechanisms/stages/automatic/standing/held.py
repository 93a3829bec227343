"""Which stand a machine gets, by its mount."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.standing.back_plate import BackPlate, Upright
from mechanisms.stages.automatic.standing.ground_slab import GroundSlab
from mechanisms.stages.automatic.standing.stand import ENGINE, LINKAGE, Stand

if TYPE_CHECKING:
    import numpy as np

    from mechanisms.stages.automatic.layout.sizes import Sizes
    from shared.contract import Mount
    from shared.shapes.bodies import Bodies


def hold(made: Bodies, mount: Mount, plate: BackPlate | None, poses: Mapping[str, np.ndarray], sizes: Sizes) -> None:
    """Note how parts stand, and what makes the stand of their back ``plate`` (mm), or of ground without one, over
    ``poses`` (T, 3) (mm, rad); nothing does where they lie or hang at a wall.
    """
    made.mount, upright = (mount.kind, mount.up), Upright.of(mount)
    if mount.kind not in ("stand", "ground"):
        return
    if plate is None:
        seat = sizes.pivot.fit.seat * sizes.scale
        made.stand = GroundSlab(upright, poses, sizes.scale, seat, sizes.tolerance)
    else:
        look = ENGINE if made.along else LINKAGE
        made.stand = Stand(plate, upright, poses, look, sizes.tolerance, sizes.ratio)
