"""Contact by penalty: a disc or a point of a body against a wall, a ground line or a terrain profile.

    depth  d = radius - distance of marker j from the surface;   d <= 0: no force
    normal N = k d^n (1 + c d'), never below 0                    k: N/m^n, n: 1.5 Hertz, c: s/m
    along    T = -mu N tanh(s / s_0)                              s: sliding speed of body j at the foot

The surface is the x axis of marker i with matter below it, or a curve y(x) in the axes of marker i; N acts along its
outer normal at the foot of marker j, and body i takes the opposite. Deepest and return speeds of one impact obey

    k d_max^(n+1) / ((n+1) m) = w(v_0) = w(-v_1),   w(v) = v / c - ln(1 + c v) / c^2,   so v_1 / v_0 ~ 1 - 2 c v_0 / 3

The elastic part has the potential energy k d^(n+1) / (n+1). A disc touches at one point, the nearest of the profile.
T is smooth: within s_0 bodies creep instead of sticking.

Source: Hunt, Crossley 1975, J. Appl. Mech. 42, 440.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mbsd.curves import Curve, curve
from mbsd.forces.kind import Foot, ForceKind, Interaction, register

if TYPE_CHECKING:
    import numpy as np

    from mbsd.force import Force
    from mbsd.packing import Packed

OWN = ("radius", "stiffness", "exponent", "damping", "friction", "slip_speed")


def surface(force: Force) -> list[float]:
    """Numbers of the surface, as interactions/surface.py reads them."""
    profile = force.laws.get("profile")
    if not isinstance(profile, Curve):
        return [0.0] * 9
    from mbsd.curve_numbers import graph_numbers

    return graph_numbers(profile).tolist()


def _interactions(force, packed):
    numbers = surface(force) + [force.params[name] for name in OWN]
    return (Interaction("contact", force.i, force.j, numbers),)


def foot(force: Force, packed: Packed, q: np.ndarray) -> Foot:
    """Where the disc stands to the surface along poses q (T, 3 nb)."""
    import numpy as np

    from mbsd.interactions.law import OWN as BEFORE
    from mbsd.interactions.law import STATE
    from mbsd.interactions.surface import tabulate_stand
    from mbsd.potential import relative_place
    from mbsd.reactions import marker_axes, marker_places

    i, j = packed.force_markers[packed.forces.index(force)]
    numbers, found = np.array([0.0] * BEFORE + surface(force)), np.zeros((len(q), 3))
    tabulate_stand(numbers, *relative_place(packed, force, q), np.zeros(STATE), found)
    distance, tx, ty = found.T[:, :, None]
    normal = -ty * marker_axes(packed, q, i) + tx * marker_axes(packed, q, i, turned=True)
    place = marker_places(packed, q, j) - distance * normal
    return Foot(distance[:, 0] - force.params["radius"], place, normal)


def depths(force: Force, packed: Packed, q: np.ndarray) -> np.ndarray:
    """(T,) depth (m) of the disc in the surface, 0 where they do not touch, along poses q (T, 3 nb)."""
    return (-foot(force, packed, q).gap).clip(min=0.0)


def _potential(force, packed, q):
    power = force.params["exponent"] + 1.0
    return force.params["stiffness"] * depths(force, packed, q) ** power / power


CONTACT = register(
    ForceKind(
        "contact",
        interactions=_interactions,
        potential=_potential,
        surface=foot,
        example=lambda m, i, j: m.contact(
            "example",
            i,
            j,
            500.0,
            damping=0.02,
            friction=0.4,
            radius=4.0,
            profile=curve([-4.0, -1.0, 1.0, 4.0], [0.2, -0.1, 0.3, 0.0]),
            slip_speed=0.5,
        ),
    )
)
"""A disc so large that it touches wherever the test puts it."""
