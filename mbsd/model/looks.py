"""Looks: drawings of joints, drivers, forces and contacts in pictures of solids, beside the parts.

band        a belt or chain round both wheels
roller      a roller about marker j that is pressed on one side: a cam's
captive     a roller or pin about marker j between two walls: of a slot, a curve, a wheel with slots
coil        a coil spring; of what holds no potential energy a cylinder with its rod
cylinder    a cylinder with its rod
spiral      a flat spiral over the pin of both bodies; of what holds no potential energy nothing
cord        a rope
"""

from __future__ import annotations

LOOKS = ("", "band", "roller", "captive", "coil", "cylinder", "spiral", "cord")


def refuse_unknown_look(name: str, look: str) -> None:
    """Raise ValueError, naming the kind ``name``, unless ``look`` is one of :data:`LOOKS`."""
    if look not in LOOKS:
        raise ValueError(f"{name}: look is {look!r}; it must be one of {', '.join(LOOKS[1:])}, or empty")
