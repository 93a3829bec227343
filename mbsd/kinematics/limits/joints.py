"""Limits of joints and branches of curves: a driven motion that leaves them raises an error.

In a simulation limits are stops without rebound; ``m.stop`` makes stops with one.

    revolute               angle of marker j against marker i (rad), whole turns counted
    prismatic, pin_in_slot place of marker j along the x axis of marker i (m)

``limits=(lower, upper)``; None on one side is a one-way stop.

A sweep predicts so well that a point's nearest foot on a curve that crosses itself is on the right branch. Where a foot
jumps nevertheless, the point may have left its branch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import marker_places
from mbsd.base.errors import BranchError, LimitError
from mbsd.equations.relative.curve_pieces import CLOSED, FARTHEST, SPAN
from mbsd.equations.system import LAST

SLACK = 1e-9
"""In sizes and rad: a motion may touch its limit."""


@dataclass(frozen=True)
class Limit:
    """One limited joint, as a coordinate c of its markers with lower <= c <= upper."""

    name: str
    marker_i: int
    marker_j: int
    angular: bool
    offset: float
    """Angle of marker j less that of marker i in their bodies (rad), added to theta_j - theta_i."""
    lower: float
    upper: float
    """rad or m; infinite where there is no stop."""


def limits_of(packed: Packed) -> list[Limit]:
    """Return the limited joints of a mechanism."""
    limits = []
    for joint, (i, j) in zip(packed.joints, packed.markers, strict=True):
        given = joint.params.get("limits")
        if given is not None:
            lower, upper = given
            limits.append(
                Limit(
                    name=joint.name,
                    marker_i=int(i),
                    marker_j=int(j),
                    angular=joint.kind.pair == "pin",
                    offset=joint.j.angle - joint.i.angle,
                    lower=-math.inf if lower is None else float(lower),
                    upper=math.inf if upper is None else float(upper),
                )
            )
    return limits


def coordinate(packed: Packed, limit: Limit, q: np.ndarray) -> np.ndarray:
    """Return (T,) coordinates of the joint along q (T, 3 nb).

    Angles start at the whole turn that is nearest to the limits.
    """
    body_i, body_j = packed.system.marker_body[[limit.marker_i, limit.marker_j]]
    if limit.angular:
        angle = q[:, 3 * body_j + 2] - q[:, 3 * body_i + 2] + limit.offset
        ends = [end for end in (limit.lower, limit.upper) if math.isfinite(end)]
        middle = sum(ends) / len(ends) if len(ends) == 2 else 0.0
        return angle - 2 * math.pi * round((float(angle[0]) - middle) / (2 * math.pi))
    axis = packed.system.marker_axis[limit.marker_i]
    c, s = np.cos(q[:, 3 * body_i + 2]), np.sin(q[:, 3 * body_i + 2])
    gap = marker_places(packed, q, limit.marker_j) - marker_places(packed, q, limit.marker_i)
    return gap[:, 0] * (c * axis[0] - s * axis[1]) + gap[:, 1] * (s * axis[0] + c * axis[1])


def refuse_passed(packed: Packed, times: np.ndarray, q: np.ndarray, smooth: bool = False) -> None:
    """Raise LimitError for the first limit that q (T, 3 nb) passes; ``smooth``: also at peaks between."""
    first: tuple[float, Limit, np.ndarray, int] | None = None
    for limit in limits_of(packed):
        value = coordinate(packed, limit, q)
        value = _with_peaks(value) if smooth else value
        slack = SLACK * (1.0 if limit.angular else packed.size)
        beyond = np.flatnonzero((value < limit.lower - slack) | (value > limit.upper + slack))
        if len(beyond):
            at = int(beyond[0])
            time = _crossing(limit, times, value, at)
            if first is None or time < first[0]:
                first = time, limit, value, at
    if first is None:
        return
    time, limit, value, at = first
    low = value[at] < limit.lower
    end = limit.lower if low else limit.upper
    furthest = float(value.min() if low else value.max())
    raise LimitError(
        f"{packed.name}: at t = {time:.6g} s joint '{limit.name}' passes its {'lower' if low else 'upper'} limit of "
        f"{_said(end, limit)}; it would go to {_said(furthest, limit)}. Drive within the limits, widen them, or change "
        "the lengths."
    )


def _with_peaks(value: np.ndarray) -> np.ndarray:
    """Return (T,) with each peak as high as the parabola through it and its neighbours.

    Peaks lie between equal steps.
    """
    out = value.copy()
    left, middle, right = value[:-2], value[1:-1], value[2:]
    bend = left - 2 * middle + right
    peak = ((middle > left) & (middle >= right)) | ((middle < left) & (middle <= right))
    rise = np.where(peak & (np.abs(right - left) <= np.abs(2 * bend)), (right - left) ** 2, 0.0)
    out[1:-1] -= np.divide(rise, 8 * bend, out=np.zeros_like(bend), where=bend != 0)
    return out


def _crossing(limit: Limit, times: np.ndarray, value: np.ndarray, at: int) -> float:
    """Return time when the limit is met, by a straight line between outputs."""
    if at == 0:
        return float(times[0])
    end = limit.lower if value[at] < limit.lower else limit.upper
    share = (end - value[at - 1]) / (value[at] - value[at - 1])
    return float(times[at - 1] + share * (times[at] - times[at - 1]))


def _said(value: float, limit: Limit) -> str:
    return f"{math.degrees(value):.6g} degrees" if limit.angular else f"{value:.6g} m"


def refuse_jumps(packed: Packed, times: np.ndarray, q: np.ndarray) -> None:
    """Raise BranchError where a point leaves the branch of its curve between poses q (T, 3 nb) of a sweep."""
    following = CurveBranches(packed)
    if not following.rows:
        return
    for k, pose in enumerate(q):
        before = [float(row.own[LAST]) for row in following.rows]
        following.accept([math.nan] * len(before))
        feet, _ = following.moved(pose)
        following.accept(before)
        if k:
            for (i, j, numbers, own), u in zip(following.rows, feet, strict=True):
                way = abs(u - own[LAST])
                way = min(way, abs(numbers[SPAN] - way)) if numbers[CLOSED] else way
                if way > numbers[FARTHEST]:
                    name = next(
                        joint.name
                        for joint, place in zip(packed.specials.joints, packed.specials.places, strict=True)
                        if place[:2] == (i, j)
                    )
                    raise BranchError(
                        f"{packed.name}: joint '{name}': its curve crosses itself. Between t = {times[k - 1]:.6g} and "
                        f"{times[k]:.6g} s the point goes {way:.3g} m along it, more than {numbers[FARTHEST]:.3g} m: "
                        "it may be on the other branch. Take more steps; if that does not help, simulate the motion."
                    )
        following.accept(feet)
    following.accept([math.nan] * len(following.rows))
