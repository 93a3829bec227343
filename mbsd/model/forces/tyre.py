"""Tyre: a wheel on a road that carries like a spring and damper and pulls by the magic formula of its slip.

    depth    d = radius - height of the hub over the road;   N = k d + c d' where d > 0, never below 0
    slip     kappa = -(v + omega h) / sqrt(v^2 + v_0^2)      v: speed of the hub along the road, h: its height
    along    T = N D sin(C atan(B kappa - E (B kappa - atan(B kappa))))

T acts on the wheel at the road, forward (along t, the way of x) where the wheel turns faster than it rolls; wheels
that roll along x turn clockwise. v_0 keeps the slip finite at a standstill; there the tyre creeps and does not hold.
The road is the x axis of marker i or a curve y(x) in its axes.

Source: Pacejka, Bakker 1993, Vehicle System Dynamics 21, suppl. 1 (longitudinal slip only).
"""

from __future__ import annotations

from mbsd.model.forces.contact import surface
from mbsd.model.forces.kind import ForceKind, Interaction, register

OWN = ("radius", "stiffness", "damping", "grip", "slope", "shape", "curvature", "standstill")


def _interactions(force, masses):
    numbers = surface(force) + [force.params[name] for name in OWN]
    return (Interaction("tyre", force.i, force.j, numbers),)


def _depth_potential(force, depth):
    return 0.5 * force.params["stiffness"] * depth**2


TYRE = register(
    ForceKind(
        "tyre",
        interactions=_interactions,
        surface=surface,
        depth_potential=_depth_potential,
        example=lambda m, i, j: m.tyre("example", i, j, 4.0, 300.0, damping=3.0, grip=0.9, standstill=0.3),
    )
)
