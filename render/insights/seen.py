"""A motion as insights see it: series as arrays, its input, its outputs, angles of the crank, stretches of time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render.insights.insight import Amount, Insight, Named, Value
from render.magnitudes import Centre, centre_of_mass, driven_bodies, floors, length_scale
from shared.contract import Motion

Array = NDArray[Any]
EVEN = 1e-6
"""A crank whose speed varies by less than this part of it turns evenly."""
TURN = 2 * math.pi


@dataclass(frozen=True)
class Output:
    """Body that ground holds by a pin or a guide, and its coordinate there."""

    body: str
    slides: bool
    value: Array
    """(T,) m along the guide, or rad."""
    rate: Array

    @property
    def travel(self) -> float:
        """Range of the coordinate (m or rad)."""
        return float(np.ptp(self.value))

    @property
    def unit(self) -> str:
        """Unit of the travel in sentences."""
        return "m" if self.slides else "deg"


@dataclass(frozen=True)
class Input:
    """What moves the mechanism: the only driver, or the crank that forces turn."""

    name: str
    body: str
    value: Array
    """(T,) rad or m, counted upwards in the direction of the motion if it is a crank."""
    rate: Array
    turns: int
    """Whole turns of a crank; 0 of what swings or slides."""
    unit: str

    @property
    def is_even(self) -> bool:
        """True if it turns at one rate."""
        return self.turns > 0 and float(np.ptp(self.rate)) < EVEN * float(np.abs(self.rate).max())


class Seen:
    """Motion with what several insights ask of it."""

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self.time = np.asarray(motion.time)
        self.span = float(self.time[-1] - self.time[0])
        self.floors = floors(motion)
        self.size = length_scale(motion)

    @cached_property
    def centres(self) -> dict[str, Centre]:
        """Motions of the centres of mass."""
        return {name: centre_of_mass(body) for name, body in self.motion.bodies.items()}

    @cached_property
    def theta(self) -> dict[str, Array]:
        """Angles of bodies, (T,) rad."""
        return {name: np.asarray(body.theta) for name, body in self.motion.bodies.items()}

    @cached_property
    def omega(self) -> dict[str, Array]:
        """Angular velocities of bodies, (T,) rad/s."""
        return {name: np.asarray(body.omega) for name, body in self.motion.bodies.items()}

    @cached_property
    def repeats(self) -> bool:
        """True if the motion has a period."""
        return self.motion.period is not None

    @cached_property
    def pinned(self) -> set[str]:
        """Bodies that a pin holds on ground."""
        return self._held("pin")

    @cached_property
    def guided(self) -> set[str]:
        """Bodies that a guide holds on ground, or a slot while they do not turn."""
        slots = {body for body in self._held("slot") if np.ptp(self.theta[body]) < self.floors["rad"]}
        return self._held("guide") | slots

    def _held(self, pair: str) -> set[str]:
        joints = [joint for joint in self.motion.joints.values() if joint.pair == pair and "ground" in joint.bodies]
        return {body for joint in joints for body in joint.bodies if body != "ground"}

    @cached_property
    def outputs(self) -> list[Output]:
        """Moving bodies that ground holds by one coordinate, the input left out."""
        out = []
        own = self.input.body if self.input else ""
        for name in self.motion.bodies:
            if name == own:
                continue
            if name in self.guided and np.ptp(self.theta[name]) < self.floors["rad"]:
                value, rate = self._along(name)
                out.append(Output(name, True, value, rate))
            elif name in self.pinned:
                out.append(Output(name, False, self.theta[name], self.omega[name]))
            elif name in self.level and self._is_straight(name):
                value, rate = self._along(name)
                out.append(Output(name, True, value, rate))
        return [output for output in out if output.travel > self.floors["m" if output.slides else "rad"]]

    @cached_property
    def level(self) -> list[str]:
        """Bodies that never turn, though neither guides nor locks keep them from it; of a guide's two the heavier."""
        kept, joints = {"ground"}, self.motion.joints.values()
        locks = [joint.bodies for joint in joints
                 if joint.pair == "guide" or not (joint.pair or any(joint.fx) or any(joint.fy))]  # fmt: skip
        locks += [driver.bodies for driver in self.motion.drivers.values() if driver.bodies and driver.unit == "rad"]
        while more := {body for pair in locks if set(pair) & kept for body in pair} - kept:
            kept |= more
        still = [name for name in self.motion.bodies if name not in kept and np.ptp(self.theta[name]) < 1e-7
                 and sum(name in joint.bodies for joint in joints if joint.pair) > 1]  # fmt: skip
        lighter = {min(pair, key=lambda each: self.motion.bodies[each].mass)
                   for pair in locks if set(pair) <= set(still)}  # fmt: skip
        return [name for name in still if name not in lighter]

    def _is_straight(self, body: str) -> bool:
        """Return True if a body's centre of mass runs along a line."""
        centre = self.centres[body]
        way = np.stack([centre.x, centre.y], axis=1)
        spread = np.linalg.svd(way - way.mean(axis=0), compute_uv=False)
        return bool(spread[1] < 1e-6 * spread[0])

    def _along(self, body: str) -> tuple[Array, Array]:
        """Return the coordinate of a body that does not turn along its main direction, and its rate."""
        centre = self.centres[body]
        way = np.stack([centre.x, centre.y], axis=1)
        along = np.linalg.svd(way - way.mean(axis=0), full_matrices=False)[2][0]
        along = along * (1.0 if along[np.abs(along).argmax()] > 0 else -1.0)
        return way @ along, np.stack([centre.vx, centre.vy], axis=1) @ along

    @cached_property
    def input(self) -> Input | None:
        """What moves the mechanism; None of one that is let go, or has several drivers that move."""
        moving = {name: driver for name, driver in self.motion.drivers.items() if np.ptp(driver.value) > 1e-9}
        if len(moving) == 1:
            ((name, driver),) = moving.items()
            value = np.asarray(driver.value)
            bodies = [body for body in driver.bodies or () if body != "ground"]
            if driver.bodies is None:  # files of version 1 do not say
                bodies = [body for body in self.motion.bodies if np.ptp(self.theta[body] - value) < 1e-6]
            if not bodies:
                return None
            body = bodies[-1]
            rate = self.omega[body] if driver.unit == "rad" and len(bodies) == 1 else np.gradient(
                value, np.maximum.accumulate(self.time + 1e-12 * np.arange(len(self.time)))
            )  # fmt: skip
            return self._input(name, body, value, rate, driver.unit)
        if not moving and not driven_bodies(self.motion):
            for name in self.motion.bodies:
                if name in self.pinned and abs(self.theta[name][-1] - self.theta[name][0]) > 3 * TURN:
                    return self._input(name, name, self.theta[name], self.omega[name], "rad")
        return None

    def _input(self, name: str, body: str, value: Array, rate: Array, unit: str) -> Input:
        steps = np.diff(value)
        one_way = bool((steps >= -1e-12).all() or (steps <= 1e-12).all())
        turns = int(abs(value[-1] - value[0]) / TURN + 1e-6) if unit == "rad" and one_way else 0
        sign = -1.0 if turns and value[-1] < value[0] else 1.0
        return Input(name, body, sign * value, sign * rate, turns, unit)

    def window(self) -> slice:
        """Return the rows of one turn of an even crank, of anything else all."""
        if self.input is None or not self.input.turns:
            return slice(None)
        angle = self.input.value - self.input.value[0]
        return slice(0, int(np.searchsorted(angle, TURN - 1e-6)) + 1)

    def angle_at(self, time: float) -> float:
        """Return the angle of the crank (rad, 0 .. 2 pi) at a time."""
        assert self.input is not None
        sign = 1.0 if self.theta_sign > 0 else -1.0
        angle = sign * float(np.interp(time, self.time, self.input.value)) % TURN
        return 0.0 if TURN - angle < 1e-6 else angle

    def moment(self, time: float) -> Amount:
        """Return a time in a sentence: the angle of an even crank of one turn, else the time."""
        if self.input is not None and self.input.turns == 1:
            return Amount(self.angle_at(time), "place")
        return Amount(float(time), "s")

    @property
    def span_words(self) -> str:
        """Key of words for the time that a share is of: every turn, every cycle, or all the time."""
        if self.input is not None and self.input.turns == 1 and self.repeats:
            return "every turn"
        return "every cycle" if self.repeats else "the time"

    @cached_property
    def theta_sign(self) -> float:
        """Sign of the crank's turning."""
        driver = self.motion.drivers.get(self.input.name) if self.input else None
        value = driver.value if driver else self.theta[self.input.body] if self.input else [0.0, 1.0]
        return 1.0 if value[-1] >= value[0] else -1.0

    def at(self, row: int) -> tuple[float, float]:
        """Return the time of a row as start and end of a moment (s)."""
        return float(self.time[row]), float(self.time[row])

    def share(self, mask: Array) -> float:
        """Return the part of the time in which both ends of a step are true."""
        steps = np.diff(self.time)
        return float(steps[mask[:-1] & mask[1:]].sum()) / self.span

    def stretches(self, mask: Array) -> Iterator[tuple[float, float]]:
        """Yield start and end (s) of the times in which a mask is true, longest first.

        One over the seam of a period ends after the motion's end.
        """
        padded = np.concatenate([[False], mask, [False]]).astype(int)
        starts, ends = np.flatnonzero(np.diff(padded) == 1), np.flatnonzero(np.diff(padded) == -1) - 1
        rows = [(float(self.time[a]), float(self.time[b])) for a, b in zip(starts, ends, strict=True)]
        if self.repeats and len(rows) > 1 and mask[0] and mask[-1]:
            rows = [*rows[1:-1], (rows[-1][0], rows[0][1] + self.span)]
        yield from sorted(rows, key=lambda row: row[0] - row[1])

    def crossings(self, values: Array, rows: slice = slice(None)) -> list[tuple[float, int]]:
        """Return times at which a series changes its sign, and the sign (1, -1) that it has from there on."""
        v, t = values[rows], self.time[rows]
        floor = 1e-9 * float(np.abs(v).max(initial=0.0))
        clear = np.flatnonzero(np.abs(v) > floor)
        out = []
        for a, b in pairwise(clear):
            if (v[a] > 0) != (v[b] > 0):
                part = v[a] / (v[a] - v[b]) if b == a + 1 else 0.5
                out.append((float(t[a] + part * (t[b] - t[a])), 1 if v[b] > 0 else -1))
        if self.repeats and len(clear) > 1 and (v[clear[0]] > 0) != (v[clear[-1]] > 0):
            a, b = clear[-1], clear[0]  # over the seam
            before, after = t[a] - t[-1], t[b] - t[0]
            zero = before + (after - before) * v[a] / (v[a] - v[b])
            out.append((float(t[0] + zero if zero >= 0 else t[-1] + zero), 1 if v[b] > 0 else -1))
        return sorted(out)

    def without_noise(self, value: float, unit: str) -> float:
        """Return a value, or 0 where it is rounding."""
        return 0.0 if abs(value) <= self.floors.get(unit, 0.0) else value


def insight(
    kind: str, number: float | np.floating[Any], unit: str, when: tuple[float, float], strength: float,
    template: str = "", *, bodies: tuple[str, ...] = (), joints: tuple[str, ...] = (), **values: Value,
) -> Insight:  # fmt: skip
    """Return an insight whose strength is held within 0 .. 1; its sentence is that of its kind without a template."""
    said: Mapping[str, Value] = values
    return Insight(
        kind, float(number), unit, float(when[0]), float(when[1]), bodies, joints, min(max(float(strength), 0.0), 1.0),
        template or kind, said,
    )  # fmt: skip


def body(*names: str) -> Named:
    """Return bodies as a sentence names them."""
    return Named("body", names)


def joint(*names: str) -> Named:
    """Return joints as a sentence names them."""
    return Named("joint", names)


def point(*names: str) -> Named:
    """Return points as a sentence names them."""
    return Named("point", names)


def load(*names: str) -> Named:
    """Return drivers, forces and contacts as a sentence names them."""
    return Named("load", names)


def amount(value: float | np.floating[Any], unit: str, digits: int = 3) -> Amount:
    """Return a number with its unit in a sentence."""
    return Amount(float(value), unit, digits)
