"""A solid of a mechanism: its shape, what it is made of, and how many holes go through it."""

from __future__ import annotations

from dataclasses import dataclass

import cadquery as cq


@dataclass(frozen=True)
class Solid:
    """One piece of a body.

    ``shape`` is in millimetres, in the frame of the body it moves with, at its height in the assembly (z = 0 is
    the top of the base plate). ``material`` is a key of ``shared.materials.MATERIALS``. ``through_holes`` is the
    number of holes that go right through: the Euler number of the closed surface is 2 - 2 * through_holes.
    """

    name: str
    shape: cq.Workplane
    material: str
    through_holes: int


def placed(shape: cq.Workplane, x: float = 0.0, y: float = 0.0, z: float = 0.0, turn: float = 0.0) -> cq.Workplane:
    """``shape`` turned about its axis by ``turn`` degrees and moved to (x, y, z) in mm."""
    return shape.rotate((0, 0, 0), (0, 0, 1), turn).translate((x, y, z))
