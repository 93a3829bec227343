"""Contact of two discs around two markers, beside each other or one inside the other.

g = l - (r_i + r_j)     beside;    g = (r_i - r_j) - l     disc j inside ring i;     constraint `radial`
s = rolling way         constraint `gear` of radii r_i and r_j; see mbsd/equations/relative/gear.py
"""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.model.adding.contacts import add_contact, amounts_given, frictions_given
from mbsd.model.body import Marker
from mbsd.model.contact import ContactKind, register
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model


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
        touching="discs",
    )
)


@DISCS.adds
def rigid_discs(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius_i: float,
    radius_j: float,
    inside: bool = False,
    restitution: float = 0.0,
    friction: float = 0.0,
    static_friction: float | None = None,
) -> Joint:
    """Keep discs of two radii (m) around two markers apart; ``inside``: j is inside the ring i."""
    params = amounts_given(m, name, radius_i=radius_i, radius_j=radius_j) | {"inside": bool(inside)}
    params |= frictions_given(m, name, friction, static_friction)
    reach = radius_i - radius_j if inside else radius_i + radius_j
    if reach <= 0:
        raise ModelError(
            f"{m.name}: contact '{name}': radii {radius_i:g} m and {radius_j:g} m leave no distance of the "
            "centres; " + ("the ring i must be larger than the disc j" if inside else "one must be positive")
        )
    return add_contact(m, DISCS, name, i, j, restitution, params)
