"""How far joints may go: their limits, and stops (contacts) between the bodies that they join."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.joint import Joint

SAME = 1e-9
"""Markers that differ by less (m, rad) are one."""

type Limits = tuple[float | None, float | None]
"""Lower and upper end; None: none."""


def turning(joint: Joint, m: Mechanism) -> Limits:
    """Limits of a revolute joint (rad), as the angle of its second body against its first."""
    own, ends = joint.j.angle - joint.i.angle, []
    lower, upper = joint.params.get("limits") or (None, None)
    ends += [(lower - own, False)] if lower is not None else []
    ends += [(upper - own, True)] if upper is not None else []
    for stop in m.contacts.values():
        if stop.kind.name != "angle_stop" or set(stop.bodies) != set(joint.bodies):
            continue
        at, is_upper = stop.params["at"] - (stop.j.angle - stop.i.angle), stop.params["upper"]
        ends.append((at, is_upper) if stop.bodies == joint.bodies else (-at, not is_upper))
    return _tightest(ends)


def sliding(joint: Joint, m: Mechanism) -> Limits:
    """Limits of a prismatic joint or a pin in a slot (m), along the x axis of its first marker."""
    lower, upper = joint.params.get("limits") or (None, None)
    ends = [(end, is_upper) for end, is_upper in ((lower, False), (upper, True)) if end is not None]
    for stop in m.contacts.values():
        if stop.kind.name == "coordinate_stop" and _is_same(stop, joint):
            ends.append((stop.params["at"], stop.params["upper"]))
    return _tightest(ends)


def _tightest(ends: list[tuple[float, bool]]) -> Limits:
    lowers, uppers = ([end for end, is_upper in ends if is_upper == side] for side in (False, True))
    return max(lowers, default=None), min(uppers, default=None)


def _is_same(stop: Joint, joint: Joint) -> bool:
    """Whether both measure the same: from one place and direction of a body to one place of another."""
    return (
        stop.bodies == joint.bodies
        and all(math.dist((a.x, a.y), (b.x, b.y)) < SAME for a, b in ((stop.i, joint.i), (stop.j, joint.j)))
        and abs(math.remainder(stop.i.angle - joint.i.angle, math.tau)) < SAME
    )


def reached(limits: tuple[float | None, float | None], travel: tuple[float, float], most: float) -> Limits:
    """Those ends that are no farther beyond the travel than it is long, or than ``most``."""
    far = max(travel[1] - travel[0], most)
    lower, upper = limits
    return (
        lower if lower is not None and lower > travel[0] - far else None,
        upper if upper is not None and upper < travel[1] + far else None,
    )
