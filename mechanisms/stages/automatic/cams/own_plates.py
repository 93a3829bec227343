"""Bodies whose plate is a wheel or a cam: what such joints have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.joint import Joint


def refuse_ground(m: Mechanism, joint: Joint, *bodies: str) -> None:
    """Raise UserError if one of ``bodies`` is ground, which has no plate in a layer."""
    if "ground" in bodies:
        raise UserError(
            f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')} with a part on ground, which has "
            f"no automatic parts yet; let a body that is fixed (weld) carry it, or write {shown_file(m.name, 'parts')}"
        )
