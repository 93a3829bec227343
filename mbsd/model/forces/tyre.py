"""Tyre: a wheel that carries as a spring and damper and pulls by the magic formula of its slip.

    depth    d = radius - height of the hub over the road;   N = k d + c d' where d > 0, never below 0
    slip     kappa = -(v + omega h) / sqrt(v^2 + v_0^2)      v: speed of the hub along the road, h: its height
    along    T = N D sin(C atan(B kappa - E (B kappa - atan(B kappa))))

T acts on the wheel at the road, forward (along t, the way of x) where the wheel turns faster than it rolls; wheels
that roll along x turn clockwise. v_0 keeps the slip finite at a standstill; there the tyre creeps and does not hold.
The road is the x axis of marker i or a curve y(x) in its axes.

Source: Pacejka, Bakker 1993, Vehicle System Dynamics 21, suppl. 1 (longitudinal slip only).
"""

from __future__ import annotations

from mbsd.model.adding.forces import (
    above_zero,
    add_force,
    amounts_given,
    curves_given,
)
from mbsd.model.body import Marker
from mbsd.model.force import Force, ForceKind, Interaction, register
from mbsd.model.forces.contact import surface
from mbsd.model.laws.curve import Curve
from mbsd.model.mechanism import Model, number_given

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


@TYRE.adds
def tyre(
    m: Model,
    name: str,
    road: Marker,
    hub: Marker,
    radius: float,
    stiffness: float,
    damping: float = 0.0,
    grip: float = 1.0,
    slope: float = 10.0,
    shape: float = 1.65,
    curvature: float = 0.97,
    standstill: float = 0.1,
    profile: Curve | None = None,
) -> Force:
    """Add a wheel of ``radius`` (m) about ``hub`` on a road: a marker's x axis, or a profile y(x) there.

    ``stiffness`` (N/m) and ``damping`` (N s/m) carry; ``grip`` D, ``slope`` B, ``shape`` C and ``curvature`` E of
    the magic formula pull by longitudinal slip, which is kept finite below ``standstill`` (m/s).
    """
    params = amounts_given(m, name, stiffness=stiffness, damping=damping, grip=grip, slope=slope, shape=shape)
    params["radius"] = above_zero(m, name, "radius", radius)
    params["standstill"] = above_zero(m, name, "standstill", standstill)
    params["curvature"] = number_given(m, f"force '{name}': curvature", curvature)
    laws = {} if profile is None else curves_given(m, name, profile=profile)
    return add_force(m, TYRE, name, road, hub, params, laws)
