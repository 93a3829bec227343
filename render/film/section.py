"""A section: what lies above a height over the plane of the motion is cut away.

Bodies of a planar machine turn about the normal of its plane alone, so a plane across that normal cuts each of them in
the same way at every moment: solids are cut once, and the film moves what is left.
"""

from __future__ import annotations

from shared.contract import Parts
from shared.stage.errors import UserError


def cut_height(parts: Parts, cut: float) -> float | None:
    """The height (m) above which all is away, where the part ``cut`` of the machine's depth is; None where it is 0.

    Raises UserError for a section that cuts no piece open.
    """
    if cut == 0:
        return None
    ranges = [piece.z_range for solids in parts.bodies.values() for piece in solids.pieces.values()]
    low, high = min(bottom for bottom, _ in ranges), max(top for _, top in ranges)
    height = high - cut * (high - low)
    if not any(bottom < height < top for bottom, top in ranges):
        solid = sorted({round((high - (bottom + top) / 2) / (high - low), 2) for bottom, top in ranges})
        raise UserError(
            f"{parts.mechanism}: shot.section = {cut:g} cuts no piece open; the middles of its pieces are at "
            f"{', '.join(f'{part:g}' for part in solid[:12])}"
        )
    return height
