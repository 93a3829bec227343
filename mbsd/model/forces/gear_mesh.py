"""Gear mesh: two involute gears with centres at markers i and j, whose teeth have backlash and yield.

    S   = b_i (theta_i - phi) + s b_j (theta_j - phi) - c       b = r cos(alpha): base radii;  s = 1, in a ring -1
    g   = (b_i + s b_j) (inv a - inv alpha),  cos a = (b_i + s b_j) / distance of the centres,  inv a = tan a - a
    p+- = +-S - s g - j cos(alpha) / 2                          depth of either flank along its line of action
    F   = k p^n (1 + D p') where p > 0, never below 0           D: s/m, or by a restitution as in forces/contact.py

phi is the direction of the line of centres, j the backlash on the pitch circles. F acts along the line of action, a
tangent of both base circles that goes through the pitch point: torques are b F, and gears are pushed apart, a gear
towards its ring, by F sin a. What the centres stand away from r_i + s r_j changes the pressure angle a and the play,
which centres that part by D widen by 2 D tan a about. Both flanks may touch where centres are too near.

c is such that the start pose is the middle of the play, or ``start`` away from it on the pitch circle, or the poses of
``phase`` are. Teeth repeat after a pitch, pi module cos(alpha) along the line of action; gears by radii count as having
a single tooth. The elastic part has the potential energy k p^(n+1) / (n+1) of both flanks. Gears start with velocities
of gears without play. The stiffness is constant: how many teeth touch, and where, is left out; so is their friction.

Sources: ISO 21771 (backlash, involute function), ISO 6336-1 (stiffness of a pair of steel teeth: about 14 N/um for a mm
of face width); Dubowsky, Freudenstein 1971, J. Eng. Ind. 93, 305 (impact pair).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.base.arguments import number_pair
from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.entries import above_zero, add_force, amounts_given, exponent_given, wheels_given
from mbsd.model.force import Force, ForceKind, Interaction, Mesh, register_force
from mbsd.model.forces.contact import loss_of, penalty_potential, restitution_given
from mbsd.model.joint import Joint, JointKind
from mbsd.model.mechanism import Model
from mbsd.model.teeth import with_radii

ROLLING = JointKind(
    "rolling_gears",
    ("gear",),
    example=lambda m, i, j: None,
    numbers=lambda params: [(params["radius_i"], params["radius_j"])],
    lengths=("radius_i", "radius_j"),
    touching="place",
)
"""Gears without play, at any distance, as which a mesh starts; it is no kind of its own."""


def radii(params: Mapping[str, Any]) -> tuple[Any, Any]:
    """Pitch radii (m), that of a gear in a ring below zero."""
    sized = with_radii(params)
    return sized["radius_i"], -sized["radius_j"] if params["internal"] else sized["radius_j"]


def _involute(angle: float) -> float:
    return math.tan(angle) - angle


def _period(p: Mapping[str, Any]) -> float:
    first, second = radii(p)
    around = math.pi * p["module"] if p.get("teeth") is not None else 2.0 * math.pi * (first + second)
    return around * math.cos(p["pressure_angle"])


def _interactions(force, masses):
    p = force.params
    cosine, (first, second) = math.cos(p["pressure_angle"]), radii(p)
    sizes = [first * cosine, second * cosine, 0.5 * p["backlash"] * cosine]
    own = [_involute(p["pressure_angle"]), _period(p), p["stiffness"], p["exponent"], p["damping"], loss_of(p)]
    middle = 0.0 if p["start"] is None else -p["start"] * math.copysign(cosine, second)
    return tuple(
        Interaction(
            "gear_flank", force.i, force.j, [middle, flank, *sizes, *own, p["least_approach"]],
            remembers=loss_of(p) > 0.0, phased=True,
        )
        for flank in (1.0, -1.0)
    )  # fmt: skip


def _rolled(force: Force, line: float, first: float, second: float) -> float:
    p = force.params
    cosine, (r_i, r_j) = math.cos(p["pressure_angle"]), radii(p)
    return cosine * (r_i * (first - line) + r_j * (second - line))


def _flanks(force: Force, phase: float, x: np.ndarray, y: np.ndarray, turn: np.ndarray) -> np.ndarray:
    plus, _ = _interactions(force, None)
    middle, _flank, base_i, base_j, half, involute, period = plus.numbers[:7]
    both = base_i + base_j
    rolled = base_j * turn - both * np.arctan2(y, x) - middle - phase
    rolled -= period * np.floor(rolled / period + 0.5)
    pressure = np.arccos(np.minimum(both / np.hypot(x, y), 1.0))
    opened = math.copysign(1.0, base_j) * both * (np.tan(pressure) - pressure - involute)
    return np.stack([rolled, -rolled]) - opened - half


def _pitch(force: Force) -> float:
    first, second = radii(force.params)
    return first / (first + second)


def _rolling(force: Force) -> Joint | None:
    if force.params["start"] is None:
        return None
    first, second = radii(force.params)
    return Joint(ROLLING, force.name, force.i, force.j, {"radius_i": first, "radius_j": second})


GEAR_MESH = register_force(
    ForceKind(
        "gear_mesh",
        interactions=_interactions,
        depth_potential=penalty_potential,
        mesh=Mesh(_rolled, _flanks, _pitch, _period),
        ideal=_rolling,
        sign="mesh",
        example=lambda m, i, j: m.gear_mesh(
            "example", i, j, 500.0, radius_i=0.5, radius_j=0.2, internal=True, backlash=1e-3, damping=0.02, start=None
        ),
    )
)


@GEAR_MESH.adds
def gear_mesh(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    stiffness: float,
    backlash: float = 0.0,
    radius_i: float | None = None,
    radius_j: float | None = None,
    internal: bool = False,
    phase: Sequence[float] | None = None,
    teeth: Sequence[int] | None = None,
    module: float | None = None,
    pressure_angle: float = math.radians(20.0),
    exponent: float = 1.0,
    damping: float = 0.0,
    restitution: float | None = None,
    damping_model: str = "flores",
    least_approach: float = 1e-3,
    start: float | None = 0.0,
) -> Force:
    """Add two gears with play: elastic teeth and a ``backlash`` (m) on the pitch circles.

    They are otherwise as of gear_pair.

    A flank that touches pushes along its line of action with stiffness * depth^exponent * (1 + damping * rate of
    depth), never pulling: ``stiffness`` in N/m^exponent, ``damping`` in s/m, or a ``restitution`` as for ``contact``.
    Gears by pitch radii (m), or by ``teeth`` (z_i, z_j) and ``module`` (m); ``internal``: i is the ring around j.
    ``pressure_angle`` in rad. Centres may stand otherwise than the radii say; the play then follows.

    ``start``: how far from the middle of the play they are at the start, on the pitch circle (m, positive where j has
    turned on); they start moving as gears without play do. None: in the middle, or where ``phase``, angles of both
    bodies (rad) that belong together in the middle, puts them; they start moving as start_moving says.
    """
    wheels = wheels_given(m, name, {"radius_i": radius_i, "radius_j": radius_j}, teeth, module=module)
    what = f"{m.name}: force '{name}'"
    sized = with_radii(wheels)
    if internal and sized["radius_i"] <= sized["radius_j"]:
        raise ModelError(f"{what} is internal, so the first gear is the ring and must be the larger; give it first")
    params: dict[str, Any] = {**wheels, "internal": bool(internal), **above_zero(m, name, stiffness=stiffness)}
    params |= amounts_given(m, name, backlash=backlash, damping=damping) | {"pressure_angle": pressure_angle}
    if not 0.0 < pressure_angle < math.pi / 4:
        raise ModelError(
            f"{what}: pressure_angle is {pressure_angle:g} rad; it must be above 0 and below pi/4. 20 degrees are "
            "math.radians(20)"
        )
    params |= exponent_given(m, name, exponent)
    _check_backlash(what, params)
    params |= restitution_given(m, name, damping, restitution, damping_model, least_approach)
    params["phase"] = None if phase is None else number_pair(f"{what}: phase (rad)", phase)
    params["start"] = start
    if start and phase is not None:
        raise ModelError(f"{what} has start= and phase=, which both say where in its play it is; leave one of them out")
    if start and abs(start) > 0.5 * backlash:
        raise ModelError(
            f"{what}: start is {start:g} m, beyond half of the backlash of {backlash:g} m, where flanks are pressed in"
        )
    return add_force(m, GEAR_MESH, name, i, j, params)


def _check_backlash(what: str, params: Mapping[str, Any]) -> None:
    """Raise ModelError for a backlash that leaves no teeth."""
    least = min(with_radii(params)[key] for key in ("radius_i", "radius_j"))
    room = 0.5 * math.pi * params["module"] if params.get("teeth") is not None else least
    if params["backlash"] >= room:
        thick = "the thickness of a tooth" if params.get("teeth") is not None else "the smaller radius"
        raise ModelError(
            f"{what}: backlash is {params['backlash']:g} m, and must be below {thick}, {room:g} m. It is in metres: "
            "0.1 mm is 0.1e-3"
        )
