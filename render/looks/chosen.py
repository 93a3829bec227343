"""The look of a machine whose shot.py names none, by what its files say of it."""

from __future__ import annotations

from dataclasses import dataclass

from render.looks.look import Look
from render.looks.looks import LOOKS
from shared.contract import Motion
from shared.contract.mount import Kind, Mount
from shared.contract.shot import Shot

LARGE = 0.8
"""Size (m) from which a machine is too large for a bench."""


@dataclass(frozen=True)
class Family:
    """What decides: how a machine stands, whether gas or a motor moves it, the diagonal of what it sweeps (m)."""

    mount: Kind
    engine: bool
    driven: bool
    size: float

    @classmethod
    def of(cls, motion: Motion, mount: Mount, size: float) -> Family:
        """The family of a machine with these files."""
        engine = any(force.gas is not None for force in motion.forces.values())
        return cls(mount.kind, engine, bool(motion.drivers), size)


def chosen(family: Family) -> str:
    """Vehicles are on a road, engines in the dark studio, what is left to itself before white; what is driven stands
    on a bench, or in daylight where it is too large for one or hangs at a wall, and in the studio where it lies.
    """
    if family.mount == "ground":
        return "road"
    if family.engine:
        return "studio"
    if not family.driven:
        return "cyclorama"
    if family.mount == "wall" or family.size > LARGE:
        return "daylight"
    return "studio" if family.mount == "desk" else "bench"


def look_of(shot: Shot, motion: Motion, mount: Mount, size: float) -> Look:
    """The look that a shot names, else the one chosen."""
    return LOOKS[shot.look or chosen(Family.of(motion, mount, size))]
