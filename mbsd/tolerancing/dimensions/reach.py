"""How far a place may stray: less than the link reaches whose end it is."""

from __future__ import annotations

import math

from mbsd.base.errors import ModelError
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model


def refuse_beyond(m: Model, what: str, far: float, marker: Marker) -> None:
    """Raise ModelError where ``marker`` strays as ``far`` (m) as the farthest other joint of its body is, or farther.

    ``what`` says so in words. A body with no other joint has no such length.
    """
    reach = _reach(m, marker)
    if reach > 0.0 and far >= reach:
        raise ModelError(
            f"{m.name}: tolerances: {what} up to {far:g} m, and '{marker.body.name}' reaches {reach:g} m from there to "
            "its farthest joint; narrow it. Lengths are in metres: 0.02 mm is 2e-5"
        )


def _reach(m: Model, marker: Marker) -> float:
    """m from a marker to the farthest joint of its body."""
    others = (other for joint in m.joints.values() for other in (joint.i, joint.j) if other.body is marker.body)
    return max((math.hypot(other.x - marker.x, other.y - marker.y) for other in others), default=0.0)
