"""Lift of a follower over the cam's angle: segments of rises, falls and dwells, or a periodic table.

A lift is a length (m) for a translating follower, an angle (rad) for an oscillating one. Derivatives are by the cam's
angle: multiply by omega, omega^2, omega^3 for those by time at constant speed.

Normalised rises f(u) from 0 to 1 for u = 0 .. 1:

    harmonic             (1 - cos pi u) / 2                         acceleration jumps at the ends
    cycloidal            u - sin(2 pi u) / (2 pi)
    3-4-5                10 u^3 - 15 u^4 + 6 u^5
    4-5-6-7              35 u^4 - 84 u^5 + 70 u^6 - 20 u^7          jerk starts at zero too
    modified_sine        quarter sines of period 1/2 at the ends, a half sine of period 3/2 between (Neklutin)
    modified_trapezoid   trapezoid of acceleration with its corners rounded by sines

The last two are made of arcs that join with a jump of jerk at INNER.

Source: Norton, Design of Machinery, ch. 8; Neklutin, Mechanisms and Cams for Automatic Machines, 1969.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number, number_array
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown

PI = math.pi


def _polynomial(*coefficients: float) -> Callable[[np.ndarray], np.ndarray]:
    law = np.polynomial.Polynomial(coefficients)
    return lambda u: np.stack([law(u), law.deriv(1)(u), law.deriv(2)(u), law.deriv(3)(u)], axis=1)


def _harmonic(u: np.ndarray) -> np.ndarray:
    s, c = np.sin(PI * u), np.cos(PI * u)
    return np.stack([(1 - c) / 2, PI * s / 2, PI**2 * c / 2, -(PI**3) * s / 2], axis=1)


def _cycloidal(u: np.ndarray) -> np.ndarray:
    s, c = np.sin(2 * PI * u), np.cos(2 * PI * u)
    return np.stack([u - s / (2 * PI), 1 - c, 2 * PI * s, 4 * PI**2 * c], axis=1)


def _mirrored(first_half: Callable[[np.ndarray], np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    """A law that is point symmetric about its middle, from its first half."""

    def law(u: np.ndarray) -> np.ndarray:
        late = u > 0.5
        out = first_half(np.where(late, 1 - u, u))
        out[late] = [1, 0, 0, 0] + out[late] * [-1, 1, -1, 1]
        return out

    return law


def _modified_sine(u: np.ndarray) -> np.ndarray:
    k = 1 / (4 + PI)
    w = 4 * PI
    end = np.stack([k * (PI * u - np.sin(w * u) / 4), PI * k * (1 - np.cos(w * u)), PI * k * w * np.sin(w * u)], axis=1)
    end = np.column_stack([end, PI * k * w**2 * np.cos(w * u)])
    p = w * u / 3 - PI / 6
    a = PI * k * w
    middle = np.stack(
        [k * (2 + PI * u - 9 / 4 * np.cos(p)), PI * k * (1 + 3 * np.sin(p)), a * np.cos(p), -a * w / 3 * np.sin(p)],
        axis=1,
    )
    return np.where((u < 1 / 8)[:, None], end, middle)


def _modified_trapezoid(u: np.ndarray) -> np.ndarray:
    a, w = 8 * PI / (2 + PI), 4 * PI
    first = np.stack([(u - np.sin(w * u) / w) / w, (1 - np.cos(w * u)) / w, np.sin(w * u), w * np.cos(w * u)], axis=1)
    x = u - 1 / 8
    s1, v1 = (1 / 8 - 1 / w) / w, 1 / w
    second = np.stack([s1 + v1 * x + x**2 / 2, v1 + x, np.ones_like(u), np.zeros_like(u)], axis=1)
    x = u - 3 / 8
    s2, v2 = s1 + v1 / 4 + 1 / 32, v1 + 1 / 4
    third = np.stack(
        [s2 + v2 * x + (1 - np.cos(w * x)) / w**2, v2 + np.sin(w * x) / w, np.cos(w * x), -w * np.sin(w * x)], axis=1
    )
    return a * np.where((u < 1 / 8)[:, None], first, np.where((u < 3 / 8)[:, None], second, third))


RISES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "harmonic": _harmonic,
    "cycloidal": _cycloidal,
    "3-4-5": _polynomial(0, 0, 0, 10, -15, 6),
    "4-5-6-7": _polynomial(0, 0, 0, 0, 35, -84, 70, -20),
    "modified_sine": _mirrored(_modified_sine),
    "modified_trapezoid": _mirrored(_modified_trapezoid),
}
"""Functions by name: u (T,) to f, f', f'', f''' (T, 4)."""

INNER: dict[str, tuple[float, ...]] = {
    "modified_sine": (1 / 8, 7 / 8),
    "modified_trapezoid": (1 / 8, 3 / 8, 5 / 8, 7 / 8),
}
"""u where the arcs of a rise join; the other rises are one arc."""


TURN = 2 * math.pi
PIECES = 720
"""Quintic pieces of a whole turn, about."""
RISE_PIECES = 288
"""Number of pieces of a rise or fall, however narrow: a quintic piece of width h misses s'' by s^(6) h^4 / 1920, here
by less than 3e-9 of the peak of each law."""
LEAST_ROWS = 8


@dataclass(frozen=True, eq=False)
class Lift:
    """Lift over one turn of the cam. Made by :meth:`of` or :meth:`table`."""

    segments: tuple[tuple[float, float, str], ...] = ()
    """Width (rad), height at its end (m or rad), and rise of each segment."""
    start: float = 0.0
    """Height at cam angle 0."""
    angles: tuple[float, ...] = ()
    heights: tuple[float, ...] = ()
    """Lifts of a table."""

    @staticmethod
    def of(*segments: Sequence[Any], start: float = 0.0) -> Lift:
        """Return segments (width in rad, height at the end, rise) in turn; a dwell has the first two alone.

        The widths add up to a turn and the last height is ``start``. Raises ModelError otherwise.
        """
        start = finite_number("lift: start", start)
        rows, height = [], start
        for k, segment in enumerate(segments):
            if not isinstance(segment, list | tuple) or len(segment) not in (2, 3):
                raise ModelError(f"lift: segment {k} is {shown(segment)}; give (width, height at its end, rise)")
            width, end = (finite_number(f"lift: segment {k}", value) for value in segment[:2])
            rise = segment[2] if len(segment) == 3 else "cycloidal"
            if width <= 0:
                raise ModelError(f"lift: segment {k} has width {width:g} rad; it must be positive")
            if not isinstance(rise, str) or rise not in RISES:
                raise ModelError(f"lift: segment {k}: {no_such('rise', rise, RISES)}")
            if len(segment) == 2 and end != height:
                raise ModelError(f"lift: segment {k} ends at {end:g}, not at {height:g}; name its rise")
            rows.append((width, end, rise))
            height = end
        turn = sum(row[0] for row in rows)
        if abs(turn - TURN) > 1e-9:
            raise ModelError(f"lift: the segments add up to {math.degrees(turn):.6g} degrees, not to 360; add a dwell")
        if height != start:
            raise ModelError(f"lift: the last segment ends at {height:g}, the first begins at {start:g}; let it return")
        return Lift(segments=tuple(rows), start=start)

    @staticmethod
    def table(angles: Sequence[float] | np.ndarray, heights: Sequence[float] | np.ndarray) -> Lift:
        """Return a periodic quintic spline through heights at rising cam angles (rad).

        It takes eight rows or more within one turn.
        """
        theta, s = number_array("lift: angles", angles), number_array("lift: heights", heights)
        if theta.ndim != 1 or theta.shape != s.shape or len(theta) < LEAST_ROWS:
            raise ModelError(
                f"lift: angles {theta.shape} and heights {s.shape} must be two lists of {LEAST_ROWS} numbers or more"
            )
        if abs(theta[-1] - theta[0] - TURN) < 1e-9:
            if abs(s[-1] - s[0]) > 1e-12 * max(1.0, float(np.abs(s).max())):
                raise ModelError(f"lift: after a turn the height is {s[-1]:g}, not {s[0]:g} as at its begin")
            theta, s = theta[:-1], s[:-1]
        if not (np.diff(theta) > 0).all() or not theta[-1] - theta[0] < TURN:
            raise ModelError("lift: angles must rise within one turn; they are in rad")
        return Lift(angles=tuple(theta.tolist()), heights=tuple(s.tolist()))

    @property
    def data(self) -> dict[str, Any]:
        """Plain data, from which :meth:`from_data` makes the same lift."""
        if self.angles:
            return {"angles": list(self.angles), "heights": list(self.heights)}
        return {"segments": [list(segment) for segment in self.segments], "start": self.start}

    @staticmethod
    def from_data(data: Mapping[str, Any]) -> Lift:
        """The lift of plain data."""
        if isinstance(data, Mapping) and set(data) == {"angles", "heights"}:
            return Lift.table(data["angles"], data["heights"])
        if not isinstance(data, Mapping) or set(data) != {"segments", "start"}:
            raise ModelError(f"lift: {shown(data)} is no lift; it must hold angles and heights, or segments and start")
        segments = data["segments"]
        if not isinstance(segments, list | tuple):
            raise ModelError(f"lift: segments are {shown(segments)}; give a list of (width, height at its end, rise)")
        return Lift.of(*segments, start=data["start"])

    def __call__(self, angles: np.ndarray) -> np.ndarray:
        """(T,) cam angles (rad) to (T, 4): lift and three derivatives by the angle."""
        angles = np.atleast_1d(number_array("lift: angles", angles))
        if self.angles:
            first = self.angles[0]
            inside = first + np.mod(angles - first, TURN)
            return np.stack([self._spline(inside, order) for order in range(4)], axis=1)
        inside = np.mod(angles, TURN)
        edges = self.edges
        segment = np.clip(np.searchsorted(edges, inside, side="right") - 1, 0, len(self.segments) - 1)
        out = np.zeros((len(angles), 4))
        for k in range(len(self.segments)):
            mine = segment == k
            out[mine] = self._within(k, inside[mine])
        return out

    @property
    def edges(self) -> np.ndarray:
        """Cam angles (rad) where segments begin, and the last ends; of a table one turn."""
        if self.angles:
            return np.array([self.angles[0], self.angles[0] + TURN])
        return np.concatenate([[0.0], np.cumsum([segment[0] for segment in self.segments])])

    def pieces(self) -> tuple[np.ndarray, np.ndarray]:
        """Breaks (p + 1,) over one turn, and (p, 2, 4) lift and derivatives at both ends of each piece.

        Both ends belong to the same segment, so that a jump of acceleration between segments stays a jump. Nodes stand
        where the arcs of a rise join, and at the rows of a table.
        """
        breaks, ends = [], []
        edges = self.edges
        for k, (a, b) in enumerate(pairwise(edges)):
            nodes = self._nodes(k, a, b)
            values = self(nodes) if self.angles else self._within(k, nodes)
            if self.angles:
                values[-1] = values[0]
            breaks.append(nodes[:-1])
            ends.append(np.stack([values[:-1], values[1:]], axis=1))
        return np.append(np.concatenate(breaks), edges[-1]), np.concatenate(ends)

    def _nodes(self, k: int, a: float, b: float) -> np.ndarray:
        """Return cam angles from a to b that cut segment k, or a table, into pieces.

        Arcs that join within it are nodes.
        """
        if self.angles:
            arcs, count = np.append(self.angles, b), PIECES
        else:
            _, end, rise = self.segments[k]
            moves = end != (self.segments[k - 1][1] if k else self.start)
            arcs = a + (b - a) * np.array([0.0, *(INNER.get(rise, ()) if moves else ()), 1.0])
            count = max(RISE_PIECES if moves else 8, math.ceil(PIECES * (b - a) / TURN))
        parts = np.maximum(1, np.ceil(count * np.diff(arcs) / (b - a) * (1 - 1e-12))).astype(int)
        inner = [np.linspace(c, d, n, endpoint=False) for (c, d), n in zip(pairwise(arcs), parts, strict=True)]
        return np.append(np.concatenate(inner), b)

    def _within(self, k: int, angles: np.ndarray) -> np.ndarray:
        width, end, rise = self.segments[k]
        begin = self.segments[k - 1][1] if k else self.start
        u = np.clip((angles - self.edges[k]) / width, 0.0, 1.0)
        out = (end - begin) * RISES[rise](u) / width ** np.arange(4)
        out[:, 0] += begin
        return out

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import make_interp_spline

        theta = np.array([*self.angles, self.angles[0] + TURN])
        return make_interp_spline(theta, np.array([*self.heights, self.heights[0]]), k=5, bc_type="periodic")
