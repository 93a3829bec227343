"""Gas in cylinders along a motion: crank angles, impossible volumes, changes of phase."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.reactions import marker_axes, marker_places
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.warning import warn
from mbsd.model.force import Chamber
from mbsd.model.laws.numbers import hermite_coefficients

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

NEAR = 1e-9
"""rad: how far beside a change of phase the motion is looked at."""
SAME = 1e-6
"""Part of a cycle by which a motion may miss a whole number of cycles."""
MOST = 100
"""Periods of the drivers after which cycles are looked for."""
ASTRAY = 0.01
"""Part of its stroke by which a piston may be elsewhere than its crank and rod would have it."""
ROUNDS, HALVINGS = 4, 40


@dataclass(frozen=True)
class Placed:
    """A chamber of a packed mechanism."""

    name: str
    chamber: Chamber
    i: int
    j: int
    """Numbers of its markers."""
    frame: int
    crank: int
    """Columns of the angles of the cylinder's body and of the crank, -1 without a cycle."""

    def angle(self, state: np.ndarray) -> np.ndarray:
        """Return (T,) of q, v or a (T, 3 nb): the crank's turn since it fired, in its direction, or its rates."""
        assert self.chamber.cycle is not None
        return self.chamber.cycle.sense * (state[:, self.crank] - state[:, self.frame])

    def since(self, q: np.ndarray) -> np.ndarray:
        """Return (T,) angle of the crank since a firing (rad)."""
        assert self.chamber.cycle is not None
        return self.angle(q) - self.chamber.cycle.sense * self.chamber.cycle.fires_at


def chambers(packed: Packed) -> Iterator[Placed]:
    """Return the chambers of all forces, in their order. Raises ModelError where a cylinder is unknown."""
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.chamber is not None:
            chamber = force.kind.chamber(force, packed.masses)
            cycle = chamber.cycle
            crank = -1 if cycle is None else 3 * packed.body_names.index(cycle.crank) + 2
            frame = 3 * int(packed.system.marker_body[i]) + 2
            yield Placed(force.name, chamber, int(i), int(j), frame, crank)


def check_pistons(packed: Packed, t: np.ndarray, q: np.ndarray, tell: bool = True) -> None:
    """Raise ModelError where a piston leaves its gas no room along poses q (T, 3 nb).

    Where ``tell`` says so, warn of a piston that is elsewhere than crank and rod of its cycle have it, since heat is
    released there.
    """
    for placed in chambers(packed):
        cycle, shift = placed.chamber.cycle, placed.chamber.shift
        if cycle is not None and cycle.height is None:
            continue  # its pressure asks for no volume
        height = _height(packed, placed, q)
        k = int(height.argmin())
        if not height[k] > 0.0:
            raise ModelError(
                f"{packed.name}: force '{placed.name}': at t = {t[k]:.6g} s the piston lies {height[k] - shift:.6g} m "
                f"along its cylinder and leaves its gas no room: the volume would be "
                f"{placed.chamber.area * height[k]:.3g} m^3. Move the markers apart, or increase its clearance"
            )
        if not tell or cycle is None or cycle.height is None or not cycle.burns:
            continue
        since = placed.since(q)
        off = height - cycle.height(since)
        k = int(np.abs(off).argmax())
        if abs(off[k]) > ASTRAY * cycle.displaced / placed.chamber.area:
            warn(
                f"{packed.name}: force '{placed.name}': at t = {t[k]:.6g} s, with the crank "
                f"{math.degrees(since[k]):.4g} degrees past its firing, the piston lies {height[k] - shift:.6g} m "
                f"along its cylinder; stroke, rod, offset, fires_at and top have it at "
                f"{height[k] - off[k] - shift:.6g} m. Correct them",
                ModelWarning,
            )


def _height(packed: Packed, placed: Placed, q: np.ndarray) -> np.ndarray:
    """Return (T,) of the gas (m)."""
    place = marker_places(packed, q, placed.j) - marker_places(packed, q, placed.i)
    return (marker_axes(packed, q, placed.i) * place).sum(axis=1) + placed.chamber.shift


def whole_cycles(packed: Packed, first: np.ndarray, last: np.ndarray) -> int:
    """Return how often a motion repeats until all gas is where its cycle began; 1 without gas.

    The motion is between two poses (3 nb,).
    """
    times = 1
    for placed in chambers(packed):
        if placed.chamber.cycle is not None:
            turned = float(placed.angle(last[None])[0] - placed.angle(first[None])[0]) / placed.chamber.cycle.period
            ratio = Fraction(turned).limit_denominator(MOST)
            if ratio and abs(turned - float(ratio)) <= SAME:
                times = math.lcm(times, ratio.denominator)
    return times if times <= MOST else 1


def phase_changes(
    packed: Packed,
    t: np.ndarray,
    states: tuple[np.ndarray, np.ndarray, np.ndarray],
    motion: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
) -> list[tuple[float, float, str]]:
    """Return changes of phase of pressures: right before (s), right after (s), and the force's name.

    ``states``: q, v, a (T, 3 nb) at times t (T,); ``motion`` gives q, v at other rising times.
    """
    out: list[tuple[float, float, str]] = []
    for placed in chambers(packed):
        cycle = placed.chamber.cycle
        if cycle is None or not cycle.changes:
            continue
        angle = placed.since(states[0])
        step, wanted = _passed(angle, cycle.changes, cycle.period)
        if not len(step):
            continue
        h = np.diff(t)[step]
        samples = np.stack([angle, placed.angle(states[1]), placed.angle(states[2])], axis=-1)
        quintics = hermite_coefficients(h, samples[step], samples[step + 1])
        low, high, way = np.zeros(len(step)), h.copy(), np.sign(angle[step + 1] - angle[step])
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            before = way * ((quintics * middle[:, None] ** np.arange(6)).sum(axis=1) - wanted) < 0.0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        times = t[step] + low
        rate = np.ones(len(times))
        for _ in range(ROUNDS):
            order = np.argsort(times, kind="stable")
            at, inverse = np.unique(times[order], return_inverse=True)
            q, v = motion(at)
            gap, rates = placed.since(q), placed.angle(v)
            back = np.empty(len(times), int)
            back[order] = inverse
            miss, rate = gap[back] - wanted, rates[back]
            moved = np.divide(miss, rate, out=np.zeros_like(miss), where=rate != 0.0)
            times = np.clip(times - moved, t[step], t[step + 1])
            if np.abs(miss).max() < 1e-2 * NEAR:
                break
        near = NEAR / np.maximum(np.abs(rate), 1e-300)
        room = (near < 0.1 * h) & (times - near > t[0]) & (times + near < t[-1])
        out += [(float(a - b), float(a + b), placed.name) for a, b in zip(times[room], near[room], strict=True)]
    return sorted(out)


def _passed(angle: np.ndarray, changes: tuple[float, ...], period: float) -> tuple[np.ndarray, np.ndarray]:
    """Return steps of an angle (T,) that pass a change, and at which angle."""
    steps, wanted = [], []
    low, high = np.minimum(angle[:-1], angle[1:]), np.maximum(angle[:-1], angle[1:])
    for change in changes:
        first, last = np.ceil((low - change) / period), np.ceil((high - change) / period)
        for k in np.flatnonzero(last > first):
            for turn in range(int(first[k]), int(last[k])):
                steps.append(k)
                wanted.append(change + turn * period)
    return np.array(steps, int), np.array(wanted)
