"""Revolute joint with clearance: a journal about marker j moves freely in a bearing until they touch.

The bearing is about marker i.

    e = p_j - p_i,  n = e / |e|             eccentricity;  c = R_b - R_j: radial clearance
    depth  d = |e| - c                      d <= 0: free flight, no force
    normal N = K d^n (1 + D d'), never below 0, on the journal along -n      n: 1.5
           D = A(e_r) / v_0  where a restitution e_r is given;  v_0: d' where this contact began (m/s)
    along  T = -mu g(s) N sign(s),          s = t . e' + R_j omega_rel: sliding speed of the journal, t = n_perp
           g = 0 for |s| <= v_a,  (|s| - v_a) / (v_b - v_a) up to v_b,  then 1

Forces act where the surfaces touch, at p_j + R_j n, so the journal feels the torque R_j T, too. At |e| = 0, where n has
no direction, nothing touches. N never pulls: where a damped contact parts it is 0 before the depth is. A(e_r) is that
of forces/contact.py: 3 (1 - e_r^2) / 4 by Lankarani and Nikravesh. From Young's moduli E and Poisson's ratios

    K = 4 / (3 (s_b + s_j)) sqrt(R_b R_j / (R_b - R_j)),    s = (1 - nu^2) / E

The elastic part has the potential energy K d^(n+1) / (n+1); what damping and friction take is lost. A motion starts
as that of a pin that stands ``start`` away from the bearing's middle: closed, and with the velocities of the ideal
mechanism, which is how published simulations begin.

Sources: Flores, Ambrosio, Claro, Lankarani 2008, Kinematics and Dynamics of Multibody Systems with Imperfect Joints,
ch. 3; Lankarani, Nikravesh 1990, J. Mech. Des. 112, 369; Ambrosio 2003, in Virtual Nonlinear Multibody Systems, p. 57
(friction).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from mbsd.base.arguments import number_pair
from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.entries import above_zero, add_force, amounts_given, exponent_given
from mbsd.model.force import Force, ForceKind, Interaction, Press, register_force
from mbsd.model.forces.contact import loss_of, penalty_potential, restitution_given
from mbsd.model.joint import Joint
from mbsd.model.joints.pairs import REVOLUTE
from mbsd.model.mechanism import Model


def _interactions(force, masses):
    p = force.params
    numbers = [p["radius"] - p["clearance"], *(p[key] for key in ("clearance", "stiffness", "exponent", "damping"))]
    numbers += [p["friction"], *p["slip_speeds"], loss_of(p), p["least_approach"]]
    return (Interaction("clearance", force.i, force.j, numbers, remembers=numbers[8] > 0.0),)


def _pin(force: Force) -> Joint | None:
    """The pin as which it starts; None where bodies start as they are placed."""
    if force.params["start"] is None:
        return None
    x, y = force.params["start"]
    return Joint(REVOLUTE, force.name, _moved(force.i, x, y), force.j)


def _press(force: Force) -> Press | None:
    """How the journal is pressed into the wall at the start."""
    p = force.params
    if p["start"] is None:
        return None
    depth = math.hypot(*p["start"]) - p["clearance"]
    return Press(depth, p["stiffness"] * max(depth, 0.0) ** p["exponent"], p["clearance"])


def _moved(marker: Marker, x: float, y: float) -> Marker:
    """The marker moved in its own axes (m)."""
    c, s = math.cos(marker.angle), math.sin(marker.angle)
    return replace(marker, x=marker.x + c * x - s * y, y=marker.y + s * x + c * y)


CLEARANCE_JOINT = register_force(
    ForceKind(
        "clearance_joint",
        interactions=_interactions,
        journal=lambda force: (force.params["radius"] - force.params["clearance"], force.params["clearance"]),
        depth_potential=penalty_potential,
        ideal=_pin,
        press=_press,
        sign="clearance",
        example=lambda m, i, j: m.clearance_joint(
            "example", i, j, 1e-3, 0.2, stiffness=500.0, damping=0.02, friction=0.4, slip_speeds=(0.1, 1.0), start=None
        ),
    )
)


@CLEARANCE_JOINT.adds
def clearance_joint(
    m: Model,
    name: str,
    bearing: Marker,
    journal: Marker,
    clearance: float,
    radius: float,
    stiffness: float | None = None,
    modulus: float | None = None,
    poisson: float = 0.3,
    journal_modulus: float | None = None,
    journal_poisson: float | None = None,
    exponent: float = 1.5,
    damping: float = 0.0,
    restitution: float | None = None,
    damping_model: str = "lankarani_nikravesh",
    least_approach: float = 1e-3,
    friction: float = 0.0,
    slip_speeds: Sequence[float] = (1e-4, 1e-3),
    start: Sequence[float] | None = (0.0, 0.0),
) -> Force:
    """Add a pin with play: a journal in a bearing of ``radius`` (m), smaller by ``clearance`` (m).

    Where they touch, the normal force is stiffness * depth^exponent * (1 + damping * rate of depth), never pulling.
    ``stiffness`` (N/m^exponent) is given, or follows by Hertz from the ``modulus`` (Pa) and ``poisson`` of the bearing
    and those of the journal, which are the same unless given. ``restitution`` in place of ``damping`` (s/m): what an
    impact gives back (0 .. 1) by a ``damping_model``, as for ``contact``; simulated by "dop853" alone. ``friction``
    acts fully from the second of the ``slip_speeds`` (m/s) on, and not below the first.

    ``start``: where in the bearing's axes the journal's centre is at the start (m); bodies then start moving as if
    this were a pin. None: they start as start_near and start_moving say. A simulation raises SimulationError where it
    would start pressed into the wall ten times harder than by what that pin carries.
    """
    params = above_zero(m, name, clearance=clearance, radius=radius)
    if params["clearance"] >= params["radius"]:
        raise ModelError(
            f"{m.name}: force '{name}': clearance is {clearance:g} m in a bearing of radius {radius:g} m, which leaves "
            "no journal; it must be smaller than the radius. Both are in metres: 0.1 mm is 0.1e-3"
        )
    params |= _elastic_given(m, name, params, stiffness, modulus, poisson, journal_modulus, journal_poisson)
    params |= exponent_given(m, name, exponent) | amounts_given(m, name, damping=damping, friction=friction)
    params |= restitution_given(m, name, damping, restitution, damping_model, least_approach)
    params["slip_speeds"] = _slip_speeds_given(m, name, slip_speeds)
    params["start"] = None if start is None else _start_given(m, name, start, params["radius"])
    return add_force(m, CLEARANCE_JOINT, name, bearing, journal, params)


def _elastic_given(
    m: Model,
    name: str,
    sizes: dict[str, float],
    stiffness: float | None,
    modulus: float | None,
    poisson: float,
    journal_modulus: float | None,
    journal_poisson: float | None,
) -> dict[str, Any]:
    """Params of what the surfaces yield. Raises ModelError."""
    what = f"{m.name}: force '{name}'"
    ratios = {"poisson": poisson, "journal_poisson": poisson if journal_poisson is None else journal_poisson}
    for key, ratio in ratios.items():
        if not 0.0 <= ratio <= 0.5:
            raise ModelError(f"{what}: {key} is {ratio:g}; Poisson's ratio is within 0 .. 0.5")
    if (stiffness is None) == (modulus is None):
        raise ModelError(
            f"{what} has {'neither' if modulus is None else 'both'} stiffness= {'nor' if modulus is None else 'and'} "
            "modulus=; give the stiffness of the contact (N/m^exponent), or Young's modulus (Pa) that it follows from"
        )
    if modulus is None:
        if journal_modulus is not None:
            raise ModelError(f"{what} has journal_modulus= and stiffness=, which says all; leave one of them out")
        return above_zero(m, name, stiffness=stiffness) | {"modulus": None, "journal_modulus": None, **ratios}
    moduli = above_zero(m, name, modulus=modulus, journal_modulus=journal_modulus or modulus)
    yielding = sum((1.0 - nu**2) / e for nu, e in zip(ratios.values(), moduli.values(), strict=True))
    outer, inner = sizes["radius"], sizes["radius"] - sizes["clearance"]
    hertz = 4.0 / (3.0 * yielding) * (outer * inner / sizes["clearance"]) ** 0.5
    return {"stiffness": hertz, **moduli, **ratios}


def _slip_speeds_given(m: Model, name: str, given: Sequence[float]) -> tuple[float, float]:
    what = f"{m.name}: force '{name}': slip_speeds"
    low, high = number_pair(what, given)
    if not 0.0 <= low < high:
        raise ModelError(
            f"{what} are {low:g} and {high:g} m/s; give two speeds, 0 <= first < second: below the first there is no "
            "friction, above the second there is all of it"
        )
    return low, high


def _start_given(m: Model, name: str, given: Sequence[float], radius: float) -> tuple[float, float]:
    what = f"{m.name}: force '{name}': start"
    x, y = number_pair(what, given)
    if x * x + y * y >= radius * radius:
        raise ModelError(f"{what} is ({x:g}, {y:g}) m, beyond the bearing's radius of {radius:g} m")
    return x, y
