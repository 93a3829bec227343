"""Names in wishes for parts: bodies and materials that there are."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.extents import rods_of
from shared.contract.materials import MATERIALS
from shared.stage.errors import UserError
from shared.stage.suggestions import did_you_mean

if TYPE_CHECKING:
    from mbsd import Mechanism


def refuse_unknown(m: Mechanism, body: str, left_out: Collection[str], ground: bool = False) -> None:
    """Raise UserError unless ``body`` is one that moves, a rod (or ground, where that may be) and is not left out."""
    if body in left_out:
        raise UserError(f"{m.name}: '{body}' is left out, so there is nothing of it to shape")
    names = [*(name for name in m.bodies if ground or name != "ground"), *rods_of(m)]
    if body not in names:
        raise UserError(
            f"{m.name}: there is no body '{body}' to shape; there is: {', '.join(names)}{did_you_mean(body, names)}"
        )


def refuse_material(m: Mechanism, body: str, material: str) -> None:
    """Raise UserError unless ``material`` is one that there is."""
    if material not in MATERIALS:
        raise UserError(
            f"{m.name}: material of '{body}': there is no '{material}'; there is {', '.join(MATERIALS)}"
            f"{did_you_mean(material, MATERIALS)}"
        )
