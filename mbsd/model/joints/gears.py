"""Gears, belts and chains, racks: wheels that turn each other without slip.

Gear pair: two gears with centres at markers i and j roll on each other without slip.

    external   Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c      constraint `gear`, 1 row
    internal   Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      gear i is the ring around gear j

phi is the direction of the line of centres, so the centres may be fixed or carried by an arm (planetary trains). The
joint holds the turning only; pins hold the centres. The reaction on body j is the force at its pitch point as a force
at its centre and a torque; it acts along the tangent, without the separating part of a pressure angle. Gears given by
teeth and module have r = module z / 2 (teeth.py). At the start gears must stand as far apart as they mesh.

Belt or chain over two pulleys with centres at markers i and j, tight and without slip.

    open       Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      constraint `gear`, 1 row
    crossed    Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c

phi is the direction of the line of centres; the centres keep their distance, fixed or carried by an arm. The reaction
on body j is the difference of the strands' pulls as a torque, and as a force where the line of centres turns. Toothed
pulleys and sprockets given by teeth and pitch have r = pitch z / (2 pi).

Rack and pinion: a pinion of pitch radius r about marker j rolls along the x axis of marker i.

    Phi = x + r a - c        constraint `rack` (linear.py), 1 row

x is how far the pinion's centre lies along the rack, a its angle against the rack. The pinion is on the side of the
rack's y axis: it rolls clockwise to positive x. The joint holds the turning only; pins and guides hold the rest. The
reaction on body j is the tooth force along the rack as a force at its centre and a torque r times as large.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.entries import join, phase_given, wheels_given
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.mechanism import Model
from mbsd.model.teeth import belt_problem, gear_problem, rack_problem, with_radii


def _gear_pair_numbers(params: Mapping[str, Any]) -> list[tuple[float, float]]:
    sized = with_radii(params)
    return [(sized["radius_i"], -sized["radius_j"] if params["internal"] else sized["radius_j"])]


GEAR_PAIR = register_joint(
    JointKind(
        "gear_pair",
        ("gear",),
        example=lambda m, i, j: m.gear_pair("example", i, j, radius_i=0.5, radius_j=0.2, internal=True),
        numbers=_gear_pair_numbers,
        problem=gear_problem,
        kept=lambda params, x, y: np.hypot(x, y),
        lengths=("radius_i", "radius_j"),
        touching="place",
    )
)


@GEAR_PAIR.adds
def gear_pair(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius_i: float | None = None,
    radius_j: float | None = None,
    internal: bool = False,
    phase: Sequence[float] | None = None,
    teeth: Sequence[int] | None = None,
    module: float | None = None,
) -> Joint:
    """Add two gears with centres at i and j, by pitch radii (m), or by ``teeth`` and ``module`` (m).

    ``teeth`` are (z_i, z_j).

    ``internal``: i is the ring around j. They mesh as they stand at the start; ``phase`` gives angles of both
    bodies (rad) that belong together. At the start they must stand radius_i + radius_j apart, a ring and the gear
    in it radius_i - radius_j (AssemblyError): to 1/1000 of the smaller radius, or of the module.
    """
    wheels = wheels_given(m, name, {"radius_i": radius_i, "radius_j": radius_j}, teeth, module=module)
    sized = with_radii(wheels)
    if internal and sized["radius_i"] <= sized["radius_j"]:
        first, second = (
            [f"{count} teeth" for count in wheels["teeth"]]
            if "teeth" in wheels
            else [f"{key} = {wheels[key]:g} m" for key in wheels]
        )
        raise ModelError(
            f"{m.name}: gear_pair '{name}' is internal, so {first} is the ring's and must be "
            f"above {second}; give the ring first"
        )
    return join(m, GEAR_PAIR, name, i, j, None, **wheels, internal=bool(internal), phase=phase_given(m, name, phase))


def _belt_numbers(params: Mapping[str, Any]) -> list[tuple[float, float]]:
    sized = with_radii(params)
    return [(sized["radius_i"], sized["radius_j"] if params["crossed"] else -sized["radius_j"])]


BELT = register_joint(
    JointKind(
        "belt",
        ("gear",),
        look="band",
        example=lambda m, i, j: m.belt("example", i, j, radius_i=0.3, radius_j=0.2, crossed=True),
        numbers=_belt_numbers,
        problem=belt_problem,
        lengths=("radius_i", "radius_j"),
    )
)


@BELT.adds
def belt(
    m: Model,
    name: str,
    i: Marker,
    j: Marker,
    radius_i: float | None = None,
    radius_j: float | None = None,
    crossed: bool = False,
    phase: Sequence[float] | None = None,
    teeth: Sequence[int] | None = None,
    pitch: float | None = None,
) -> Joint:
    """A belt or chain over pulleys with centres at i and j, open or crossed; ``phase`` as in gear_pair.

    By pitch radii (m), or by ``teeth`` (z_i, z_j) and the belt's ``pitch`` (m from tooth to tooth). At the start
    neither pulley may be in the other, and those of a crossed belt must be apart (AssemblyError).
    """
    wheels = wheels_given(m, name, {"radius_i": radius_i, "radius_j": radius_j}, teeth, pitch=pitch)
    return join(m, BELT, name, i, j, None, **wheels, crossed=bool(crossed), phase=phase_given(m, name, phase))


RACK_AND_PINION = register_joint(
    JointKind(
        "rack_and_pinion",
        ("rack",),
        example=lambda m, i, j: m.rack_and_pinion("example", i, j, radius=0.3),
        numbers=lambda params: [(1.0, 0.0, with_radii(params)["radius"], 0.0)],
        problem=rack_problem,
        kept=lambda params, x, y: y,
        lengths=("radius",),
        touching="place",
    )
)


@RACK_AND_PINION.adds
def rack_and_pinion(
    m: Model,
    name: str,
    rack: Marker,
    pinion: Marker,
    radius: float | None = None,
    phase: Sequence[float] | None = None,
    teeth: int | None = None,
    module: float | None = None,
) -> Joint:
    """Add a pinion about ``pinion`` on the x axis of ``rack``, by its pitch radius (m), or by teeth.

    At the start its centre must stand as far above that axis, on the side of its y axis, as its radius, or
    module z / 2 by ``teeth`` and ``module`` (AssemblyError).
    """
    wheels = wheels_given(m, name, {"radius": radius}, teeth, module=module)
    return join(m, RACK_AND_PINION, name, rack, pinion, None, **wheels, phase=phase_given(m, name, phase))
