"""Checks that links close at the start and teeth reach each other, as findings instead of errors."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mbsd.analyses.finding import Finding
from mbsd.arrays.packing import pack
from mbsd.arrays.starts import relative_poses
from mbsd.base.errors import MechanismError
from mbsd.dynamics.prepare.large import mobility
from mbsd.kinematics.pose.close import assemble
from mbsd.model.mechanism import Model
from mbsd.model.teeth import with_radii

ROOM = 0.1
"""Part of the smaller radius by which centres of gears without teeth may stand elsewhere."""
REMEDY = "Look at lengths and places of what it names; m.draw() shows the rough start"


def start_problems(m: Model) -> Iterator[Finding]:
    """Yield what keeps ``m`` from being assembled: links that cannot close, gears apart, a rack on the other side."""
    try:
        mobility(m)
    except MechanismError as error:
        problem, _, remedy = str(error).removeprefix(f"{m.name}: ").partition(". ")
        yield Finding("start", problem.rstrip("."), remedy.rstrip(".") or REMEDY)
        return
    yield from _meshes_apart(m)


def _meshes_apart(m: Model) -> Iterator[Finding]:
    """Gears with play whose centres stand so far from the sum of their radii at the start that no teeth mesh."""
    if not any(force.kind.mesh for force in m.forces.values()):
        return
    packed = pack(m)
    q = assemble(m, packed, 0.0)
    for force in packed.forces:
        if force.kind.mesh is None:
            continue
        sized, (x, y, _) = with_radii(force.params), relative_poses(packed, force, q[None])
        first, second = sized["radius_i"], sized["radius_j"]
        wanted = first - second if force.params["internal"] else first + second
        distance, room = float(np.hypot(x, y)[0]), force.params.get("module", ROOM * min(first, second))
        if abs(distance - wanted) > room:
            yield Finding(
                f"force '{force.name}'",
                f"its centres are {distance:g} m apart at the start, and radii of {first:g} m and {second:g} m say "
                f"{wanted:g} m, so no teeth mesh",
                "Move a centre, or give other radii; a module is in metres: 3 mm is 3e-3",
            )
