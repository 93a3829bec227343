"""What a simulation looks at step by step: points on curves that cross themselves, and wheels that may meet.

Such a row keeps the parameter of its foot where the motion was accepted last (constraints/curve_pieces.py). A
simulation takes one step at a time, moves the parameters on, and divides a step in which a foot goes too far. Poses
looked at afterwards tell their branch by themselves: at a crossing it is the one along which the point moves. A sweep
predicts so well that the nearest foot is on the right branch; it is refused where a foot jumps nevertheless.
Wheels: free_wheels.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.assembly import tabulate
from mbsd.constraints.curve_pieces import CLOSED, CX, CY, DISTANCE, DX, DY, FARTHEST, LAST, SPAN, TABLE, foot
from mbsd.errors import BranchError
from mbsd.free_wheels import FreeWheels
from mbsd.integrators.state import ACCEPTED, PAUSED, REACHED, TIME, State, copied
from mbsd.specials import AT, MARKER_I, MARKER_J

if TYPE_CHECKING:
    from mbsd.packing import Packed

CURVES = ("curve", "curve_rolling")
NEAR = 1e-5
"""Of the size: a branch nearer than this may be the one a point is on."""
LOOKS = 64
"""Parameters from which the branches near a point are looked for."""
SHORTEST = 1e-9
"""A step may be divided down to this part of itself."""
AHEAD = 2.0
"""Last steps within which wheels that meet are why another one fails."""


class CurveFollowing:
    """The rows of a packed mechanism whose curves cross themselves."""

    def __init__(self, packed: Packed) -> None:
        system, self.packed = packed.system, packed
        self.rows: list[tuple[int, int, np.ndarray]] = []
        """Markers i and j, and the numbers of the row."""
        for k, name in enumerate(packed.specials.names):
            at = int(system.special[k, AT])
            if name in CURVES and system.numbers[at + FARTHEST] > 0.0:
                self.rows.append(
                    (int(system.special[k, MARKER_I]), int(system.special[k, MARKER_J]), system.numbers[at:])
                )
        self.wheels = FreeWheels(packed)
        self._scratch = np.zeros_like(packed.ws.relative)

    def __bool__(self) -> bool:
        return bool(self.rows or self.wheels)

    def settle(self, q: np.ndarray, v: np.ndarray) -> None:
        """Take the branches along which the points move at q, v (3 nb,)."""
        for i, j, numbers in self.rows:
            numbers[LAST] = math.nan
            x, y, vx, vy = self._relative(q, v, i, j)
            best = foot(numbers, x, y, self._scratch)
            least = self._across(numbers, x, y, vx, vy)
            for part in np.arange(1, LOOKS) / LOOKS:
                numbers[LAST] = numbers[TABLE] + part * numbers[SPAN]
                u = foot(numbers, x, y, self._scratch)
                across = self._across(numbers, x, y, vx, vy)
                if across < least:
                    best, least = u, across
            numbers[LAST] = best

    def _across(self, numbers: np.ndarray, x: float, y: float, vx: float, vy: float) -> float:
        """Speed across the curve at the foot in the scratch; infinite where the point is not on it."""
        at = self._scratch
        speed = math.hypot(at[DX], at[DY])
        tx, ty = at[DX] / speed, at[DY] / speed
        off = tx * (y - at[CY]) - ty * (x - at[CX]) - numbers[DISTANCE]
        return abs(tx * vy - ty * vx) if abs(off) < NEAR * self.packed.size else math.inf

    def moved(self, q: np.ndarray) -> tuple[list[float], float]:
        """Parameters of the feet at q (3 nb,), and the farthest that one of them goes, as part of how far it may."""
        feet, farthest = [], 0.0
        for i, j, numbers in self.rows:
            x, y, _, _ = self._relative(q, np.zeros_like(q), i, j)
            feet.append(foot(numbers, x, y, self._scratch))
            way = abs(feet[-1] - numbers[LAST])
            if numbers[CLOSED]:
                way = min(way, abs(numbers[SPAN] - way))
            farthest = max(farthest, way / numbers[FARTHEST])
        return feet, farthest

    def accept(self, feet: list[float]) -> None:
        """Go on from these."""
        for (_, _, numbers), u in zip(self.rows, feet, strict=True):
            numbers[LAST] = u

    def through(self, advance: Callable[..., int], arrays: Any, scratch: Any, state: State, *rest: Any) -> int:
        """``advance`` of an Integrator, a step at a time, with the branches followed."""
        out, settings, end, steps = rest
        last = 0.0
        while True:
            before, target = copied(state), end
            while True:
                status = advance(arrays, scratch, state, out, settings, target, 1)
                if status not in (REACHED, PAUSED):
                    self.wheels.refuse_meeting(float(before.clock[TIME]), before.y, AHEAD * last)
                    return status
                feet, farthest = self.moved(state.y[0])
                taken = float(state.clock[TIME] - before.clock[TIME])
                farthest = max(farthest, self.wheels.approach(before.y, state.y, taken))
                if farthest <= 1.0 or taken <= SHORTEST * settings.longest:
                    last = taken
                    break
                for part, source in zip(state, before, strict=True):
                    part[...] = source
                target = float(before.clock[TIME]) + taken / (2.0 * farthest)
            self.accept(feet)
            self.wheels.refuse_met(float(state.clock[TIME]), state.y[0])
            steps -= int(state.count[ACCEPTED] - before.count[ACCEPTED])
            if state.clock[TIME] >= end:
                return REACHED
            if steps <= 0:
                return PAUSED

    def _relative(self, q: np.ndarray, v: np.ndarray, i: int, j: int) -> tuple[float, float, float, float]:
        """Place and velocity of marker j in the axes of marker i."""
        (px, py, ax, ay), (qx, qy, bx, by) = self._marker(q, v, i), self._marker(q, v, j)
        body = int(self.packed.system.marker_body[i])
        c, s = math.cos(q[3 * body + 2]), math.sin(q[3 * body + 2])
        ux, uy = self.packed.system.marker_axis[i]
        ux, uy = c * ux - s * uy, s * ux + c * uy
        dx, dy, ex, ey, omega = qx - px, qy - py, bx - ax, by - ay, v[3 * body + 2]
        x, y = ux * dx + uy * dy, ux * dy - uy * dx
        return x, y, ux * ex + uy * ey + omega * y, ux * ey - uy * ex - omega * x

    def _marker(self, q: np.ndarray, v: np.ndarray, marker: int) -> tuple[float, float, float, float]:
        body = int(self.packed.system.marker_body[marker])
        c, s = math.cos(q[3 * body + 2]), math.sin(q[3 * body + 2])
        ax, ay = self.packed.system.marker_arm[marker]
        ax, ay = c * ax - s * ay, s * ax + c * ay
        omega = v[3 * body + 2]
        return q[3 * body] + ax, q[3 * body + 1] + ay, v[3 * body] - omega * ay, v[3 * body + 1] + omega * ax


def refuse_jumps(packed: Packed, times: np.ndarray, q: np.ndarray) -> None:
    """Raise BranchError where a point leaves the branch of its curve between poses q (T, 3 nb) of a sweep."""
    following = CurveFollowing(packed)
    if not following.rows:
        return
    for k, pose in enumerate(q):
        before = [float(numbers[LAST]) for _, _, numbers in following.rows]
        following.accept([math.nan] * len(before))
        feet, _ = following.moved(pose)
        following.accept(before)
        if k:
            for (i, j, numbers), u in zip(following.rows, feet, strict=True):
                way = abs(u - numbers[LAST])
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


def tabulate_along(
    packed: Packed,
    drives: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    phi: np.ndarray,
    compact: np.ndarray,
    gamma: np.ndarray,
) -> None:
    """``tabulate`` along a motion q, v (T, 3 nb), each pose on the branches along which its points move."""
    following = CurveFollowing(packed)
    if not following.rows:
        tabulate(packed.system, drives, q, v, packed.ws, phi, compact, gamma)
        return
    kept = packed.system.numbers.copy()
    for k in range(len(q)):
        following.settle(q[k], v[k])
        row = slice(k, k + 1)
        tabulate(packed.system, drives[row], q[row], v[row], packed.ws, phi[row], compact[row], gamma[row])
    packed.system.numbers[:] = kept
