"""Rack and pinion: a pinion of pitch radius r about marker j rolls along the x axis of marker i.

    Phi = x + r a - c        constraint `rack` (linear.py), 1 row

x is how far the pinion's centre lies along the rack, a its angle against the rack. The pinion is on the side of the
rack's y axis: it rolls clockwise to positive x. The joint holds the turning only; pins and guides hold the rest. The
reaction on body j is the tooth force along the rack as a force at its centre and a torque r times as large.
"""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.model.adding.joints import join, phase_given, wheels_given
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, register
from mbsd.model.mechanism import Model
from mbsd.model.teeth import rack_problem, with_radii

RACK_AND_PINION = register(
    JointKind(
        "rack_and_pinion",
        ("rack",),
        example=lambda m, i, j: m.rack_and_pinion("example", i, j, radius=0.3),
        numbers=lambda params: [(1.0, 0.0, with_radii(params)["radius"], 0.0)],
        problem=rack_problem,
        kept=lambda params, x, y: y,
        lengths=("radius",),
        touching="place",
    )
)


@RACK_AND_PINION.adds
def rack_and_pinion(
    m: Model,
    name: str,
    rack: Marker,
    pinion: Marker,
    radius: float | None = None,
    phase: Sequence[float] | None = None,
    teeth: int | None = None,
    module: float | None = None,
) -> Joint:
    """Add a pinion about ``pinion`` on the x axis of ``rack``, by its pitch radius (m), or by teeth.

    At the start its centre must stand as far above that axis, on the side of its y axis, as its radius, or
    module z / 2 by ``teeth`` and ``module`` (AssemblyError).
    """
    wheels = wheels_given(m, name, {"radius": radius}, teeth, module=module)
    return join(m, RACK_AND_PINION, name, rack, pinion, None, **wheels, phase=phase_given(m, name, phase))
