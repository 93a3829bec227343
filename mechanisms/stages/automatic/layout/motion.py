"""The motion that parts must have room for: poses over the motion, and limits of joints."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.joint import Joint

# The poses of all bodies over the motion, close enough to each other to look for collisions in the plane.

POSES = 1000
"""About so many poses are looked at."""
TURN, MOST = 0.05, 60
"""And more where a body turns by more than this (rad) from one to the next; at most so many in a step."""


def poses_of(solution: Solution, to_length: float) -> dict[str, np.ndarray]:
    """Return (T, 3) x, y (m times ``to_length``) and theta (rad) of every body's frame, ground included.

    Between outputs they follow the cubic through places and velocities, except where a jump makes two times equal.
    """
    t, parts = solution.t, _parts(solution)
    poses = {}
    for name in solution.mechanism.bodies:
        if name == "ground":
            continue
        body = solution.body(name)
        pose = np.column_stack([body.x, body.y, body.theta])
        rate = np.column_stack([body.vx, body.vy, body.omega])
        fine = _between(t, pose, rate, parts)
        fine[:, :2] *= to_length
        poses[name] = fine
    count = len(next(iter(poses.values()))) if poses else 1
    poses["ground"] = np.zeros((count, 3))
    return poses


def times_of(solution: Solution) -> np.ndarray:
    """Return (T,) the times (s) of :func:`poses_of`."""
    t = solution.t
    return _between(t, t[:, None], np.ones((len(t), 1)), _parts(solution))[:, 0]


def _parts(solution: Solution) -> np.ndarray:
    """Return (n,) how many poses of each step are looked at: more where a body turns far in it."""
    counts = np.full(len(solution.t) - 1, max(1, round(POSES / max(len(solution.t), 1))))
    for name in solution.mechanism.bodies:
        if name != "ground":
            turned = np.abs(np.diff(solution.body(name).theta)) / TURN
            counts = np.maximum(counts, np.minimum(np.ceil(turned), MOST).astype(int))
    return counts


def _between(t: np.ndarray, value: np.ndarray, rate: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Return Hermite's cubic at ``parts`` places of every step, and the last value."""
    if len(t) < 2 or (parts == 1).all():
        return value.astype(float).copy()
    at = np.repeat(np.arange(len(parts)), parts)
    u = ((np.arange(len(at)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[at])[:, None]
    step = np.diff(t)[:, None]
    p, q, v, w = value[:-1][at], value[1:][at], (rate[:-1] * step)[at], (rate[1:] * step)[at]
    shape = (2 * u**3 - 3 * u**2 + 1) * p + (u**3 - 2 * u**2 + u) * v + (3 * u**2 - 2 * u**3) * q + (u**3 - u**2) * w
    return np.concatenate([shape, value[-1:]])


# How far joints may go: their limits, and stops (contacts) between the bodies that they join.

SAME = 1e-9
"""Markers that differ by less (m, rad) are one."""

type Limits = tuple[float | None, float | None]
"""Lower and upper end; None: none."""


def turning(joint: Joint, m: Mechanism) -> Limits:
    """Return limits of a revolute joint (rad), as the angle of its second body against its first."""
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
    """Return limits of a prismatic joint or a pin in a slot (m), along the x axis of its first marker."""
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
    """Return True if both measure from one place and direction of a body to one place of another."""
    return (
        stop.bodies == joint.bodies
        and all(math.dist((a.x, a.y), (b.x, b.y)) < SAME for a, b in ((stop.i, joint.i), (stop.j, joint.j)))
        and abs(math.remainder(stop.i.angle - joint.i.angle, math.tau)) < SAME
    )


def reached(limits: tuple[float | None, float | None], travel: tuple[float, float], most: float) -> Limits:
    """Return the limits that lie no farther beyond the travel than its length, or than ``most``."""
    far = max(travel[1] - travel[0], most)
    lower, upper = limits
    return (
        lower if lower is not None and lower > travel[0] - far else None,
        upper if upper is not None and upper < travel[1] + far else None,
    )
