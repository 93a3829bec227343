"""Rack and pinion: a pinion of pitch radius r about marker j rolls along the x axis of marker i.

    Phi = x + r a - c        constraint `rack` (linear.py), 1 row

x is how far the pinion's centre lies along the rack, a its angle against the rack. The pinion is on the side of the
rack's y axis: it rolls clockwise to positive x. The joint holds the turning only; pins and guides hold the rest. The
reaction on body j is the tooth force along the rack as a force at its centre and a torque r times as large.
"""

from __future__ import annotations

from mbsd.model.joints.kind import JointKind, register
from mbsd.model.teeth import rack_problem, with_radii

RACK_AND_PINION = register(
    JointKind(
        "rack_and_pinion",
        ("rack",),
        example=lambda m, i, j: m.rack_and_pinion("example", i, j, radius=0.3),
        numbers=lambda params: [(1.0, 0.0, with_radii(params)["radius"], 0.0)],
        problem=rack_problem,
        lengths=("radius",),
    )
)
