"""Gear pair: two gears with centres at markers i and j roll on each other without slip.

    external   Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c      constraint `gear`, 1 row
    internal   Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      gear i is the ring around gear j

phi is the direction of the line of centres, so the centres may be fixed or carried by an arm (planetary trains). The
joint holds the turning only; pins hold the centres. The reaction on body j is the force at its pitch point as a force
at its centre and a torque; it acts along the tangent, without the separating part of a pressure angle. Gears given by
teeth and module have r = module z / 2 (teeth.py) and must stand as far apart as these mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mbsd.model.joints.kind import JointKind, register
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
        lengths=("radius_i", "radius_j"),
    )
)
