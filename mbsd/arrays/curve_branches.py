"""Branches of points on curves that cross themselves or their continuations.

Such a row keeps the parameter of its foot where the motion was accepted last (mbsd/equations/relative/curve_pieces.py),
in LAST of its relative pose.
A later look at the poses finds the branch from the motion: at a crossing it is the one along which the point moves.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.equations.assembly import tabulate
from mbsd.equations.relative import curve_pieces as pieces
from mbsd.equations.relative.equation import AT, MARKER_I, MARKER_J
from mbsd.equations.system import LAST

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

CURVES = ("curve", "curve_rolling")
NEAR = 1e-5
"""Fraction of the size: a branch nearer than this may be the one a point is on."""


class CurveRow(NamedTuple):
    """A row whose curve crosses itself."""

    i: int
    """Marker."""
    j: int
    numbers: np.ndarray
    """Numbers of its equation; a copy, as numba looks longer at the types of arrays that cannot be written into."""
    own: np.ndarray
    """(16,) its relative pose, scratch, and LAST."""


class CurveBranches:
    """The rows of a packed mechanism whose curves cross themselves."""

    def __init__(self, packed: Packed) -> None:
        system, self.packed = packed.system, packed
        self.rows: list[CurveRow] = []
        for k, name in enumerate(packed.specials.names):
            i, j, at = (int(system.special[k, column]) for column in (MARKER_I, MARKER_J, AT))
            if name in CURVES and system.numbers[at + pieces.FARTHEST] > 0.0:
                self.rows.append(CurveRow(i, j, system.numbers[at:].copy(), packed.ws.relative[k]))

    def __bool__(self) -> bool:
        return bool(self.rows)

    def settle(self, q: np.ndarray, v: np.ndarray) -> None:
        """Take the branches along which the points move at q, v (3 nb,)."""
        for row in self.rows:
            numbers, own = row.numbers, row.own
            own[LAST] = math.nan
            x, y, vx, vy = self._relative(q, v, row.i, row.j)
            best = pieces.foot(numbers, x, y, own)
            least = self._across(row, x, y, vx, vy)
            for begun in self._begun(numbers, x, y):
                own[LAST] = begun
                u = pieces.foot(numbers, x, y, own)
                across = self._across(row, x, y, vx, vy)
                if across < least:
                    best, least = u, across
            own[LAST] = best

    @staticmethod
    def _begun(numbers: np.ndarray, x: float, y: float) -> list[float]:
        """Return parameters from which the branches near (x, y) are searched, also of continuations."""
        end = pieces.TABLE + pieces.WIDTH * int(numbers[pieces.COUNT])
        nodes = numbers[pieces.TABLE : end].reshape(-1, pieces.WIDTH)
        square = (nodes[:, 1] - x) ** 2 + (nodes[:, 7] - y) ** 2
        around = np.pad(square, 1, "wrap") if numbers[pieces.CLOSED] else np.pad(square, 1, constant_values=math.inf)
        out = nodes[(square <= around[:-2]) & (square <= around[2:]), 0].tolist()
        if not numbers[pieces.CLOSED]:
            begins, ends = (
                numbers[[pieces.TABLE + 1, pieces.TABLE + 7, pieces.TABLE + 2, pieces.TABLE + 8]],
                numbers[end + pieces.END_X : end + pieces.END_DY + 1],
            )
            for u, (cx, cy, dx, dy), sign in (
                (numbers[pieces.TABLE], begins, -1.0),
                (numbers[pieces.TABLE] + numbers[pieces.SPAN], ends, 1.0),
            ):
                beyond = ((x - cx) * dx + (y - cy) * dy) / (dx * dx + dy * dy)
                if sign * beyond > 0.0:
                    out.append(float(u + beyond))
        return out

    def _across(self, row: CurveRow, x: float, y: float, vx: float, vy: float) -> float:
        """Return speed across the curve at the foot in the scratch; infinite where the point is not on it."""
        at = row.own
        speed = math.hypot(at[pieces.DX], at[pieces.DY])
        tx, ty = at[pieces.DX] / speed, at[pieces.DY] / speed
        off = tx * (y - at[pieces.CY]) - ty * (x - at[pieces.CX]) - row.numbers[pieces.DISTANCE]
        return abs(tx * vy - ty * vx) if abs(off) < NEAR * self.packed.size else math.inf

    def moved(self, q: np.ndarray) -> tuple[list[float], float]:
        """Return parameters of the feet at q (3 nb,), and the largest move relative to its limit."""
        feet, farthest = [], 0.0
        for i, j, numbers, own in self.rows:
            x, y, _, _ = self._relative(q, np.zeros_like(q), i, j)
            feet.append(pieces.foot(numbers, x, y, own))
            way = abs(feet[-1] - own[LAST])
            if numbers[pieces.CLOSED]:
                way = min(way, abs(numbers[pieces.SPAN] - way))
            farthest = max(farthest, way / numbers[pieces.FARTHEST])
        return feet, farthest

    def accept(self, feet: list[float]) -> None:
        """Go on from these parameters of the feet."""
        for row, u in zip(self.rows, feet, strict=True):
            row.own[LAST] = u

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


def tabulate_along(
    packed: Packed,
    drives: np.ndarray,
    q: np.ndarray,
    v: np.ndarray,
    phi: np.ndarray,
    compact: np.ndarray,
    gamma: np.ndarray,
    pairs: np.ndarray | None = None,
) -> None:
    """Tabulate along a motion q, v (T, 3 nb), on the branches along which points move at each pose.

    ``pairs`` (T, o): the pairs of outlines that rows kept; None: none.
    """
    if "outline" in packed.specials.names:
        from mbsd.arrays.outline_pairs import tabulate_pairs

        tabulate_pairs(packed, drives, q, v, phi, compact, gamma, pairs)
        return
    following = CurveBranches(packed)
    if not following.rows:
        tabulate(packed.system, drives, q, v, packed.ws, phi, compact, gamma)
        return
    kept = [float(row.own[LAST]) for row in following.rows]
    for k in range(len(q)):
        following.settle(q[k], v[k])
        row = slice(k, k + 1)
        tabulate(packed.system, drives[row], q[row], v[row], packed.ws, phi[row], compact[row], gamma[row])
    following.accept(kept)
