"""Which material each body gets where nobody says: that of the colour of its role (mbsd/drawing/inks.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbsd import Mechanism

ROD = "steel"


def materials(m: Mechanism) -> dict[str, str]:
    """By moving body."""
    from mbsd.drawing.inks import colours_by_role

    return {body: "aluminium" if word == "silver" else f"aluminium_{word}" for body, word in colours_by_role(m).items()}
