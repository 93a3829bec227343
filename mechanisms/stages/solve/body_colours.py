"""The one table of body colours: by the material of each body's main piece, or by its role where there are no parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared.contract.materials import MATERIALS

if TYPE_CHECKING:
    from mbsd import Mechanism
    from shared.contract import BodyParts, Parts


def body_colours(m: Mechanism, parts: Parts | None) -> dict[str, str]:
    """The ink (``#rrggbb``, on light paper) of each moving body; bodies of one material have shades that differ."""
    from mbsd.drawing.inks import INKS, apart, colours_by_role

    inks = {body: INKS[word] for body, word in colours_by_role(m).items()}
    if parts is not None:
        inks |= {body: MATERIALS[main_material(parts.bodies[body])].ink for body in inks if body in parts.bodies}
    return apart(inks)


def main_material(body: BodyParts) -> str:
    """Material of the piece with the largest volume."""
    return max(body.pieces.values(), key=lambda piece: piece.mass.volume).material
