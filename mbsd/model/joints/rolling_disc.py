"""Rolling disc: a disc of radius r about marker j rolls without slip on the x axis of marker i.

    Phi_1 = y - r              constraint `height` (linear.py), 1 row
    Phi_2 = x + r a - c        constraint `rack` (linear.py), 1 row

The disc is on the side of the line's y axis: it rolls clockwise to positive x. The reaction on body j is the force of
the ground, as a force at the disc's centre and the torque of its friction part. Source: Nikravesh, Planar Multibody
Dynamics, 2018, disc joint.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.model.adding.joints import join, phase_given, radii_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model

ROLLING_DISC = register(
    JointKind(
        "rolling_disc",
        ("height", "rack"),
        example=lambda m, i, j: m.rolling_disc("example", i, j, radius=0.3),
        numbers=lambda params: [(0.0, 1.0, 0.0, params["radius"]), (1.0, 0.0, params["radius"], 0.0)],
        lengths=("radius",),
        touching="line",
    )
)


@ROLLING_DISC.adds
def rolling_disc(
    m: Model, name: str, line: Marker, disc: Marker, radius: float, phase: Sequence[float] | None = None
) -> Joint:
    """Add a disc of this radius (m) about ``disc`` that rolls on the y side of ``line``'s x axis."""
    radii = radii_given(m, name, radius=radius)
    return join(m, ROLLING_DISC, name, line, disc, None, **radii, phase=phase_given(m, name, phase))
