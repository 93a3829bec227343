"""Names that no other solid has; some disks take upper and lower case for one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from shared.shapes.solid import Solid


def named(made: Sequence[Solid], bodies: Mapping[str, Sequence[Solid]]) -> list[Solid]:
    """What is made, numbered where ``bodies`` have the name."""
    taken = {solid.name.lower() for solids in bodies.values() for solid in solids}
    renamed: list[Solid] = []
    for solid in made:
        name, number = solid.name, 1
        while name.lower() in taken:
            number += 1
            name = f"{solid.name}_{number}"
        taken.add(name.lower())
        renamed.append(replace(solid, name=name))
    return renamed
