"""Gear pair: two gears with centres at markers i and j roll on each other without slip.

    external   Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c      constraint `gear`, 1 row
    internal   Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      gear i is the ring around gear j

phi is the direction of the line of centres, so the centres may be fixed or carried by an arm (planetary trains). The
joint holds the turning only; pins hold the centres. The reaction on body j is the force at its pitch point as a force
at its centre and a torque; it acts along the tangent, without the separating part of a pressure angle. Gears given by
teeth and module have r = module z / 2 (teeth.py). At the start gears must stand as far apart as they mesh.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.adding.joints import join, phase_given, wheels_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model
from mbsd.model.teeth import gear_problem, with_radii


def _numbers(params: Mapping[str, Any]) -> list[tuple[float, float]]:
    sized = with_radii(params)
    return [(sized["radius_i"], -sized["radius_j"] if params["internal"] else sized["radius_j"])]


GEAR_PAIR = register(
    JointKind(
        "gear_pair",
        ("gear",),
        example=lambda m, i, j: m.gear_pair("example", i, j, radius_i=0.5, radius_j=0.2, internal=True),
        numbers=_numbers,
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
