"""Spherical joint (ball): both markers share their place and turn freely.

    Phi = d        3 rows

The reaction on body j is a force.
"""

from __future__ import annotations

from mbsd.spatial.model.body import Fixing, Place
from mbsd.spatial.model.entries import enter, markers_given
from mbsd.spatial.model.joint import Joint, JointKind, register_joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rows import point

SPHERICAL = register_joint(
    JointKind(
        "spherical",
        lambda joint: [point(joint.i, joint.j)],
        example=lambda m, i, j: m.spherical("example", i, j, at=(0.1, 0.2, 0.3)),
    )
)


@SPHERICAL.adds
def spherical(m: Model, name: str, first: Fixing, second: Fixing, at: Place | None = None) -> Joint:
    """A ball in its socket: the bodies share the place ``at`` (m) of the world in the design pose."""
    return enter(m, SPHERICAL, name, *markers_given(m, name, first, second, at, None))
