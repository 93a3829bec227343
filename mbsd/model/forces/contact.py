"""Contact with a surface by penalty, and tyres on a road.

Contact by penalty: a disc or a point of a body against a wall, a ground line or a terrain profile.

    depth  d = radius - distance of marker j from the surface;   d <= 0: no force
    normal N = k d^n (1 + c d'), never below 0                    k: N/m^n, n: 1.5 Hertz, c: s/m
           c = A(e) / v_0      where a restitution e is given;    v_0: d' where this contact began (m/s)
    along    T = -mu N tanh(s / s_0)                              s: sliding speed of body j at the foot

The surface is the x axis of marker i with matter below it, or a curve y(x) in the axes of marker i; N acts along its
outer normal at the foot of marker j, and body i takes the opposite. Deepest and return speeds of one impact obey

    k d_max^(n+1) / ((n+1) m) = w(v_0) = w(-v_1),   w(v) = v / c - ln(1 + c v) / c^2,   so v_1 / v_0 ~ 1 - 2 c v_0 / 3

    damping_model           A(e)                  with it a body returns with v_1 = e' v_0, where
    "hunt_crossley"         3 (1 - e) / 2         A (1 + e') = ln((1 + A) / (1 - A e')),  whatever k, n, m and v_0 are
    "lankarani_nikravesh"   3 (1 - e^2) / 4       (v_1 follows from w). For e = 0.9 e' is 0.909, 0.913 and 0.894,
    "flores"                8 (1 - e) / (5 e)     for e = 0.5 it is 0.66, 0.73 and 0.47: the first two need e near 1

v_0 counts as ``least_approach`` at least, so that resting does not get infinitely stiff. A contact in which the motion
begins has no v_0 and no damping.

The elastic part has the potential energy k d^(n+1) / (n+1). A disc touches at one point, the nearest of the profile.
T is smooth: within s_0 bodies creep instead of sticking.

Sources: Hunt, Crossley 1975, J. Appl. Mech. 42, 440; Lankarani, Nikravesh 1990, J. Mech. Des. 112, 369; Flores,
Machado, Silva, Martins 2011, Multibody Syst. Dyn. 25, 357.

Tyre: a wheel that carries as a spring and damper and pulls by the magic formula of its slip.

    depth    d = radius - height of the hub over the road;   N = k d + c d' where d > 0, never below 0
    slip     kappa = -(v + omega h) / sqrt(v^2 + v_0^2)      v: speed of the hub along the road, h: its height
    along    T = N D sin(C atan(B kappa - E (B kappa - atan(B kappa))))

T acts on the wheel at the road, forward (along t, the way of x) where the wheel turns faster than it rolls; wheels
that roll along x turn clockwise. v_0 keeps the slip finite at a standstill; there the tyre creeps and does not hold.
The road is the x axis of marker i or a curve y(x) in its axes.

Source: Pacejka, Bakker 1993, Vehicle System Dynamics 21, suppl. 1 (longitudinal slip only).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.body import Marker
from mbsd.model.entries import above_zero, add_force, amounts_given, curves_given, exponent_given
from mbsd.model.force import Force, ForceKind, Interaction, register_force
from mbsd.model.laws.curve import Curve, curve
from mbsd.model.mechanism import Model
from mbsd.model.plane_curves import graph_numbers

if TYPE_CHECKING:
    import numpy as np

DAMPING_MODELS = {
    "hunt_crossley": lambda e: 1.5 * (1.0 - e),
    "lankarani_nikravesh": lambda e: 0.75 * (1.0 - e * e),
    "flores": lambda e: 1.6 * (1.0 - e) / e,
}
"""A(e) by the name of the damping model."""


def loss_of(params: Mapping[str, Any]) -> float:
    """A(e) of a force's params, 0 without a restitution."""
    restitution = params["restitution"]
    return 0.0 if restitution is None else DAMPING_MODELS[params["damping_model"]](restitution)


def restitution_given(
    m: Model, name: str, damping: float, restitution: float | None, damping_model: str, least_approach: float
) -> dict[str, float | str | None]:
    """Params of damping by approach speed. Raises ModelError."""
    what = f"{m.name}: force '{name}'"
    if damping_model not in DAMPING_MODELS:
        raise ModelError(f"{what}: {no_such('damping_model', damping_model, DAMPING_MODELS)}")
    out = above_zero(m, name, least_approach=least_approach)
    if restitution is not None:
        if not 0.0 <= restitution <= 1.0:
            raise ModelError(f"{what}: restitution is {restitution:g}; it must be within 0 .. 1")
        if restitution == 0.0 and damping_model == "flores":
            raise ModelError(
                f"{what}: restitution is 0, for which the damping of 'flores' is infinite; give a little more, or take "
                "damping_model='lankarani_nikravesh'"
            )
        if damping:
            raise ModelError(
                f"{what}: damping is {damping:g} s/m and restitution {restitution:g}; give one of them, as both say "
                "how much an impact loses"
            )
    return {"restitution": restitution, "damping_model": damping_model, **out}


CONTACT_OWN = ("radius", "stiffness", "exponent", "damping", "friction", "slip_speed")


def surface(force: Force) -> list[float]:
    """Numbers of the surface, as mbsd/equations/interactions/law.py reads them."""
    profile = force.laws.get("profile")
    if not isinstance(profile, Curve):
        return [0.0] * 13  # a curve of no pieces
    return graph_numbers(profile).tolist()


def _contact_interactions(force, masses):
    p = force.params
    loss = loss_of(p)
    numbers = surface(force) + [p[name] for name in CONTACT_OWN] + [loss, p["least_approach"]]
    return (Interaction("contact", force.i, force.j, numbers, remembers=loss > 0.0),)


def penalty_potential(force: Force, depth: np.ndarray) -> np.ndarray:
    """Return the potential energy (J) of a contact by penalty at depths (m), of any shape."""
    power = force.params["exponent"] + 1.0
    return force.params["stiffness"] * depth**power / power


CONTACT = register_force(
    ForceKind(
        "contact",
        interactions=_contact_interactions,
        surface=surface,
        depth_potential=penalty_potential,
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


@CONTACT.adds
def contact(
    m: Model,
    name: str,
    surface: Marker,
    body: Marker,
    stiffness: float,
    exponent: float = 1.5,
    damping: float = 0.0,
    friction: float = 0.0,
    radius: float = 0.0,
    profile: Curve | None = None,
    slip_speed: float = 1e-3,
    restitution: float | None = None,
    damping_model: str = "flores",
    least_approach: float = 1e-3,
) -> Force:
    """Contact of a disc of ``radius`` (m; 0: a point) about a marker with a surface, never pulling.

    The surface is the x axis of marker ``surface`` with matter below it (turn the marker for a wall), or a
    ``profile`` y(x) in its axes. Normal force stiffness * depth^exponent * (1 + damping * rate of depth); the
    friction coefficient is reached at some ``slip_speed`` (m/s).

    ``restitution`` in place of ``damping``: each impact loses what this coefficient (0 .. 1) says, by the
    ``damping_model`` "hunt_crossley" or "lankarani_nikravesh" (for little loss), or "flores" (for any but 0), whose
    damping is divided by the speed at which the contact began, ``least_approach`` (m/s) at least. Simulated by
    "dop853" alone.
    """
    params = amounts_given(m, name, stiffness=stiffness, damping=damping, friction=friction, radius=radius)
    params |= exponent_given(m, name, exponent)
    params |= restitution_given(m, name, damping, restitution, damping_model, least_approach)
    params |= above_zero(m, name, slip_speed=slip_speed)
    laws = {} if profile is None else curves_given(m, name, profile=profile)
    return add_force(m, CONTACT, name, surface, body, params, laws)


TYRE_OWN = ("radius", "stiffness", "damping", "grip", "slope", "shape", "curvature", "standstill")


def _tyre_interactions(force, masses):
    numbers = surface(force) + [force.params[name] for name in TYRE_OWN]
    return (Interaction("tyre", force.i, force.j, numbers),)


TYRE = register_force(
    ForceKind(
        "tyre",
        interactions=_tyre_interactions,
        surface=surface,
        depth_potential=lambda force, depth: 0.5 * force.params["stiffness"] * depth**2,
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
    params |= above_zero(m, name, radius=radius, standstill=standstill) | {"curvature": curvature}
    laws = {} if profile is None else curves_given(m, name, profile=profile)
    return add_force(m, TYRE, name, road, hub, params, laws)
