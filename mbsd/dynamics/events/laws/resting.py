"""Joints at rest that hold each other: what each carries, and how near they are to giving way.

One set of rows holds them, and its multipliers carry all. The friction is shared among all joints at rest (sharing.py);
their limits depend on reactions, which change with the shares, so it is shared again until both agree.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.arrays.friction_along import normals_along
from mbsd.dynamics.events.bounds import AGREED, PASSES
from mbsd.dynamics.events.laws.compliance import Compliance
from mbsd.dynamics.events.laws.sharing import share
from mbsd.dynamics.rows.held import STICKS
from mbsd.dynamics.rows.joint_sticks import JointStick


def carried(at: Compliance, sticks: Sequence[JointStick], lam: np.ndarray) -> tuple[np.ndarray, float]:
    """Multipliers (m,) with the friction shared, and the part s of their limits that the joints need; lam (m,)."""
    resting = [stick for stick in sticks if stick.state == STICKS]
    ways = [stick.way for stick in resting]
    directions = at.generalised(ways)
    dv, lam_of = at.answers(directions)
    compliance, start, part = directions.T @ dv, -lam[ways], 0.0
    forces, out = start, lam
    for _ in range(PASSES):
        normal = normals_along(at.packed, at.dynamics.loads, at.q[None], at.compact[None], out[None])[0]
        limits = np.array([stick.limit(normal) for stick in resting])
        shared, part = share(compliance, start, limits)
        change = float(np.abs(shared - forces).max())
        forces, out = shared, lam + lam_of @ (shared - start)
        out[ways] = -shared
        if change <= AGREED * float(np.abs(shared).max()):
            break
    return out, part
