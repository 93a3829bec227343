"""Geneva: a pin on the crank i indexes the slotted wheel j and locks it in between.

    driven   Phi = a - (direction of the pin as seen from the wheel)     constraint `geneva`, 1 row
    dwell    Phi = a - (direction of the crank as seen from the wheel) - pi / n

both up to whole slot pitches 2 pi / n. Marker i is the crank's centre with its x axis through the pin, marker j the
wheel's centre with its x axis along a slot; pins hold both centres. Position and velocity are smooth; acceleration
jumps where the pin enters and leaves. The pin's circle must meet the slots along them: radius = distance sin(pi / n).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Marker
from mbsd.model.entries import join, radii_given
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.mechanism import Model

ENTRY = 1e-6
"""Part of the centre distance by which the pin's radius may be off."""


def _problem(params: Mapping[str, Any], x: float, y: float) -> str | None:
    distance = math.hypot(x, y)
    wanted = distance * math.sin(math.pi / params["slots"])
    if abs(wanted - params["radius"]) <= ENTRY * distance:
        return None
    return (
        f"the pin would hit the slots: with {params['slots']} slots and centres {distance:.6g} m apart its radius must "
        f"be distance sin(pi / slots) = {wanted:.6g} m, not {params['radius']:.6g}"
    )


GENEVA = register_joint(
    JointKind(
        "geneva",
        ("geneva",),
        look="captive",
        example=lambda m, i, j: m.geneva("example", i, j, slots=5, radius=0.3),
        numbers=lambda params: [(params["slots"], params["radius"], params["radius"])],
        problem=_problem,
        kept=lambda params, x, y: np.hypot(x, y) * math.sin(math.pi / params["slots"]) - params["radius"],
        lengths=("radius",),
        touching="place",
        symmetry=lambda params: params["slots"],
    )
)

MOST_SLOTS = 1000


@GENEVA.adds
def geneva(m: Model, name: str, crank: Marker, wheel: Marker, slots: int, radius: float) -> Joint:
    """Add a Geneva: the pin at ``radius`` (m) on the x axis of ``crank`` indexes a wheel with slots.

    ``slots`` is their number.

    The x axis of marker ``wheel`` is a slot. The radius must be the distance of the centres times sin(pi / slots).
    """
    if not 3 <= slots <= MOST_SLOTS:
        raise ModelError(
            f"{m.name}: joint '{name}' has slots = {shown(slots)}; it must be a whole number, 3 .. {MOST_SLOTS}"
        )
    return join(m, GENEVA, name, crank, wheel, None, slots=int(slots), **radii_given(m, name, radius=radius))
