"""Belt or chain over two pulleys with centres at markers i and j, tight and without slip.

    open       Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      constraint `gear`, 1 row
    crossed    Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c

phi is the direction of the line of centres; the centres keep their distance, fixed or carried by an arm. The reaction
on body j is the difference of the strands' pulls as a torque, and as a force where the line of centres turns. Toothed
pulleys and sprockets given by teeth and pitch have r = pitch z / (2 pi).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mbsd.model.joints.kind import JointKind, register
from mbsd.model.teeth import with_radii


def _numbers(params: Mapping[str, Any]) -> list[tuple[float, float]]:
    sized = with_radii(params)
    return [(sized["radius_i"], sized["radius_j"] if params["crossed"] else -sized["radius_j"])]


BELT = register(
    JointKind(
        "belt",
        ("gear",),
        example=lambda m, i, j: m.belt("example", i, j, radius_i=0.3, radius_j=0.2, crossed=True),
        numbers=_numbers,
        lengths=("radius_i", "radius_j"),
    )
)
