"""Cylinders that stand in line, the fins of their liners, and the deck that holds these (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.shafts.passing import Takes, box

if TYPE_CHECKING:
    from mechanisms.stages.automatic.shafts.cylinders import Cylinder

DECK = (0.2, 0.05)
"""Between these distances below the upper end of a liner is the deck that holds it, in bores."""
FIN = 0.14
"""How far fins stand out of a liner, in bores, where there is room."""
BESIDE = 0.12
"""How far a deck reaches beside its liners."""


def fins(all_of: Mapping[str, Cylinder]) -> dict[str, float]:
    """By piston: radius of the fins of its liner, as far as its neighbours leave room."""
    radii = {}
    for name, own in all_of.items():
        radius = own.outer + FIN * own.bore
        for other in all_of.values():
            apart = abs(other.piston.z - own.piston.z)
            if other is own or apart > 2 * radius:
                continue
            cosine = sum(a * b for a, b in zip(own.piston.along, other.piston.along, strict=True))
            between = math.acos(max(-1.0, min(1.0, cosine)))
            room = apart / 2 - 0.01 * own.bore if between < 1e-6 else own.low * math.tan(between / 2)
            radius = min(radius, max(room, own.outer))
        radii[name] = radius
    return radii


def banks(all_of: Mapping[str, Cylinder]) -> list[list[Cylinder]]:
    """Cylinders on the same line of the plane, in the order of their places along z."""
    rows: list[list[Cylinder]] = []
    for own in all_of.values():
        for bank in rows:
            if (
                math.dist(bank[0].piston.along, own.piston.along) < 1e-6
                and math.dist(bank[0].origin, own.origin) < 1e-3
            ):
                bank.append(own)
                break
        else:
            rows.append([own])
    return [sorted(bank, key=lambda cylinder: cylinder.piston.z) for bank in rows]


def deck_corners(bank: Sequence[Cylinder]) -> list[tuple[float, float]]:
    """Corners of its foot on the base plate."""
    first, wide, low, high = bank[0], deck_half(bank), deck_range(bank)[0], deck_range(bank)[1]
    (x, y), (u, v) = first.origin, first.piston.along
    return [(x + s * u - q * v, y + s * v + q * u) for s in (low, high) for q in (-wide, wide)]


def deck_takes(bank: Sequence[Cylinder], low: float) -> Takes:
    """The room of a deck, from the base plate (z = ``low``) up."""
    first, (below, above), last = bank[0], deck_range(bank), bank[-1]
    inside = [own.piston.body for own in bank] + [own.piston.link for own in bank if own.piston.link]
    inside += [own.against[0] for own in bank if own.against is not None]
    shape = box(first.origin, first.piston.along, below, above, deck_half(bank))
    what = f"the deck of '{first.piston.body}'"
    return Takes(what, "ground", shape, low, deck_top(last), frozenset(inside))


def deck_top(last: Cylinder) -> float:
    """Upper end (z) of the deck whose last cylinder this is."""
    return last.piston.z + last.outer + BESIDE * last.bore


def deck_half(bank: Sequence[Cylinder]) -> float:
    """Half of the width of a deck."""
    return max(own.outer + BESIDE * own.bore for own in bank)


def deck_range(bank: Sequence[Cylinder]) -> tuple[float, float]:
    """s of the lower and of the upper face of a deck."""
    return max(own.top - DECK[0] * own.bore for own in bank), min(own.top - DECK[1] * own.bore for own in bank)
