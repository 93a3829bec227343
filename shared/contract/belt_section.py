"""Thickness of a belt or chain in the film and in the clearance proof, from its rim's radius.

A round belt carries marks that stand out a little. A chain has rollers on pins between two rows of plates.
"""

from __future__ import annotations

LONG, PROUD = 1.6, 1.06
"""Half of a mark's length, and its radius."""
ROLLER, BOLT = 0.9, 0.35
"""Radii of a chain's roller and of its pin."""
PLATES, PIN, PLATE = 1.5, 2.1, 0.42
"""How far a chain's plates lie from the middle, half a pin's length, a plate's radius."""
APART = 1.1
"""How far the strands of a crossed belt pass over and under each other."""


def half_width(radius: float, chain: bool) -> float:
    """Return the extent from the middle line out, in the plane."""
    return radius * (ROLLER if chain else PROUD)


def half_height(radius: float, chain: bool, crossed: bool) -> float:
    """Return the extent from the middle line up."""
    return radius * ((PIN if chain else PROUD) + (APART if crossed else 0.0))
