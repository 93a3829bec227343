"""Solid of a mechanism: its shape, its material, and how many holes go through it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cadquery as cq


@dataclass(frozen=True)
class Hold:
    """End of a spring, or pulley of a belt: the place where the film draws it (mm)."""

    force: str
    """Its name in mechanism.py."""
    z: float
    """Height of its axis."""
    radius: float
    """Radius of its coil's middle line; a cylinder is somewhat thinner."""


@dataclass(frozen=True)
class Roll:
    """Roller about (x, y) of its body's frame (mm) that rolls in a joint."""

    joint: str
    """Its name in mechanism.py."""
    x: float
    y: float
    radius: float
    marks: int
    """It looks the same after a turn by one of so many."""


@dataclass(frozen=True)
class Solid:
    """One piece of a body.

    ``shape`` is in millimetres, in the frame of the body it moves with, at its height in the assembly (z = 0 is
    the top of the base plate). ``material`` is a key of ``MATERIALS`` (shared/contract/materials.py). ``through_holes``
    is the number of holes that go right through: the Euler number of the closed surface is 2 - 2 * through_holes.
    ``holds`` says which springs are fixed to it, so that the film adds no pins of its own. ``buy`` says what to ask for
    in a shop where the piece has a standard's sizes, such as "circlip 8x0.8 DIN 471"; a piece without it is to be made.
    ``rolls`` says how it turns in the film. ``tolerance`` is the largest distance (mm) of its mesh from the true
    surface; None is that of usual parts, which is fine for large ones. ``dressing`` shows what the machine works on
    (Bodies.dress): it is made, proven and filmed as all else, but is none of the mass of its body. ``fitted`` pieces
    have sizes that were chosen for the scale at which they are made; all others are made smaller as they are.
    """

    name: str
    shape: cq.Workplane
    material: str
    through_holes: int
    holds: tuple[Hold, ...] = ()
    buy: str = ""
    rolls: Roll | None = None
    tolerance: float | None = None
    dressing: bool = False
    fitted: bool = False


def at_scale(solid: Solid, ratio: float) -> Solid:
    """Return the piece of a model, ``ratio`` times as large.

    Bought pieces of the machine do not fit the model, unless the piece is ``fitted``.
    """
    shape = solid.shape.newObject([own.scale(ratio) for own in solid.shape.solids().vals()])
    holds = tuple(replace(hold, z=hold.z * ratio, radius=hold.radius * ratio) for hold in solid.holds)
    roll = solid.rolls
    if roll is not None:
        roll = replace(roll, x=roll.x * ratio, y=roll.y * ratio, radius=roll.radius * ratio)
    made = replace(solid, shape=shape, holds=holds, rolls=roll)
    if solid.fitted:
        return made
    return replace(made, buy="", tolerance=solid.tolerance and solid.tolerance * ratio)


def placed(shape: cq.Workplane, x: float = 0.0, y: float = 0.0, z: float = 0.0, turn: float = 0.0) -> cq.Workplane:
    """Return ``shape`` turned about its axis by ``turn`` degrees and moved to (x, y, z) in mm."""
    return shape.rotate((0, 0, 0), (0, 0, 1), turn).translate((x, y, z))
