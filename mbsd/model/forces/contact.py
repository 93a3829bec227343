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

from mbsd.model.forces.kind import ForceKind, Interaction, register
from mbsd.model.laws.curve import Curve, curve

if TYPE_CHECKING:
    from mbsd.model.force import Force

OWN = ("radius", "stiffness", "exponent", "damping", "friction", "slip_speed")


def surface(force: Force) -> list[float]:
    """Numbers of the surface, as mbsd/equations/interactions/surface.py reads them."""
    profile = force.laws.get("profile")
    if not isinstance(profile, Curve):
        return [0.0] * 9
    from mbsd.model.plane_curves import graph_numbers

    return graph_numbers(profile).tolist()


def _interactions(force, masses):
    numbers = surface(force) + [force.params[name] for name in OWN]
    return (Interaction("contact", force.i, force.j, numbers),)


def _depth_potential(force, depth):
    power = force.params["exponent"] + 1.0
    return force.params["stiffness"] * depth**power / power


CONTACT = register(
    ForceKind(
        "contact",
        interactions=_interactions,
        surface=surface,
        depth_potential=_depth_potential,
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
