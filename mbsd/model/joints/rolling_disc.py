"""Rolling disc: a disc of radius r about marker j rolls without slip on the x axis of marker i.

    Phi_1 = y - r              constraint `height` (linear.py), 1 row
    Phi_2 = x + r a - c        constraint `rack` (linear.py), 1 row

The disc is on the side of the line's y axis: it rolls clockwise to positive x. The reaction on body j is the force of
the ground, as a force at the disc's centre and the torque of its friction part. Source: Nikravesh, Planar Multibody
Dynamics, 2018, disc joint.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register

ROLLING_DISC = register(
    JointKind(
        "rolling_disc",
        ("height", "rack"),
        example=lambda m, i, j: m.rolling_disc("example", i, j, radius=0.3),
        numbers=lambda params: [(0.0, 1.0, 0.0, params["radius"]), (1.0, 0.0, params["radius"], 0.0)],
        lengths=("radius",),
    )
)
