"""Belt or chain over two pulleys with centres at markers i and j, tight and without slip.

    open       Phi = r_i (theta_i - phi) - r_j (theta_j - phi) - c      constraint `gear`, 1 row
    crossed    Phi = r_i (theta_i - phi) + r_j (theta_j - phi) - c

phi is the direction of the line of centres; the centres keep their distance, fixed or carried by an arm. The reaction
on body j is the difference of the strands' pulls as a torque, and as a force where the line of centres turns.
"""

from __future__ import annotations

from mbsd.joints.kind import JointKind, register

BELT = register(
    JointKind(
        "belt",
        ("gear",),
        example=lambda m, i, j: m.belt("example", i, j, radius_i=0.3, radius_j=0.2, crossed=True),
        numbers=lambda params: [(params["radius_i"], params["radius_j"] if params["crossed"] else -params["radius_j"])],
        lengths=("radius_i", "radius_j"),
    )
)
