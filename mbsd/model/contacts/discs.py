"""Contact of two discs around two markers, beside each other or one inside the other.

g = l - (r_i + r_j)     beside;    g = (r_i - r_j) - l     disc j inside ring i;     constraint `radial`
s = rolling way         constraint `gear` of radii r_i and r_j; see mbsd/equations/relative/gear.py
"""

from __future__ import annotations

from mbsd.model.contacts.kind import ContactKind, register


def _numbers(params):
    first, second, inside = params["radius_i"], params["radius_j"], params["inside"]
    if inside:
        return (-1.0, first - second), (first, -second)
    return (1.0, first + second), (first, second)


DISCS = register(
    ContactKind(
        "rigid_discs",
        ("radial", "gear"),
        example=lambda m, i, j: m.rigid_discs("example", i, j, 0.05, 0.04),
        numbers=_numbers,
        lengths=("radius_i", "radius_j"),
    )
)
