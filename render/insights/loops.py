"""Four-bars and slider-cranks in a motion: transmission angles, dead points, and marks of moments."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from render.magnitudes import crank_of
from shared.contract import Motion

# Transmission angle and dead points of four-bars and slider-cranks, from where their pins are.
#
#     four-bar        pins A B C D round the loop; mu: angle at C between coupler and follower
#     slider-crank    mu: angle at C between the rod and the normal of the guide
#     dead points     A, B, C in one line: the follower turns back there, and could not drive the crank from there
#
# mu near 90 degrees passes the force on best; 40 degrees is a usual limit (VDI 2123, VDI 2126).

LEAST = np.radians(40.0)
"""Transmission angle that is usually asked for."""


ON_LINE = 1e-9
"""Fraction of the largest: below it pins A, B, C are in line."""


@dataclass(frozen=True)
class Loop:
    """A crank, the coupler and what it moves, all held by ground."""

    crank: str
    coupler: str
    follower: str
    slides: bool
    """True if the follower slides."""
    pins: np.ndarray
    """(T, 4, 2) A B C D (m); of a slider-crank D is C moved along the guide's normal."""
    angle: np.ndarray
    """(T,) of the crank, from A to B (rad), without jumps."""

    @property
    def transmission(self) -> np.ndarray:
        """(T,) mu (rad), 0 .. pi/2."""
        b, c, d = (self.pins[:, k] for k in (1, 2, 3))
        along, across = b - c, d - c
        cosine = (along * across).sum(axis=1) / np.maximum(np.hypot(*along.T) * np.hypot(*across.T), 1e-300)
        return np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))

    def dead_points(self, time: np.ndarray) -> list[tuple[float, float]]:
        """Return the time (s) and crank angle (rad, 0 .. 2 pi) of each dead point.

        One on the seam of a period counts once, at its start.
        """
        a, b, c = (self.pins[:, k] for k in (0, 1, 2))
        first, second = b - a, c - b
        turn = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        turn = np.where(np.abs(turn) > ON_LINE * np.abs(turn).max(), turn, 0.0)
        out: list[tuple[float, float]] = []
        beside = np.flatnonzero(turn)
        for k, after in pairwise(beside):
            if (turn[k] > 0) == (turn[after] > 0):
                continue
            part = turn[k] / (turn[k] - turn[after])
            if after > k + 1:  # rows on the line itself
                part = float(time[(k + after) // 2] - time[k]) / float(time[after] - time[k])
            at = time[k] + part * (time[after] - time[k])
            angle = self.angle[k] + part * (self.angle[after] - self.angle[k])
            out.append((float(at), float(angle % (2 * np.pi))))
        repeats = np.abs(self.pins[0] - self.pins[-1]).max() < ON_LINE * np.ptp(self.pins)
        if repeats and turn[0] == 0.0 and len(beside) and (turn[beside[0]] > 0) != (turn[beside[-1]] > 0):
            out.insert(0, (float(time[0]), float(self.angle[0] % (2 * np.pi))))
        return out

    @property
    def travel(self) -> float:
        """Travel of the follower: the angle it swings through (rad), or its stroke (m)."""
        c, d = self.pins[:, 2], self.pins[:, 3]
        if self.slides:
            normal = (d - c)[0] / np.hypot(*(d - c)[0])
            return float(np.ptp(c @ np.array([normal[1], -normal[0]])))
        return float(np.ptp(np.unwrap(np.arctan2(*(c - d).T[::-1]))))

    @property
    def lengths(self) -> tuple[float, float, float, float]:
        """Crank, coupler, follower and ground of a four-bar (m)."""
        ends = ((0, 1), (1, 2), (2, 3), (3, 0))
        crank, coupler, follower, ground = (float(np.hypot(*(self.pins[0, j] - self.pins[0, i]))) for i, j in ends)
        return crank, coupler, follower, ground

    @property
    def longest_crank(self) -> tuple[float, str]:
        """Return the length up to which the crank turns round (m), and its end: ``""``, ``_folded``, ``_slides``.

        The others would be stretched into one line there, folded, or the coupler square to the guide (Grashof). It is
        infinite where the crank is longer than the ground between its pins: there it is no crank but a drag link.
        """
        a, b, c, d = self.lengths
        if self.slides:
            place, normal = self.pins[0, 0] - self.pins[0, 2], self.pins[0, 3] - self.pins[0, 2]
            return b - abs(float(place @ normal)) / float(np.hypot(*normal)), "_slides"
        if a > d:
            return float("inf"), ""
        stretched, folded = b + c - d, d - abs(b - c)
        return (stretched, "") if stretched <= folded else (folded, "_folded")


def loops(motion: Motion) -> list[Loop]:
    """Return all loops of a mechanism whose crank a driver or forces turn round and round.

    It turns against ground.
    """
    out = []
    pins: dict[frozenset[str], np.ndarray] = {}
    for joint in motion.joints.values():
        if joint.pair == "pin":
            pins.setdefault(frozenset(joint.bodies), np.array([joint.x, joint.y]).T)
    guides = {frozenset(joint.bodies) for joint in motion.joints.values() if joint.pair == "guide"}
    for crank in _driven(motion) or _turning(motion):
        a = pins.get(frozenset(("ground", crank)))
        for pair, b in pins.items():
            if a is None or crank not in pair or "ground" in pair:
                continue
            [coupler] = pair - {crank}
            for other, c in pins.items():
                if coupler not in other or crank in other or "ground" in other:
                    continue
                [follower] = other - {coupler}
                held = frozenset(("ground", follower))
                if held in pins:
                    out.append(_loop(crank, coupler, follower, False, (a, b, c, pins[held])))
                elif held in guides:
                    out.append(_loop(crank, coupler, follower, True, (a, b, c, c + _normal(c))))
    return out


def _driven(motion: Motion) -> list[str]:
    """Return bodies that a driver turns against ground.

    In files that do not tell, they are those whose angle is the driver's.
    """
    out = []
    for driver in motion.drivers.values():
        if driver.unit != "rad":
            continue
        if driver.bodies is not None:
            out += [body for body in driver.bodies if body != "ground" and "ground" in driver.bodies]
            continue
        value = np.array(driver.value)
        out += [n for n, body in motion.bodies.items() if np.ptp(np.array(body.theta) - value) < 1e-6 < np.ptp(value)]
    return out


def _turning(motion: Motion) -> list[str]:
    """Return the crank of a motion that forces make."""
    crank = crank_of(motion) if motion.analysis == "simulation" else None
    return [] if crank is None else [crank.body]


def _normal(c: np.ndarray) -> np.ndarray:
    """Return (2,) unit normal of the way that a slider goes on ground."""
    middle = c - c.mean(axis=0)
    along = np.linalg.svd(middle, full_matrices=False)[2][0]
    return np.array([-along[1], along[0]])


def _loop(
    crank: str, coupler: str, follower: str, slides: bool, pins: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
) -> Loop:
    arm = pins[1] - pins[0]
    return Loop(crank, coupler, follower, slides, np.stack(pins, axis=1), np.unwrap(np.arctan2(*arm.T[::-1])))


# Events at one moment of a motion: dead points, impacts and others. Plots and the page mark them, the report
# lists them.

STEP = 1e-6
"""Fraction of the motion: times that are nearer are one."""
FEW = 6
"""Dead points at most; of a crank that turns and turns they would say nothing."""


def marks(motion: Motion) -> list[tuple[float, str]]:
    """Return times (s) and words in order: dead points of driven cranks, and all events but the end."""
    time = np.asarray(motion.time)
    moments = [(at, f"{loop.follower} turns back") for loop in loops(motion) for at, _ in loop.dead_points(time)]
    if motion.period:  # what is at the start of a period is at its end
        close = STEP * (time[-1] - time[0])
        ends = (time[0], time[-1])
        moments += [
            (other, words) for at, words in moments for end, other in (ends, ends[::-1]) if abs(at - end) < close
        ]
    moments = moments if len(moments) <= FEW else []
    moments += [(event.time, f"{event.name}: {event.what}") for event in motion.events if event.what != "end"]
    return sorted(set(moments))
