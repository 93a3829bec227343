"""Where along the normal of the plane the joints of a body lie, as the model gives it (mm)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from shared.shapes.units import mm
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.body import Marker
    from mbsd.model.joint import Joint

SAME = 1e-3
"""Planes that are nearer than this are one (mm)."""


def has_places(m: Mechanism) -> bool:
    """Whether a moving body, or a marker of a joint on one, has a place along the normal of the plane."""
    moving = [body for name, body in m.bodies.items() if name != "ground"]
    ends = [marker for joint in m.joints.values() for marker in (joint.i, joint.j)]
    return any(body.z is not None for body in moving) or any(
        end.z is not None for end in ends if end.body.name != "ground"
    )


def marker_on(joint: Joint, body: str) -> Marker:
    """The end of a joint on one of its bodies."""
    return joint.i if joint.i.body.name == body else joint.j


def other_on(joint: Joint, body: str) -> Marker:
    """The end of a joint that is not on this body."""
    return joint.j if joint.i.body.name == body else joint.i


def place(marker: Marker) -> tuple[float, float]:
    """A marker in its body's frame (mm)."""
    return mm(marker.x), mm(marker.y)


def plane(joint: Joint, body: str) -> float | None:
    """The plane (mm) in which a joint acts on ``body``: the marker's own, else the body's, else that of the other
    body; None if none is given, as of a joint with ground.
    """
    own, other = marker_on(joint, body), other_on(joint, body)
    z = own.plane
    if z is None and other.body.name != "ground":
        z = other.plane
    return None if z is None else mm(z)


def planes(m: Mechanism, body: str) -> list[float]:
    """All different planes (mm) in which joints with moving bodies act on a body, in rising order."""
    heights: list[float] = []
    for joint in m.joints.values():
        if body in joint.bodies and "ground" not in joint.bodies:
            z = plane(joint, body)
            if z is not None and all(abs(z - other) > SAME for other in heights):
                heights.append(z)
    return sorted(heights)


def no_plane(m: Mechanism, joint: str, body: str) -> UserError:
    """What is raised where a joint lies in no plane."""
    return UserError(
        f"{m.name}: joint '{joint}' of '{body}' has no place z along the normal, and others have; give the body or the "
        f"marker one, such as m.body('{body}', z=0.02)"
    )
