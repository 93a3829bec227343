"""Belt or chain over two pulleys with centres at markers i and j, tight and without slip.

    open       Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      constraint `gear`, 1 row
    crossed    Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c

phi is the direction of the line of centres; the centres keep their distance, fixed or carried by an arm. The reaction
on body j is the difference of the strands' pulls as a torque, and as a force where the line of centres turns. Toothed
pulleys and sprockets given by teeth and pitch have r = pitch z / (2 pi).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from mbsd.model.adding.joints import join, phase_given, wheels_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model
from mbsd.model.teeth import belt_problem, with_radii


def _numbers(params: Mapping[str, Any]) -> list[tuple[float, float]]:
    sized = with_radii(params)
    return [(sized["radius_i"], sized["radius_j"] if params["crossed"] else -sized["radius_j"])]


BELT = register(
    JointKind(
        "belt",
        ("gear",),
        look="band",
        example=lambda m, i, j: m.belt("example", i, j, radius_i=0.3, radius_j=0.2, crossed=True),
        numbers=_numbers,
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
