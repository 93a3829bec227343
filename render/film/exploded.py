"""How a machine comes apart: which piece is lifted along which axis, in which order, how far; from parts.json alone.

Pieces of a planar machine are put together along the normal of its plane, the lowest first. A piece belongs to the
layer of its middle: a pin between two links is put into the lower one before the upper one is put on it.
"""

from __future__ import annotations

from typing import NamedTuple

from shared.contract import Parts
from shared.contract.mount import Vector, Z

SAME = 0.03
"""Pieces whose middles are nearer than this part of the height of the stack are of one layer."""
STEP = 0.085
"""From one layer to the next, as a part of the machine's size, ..."""
MOST = 0.6
"""... and all of them together."""


class Lift(NamedTuple):
    """One piece of an exploded machine."""

    body: str
    piece: str
    order: int
    """When it is put together, from 0 on; pieces of one layer have the same."""
    axis: Vector
    """Unit vector of the frame of ground along which it is lifted."""
    distance: float
    """m"""

    @property
    def name(self) -> str:
        """``body/piece``."""
        return f"{self.body}/{self.piece}"


def exploded(parts: Parts, size: float) -> list[Lift]:
    """All pieces in the order in which they are put together; ``size`` (m) is that of the machine.

    What is lowest stays where it is. A machine of a single layer comes apart nowhere: all its distances are 0.
    """
    middles = sorted(
        (sum(piece.z_range) / 2, body, name)
        for body, solids in parts.bodies.items()
        for name, piece in solids.pieces.items()
    )
    if not middles:
        return []
    apart, layers, last = SAME * (middles[-1][0] - middles[0][0]), [], -1e300
    for middle, _, _ in middles:
        layers.append((layers[-1] if layers else 0) + (bool(layers) and middle - last > apart))
        last = middle
    step = size * min(STEP, MOST / max(layers[-1], 1))
    return [Lift(body, name, layer, Z, step * layer) for layer, (_, body, name) in zip(layers, middles, strict=True)]
