"""Closed forms of cranks and dyads, in numpy: they owe nothing to the solver, and cannot leave their branch.

A dyad's pin C lies where two circles, or a circle and a line, meet, on the side s = +-1 that it has at the start. A
motion that stays assembled keeps s as long as the root's argument, the discriminant, is positive; where it falls below
zero the motion does not exist. So the branch is decided by a sign, not by a march, and is exact at any step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd.results.solution import Solution

Poses = dict[str, np.ndarray]
"""(T, 3) x, y, theta of each body's frame."""
Point = tuple[str, float, float]
"""A body and a place in its frame (m)."""
Law = Callable[[np.ndarray], np.ndarray]
"""(T,) times to (T, 3)."""


def place(poses: Poses, point: Point) -> np.ndarray:
    """(T,) complex place of a point."""
    body, x, y = point
    pose = poses[body]
    return pose[:, 0] + 1j * pose[:, 1] + (x + 1j * y) * np.exp(1j * pose[:, 2])


def as_pose(origin: Any, angle: np.ndarray) -> np.ndarray:
    """(T, 3)."""
    return np.stack([origin.real, origin.imag, angle], axis=1)


@dataclass(frozen=True)
class Crank:
    """A body pinned at a point and turned by angles (absolute), drive k."""

    name: str
    at: Point
    drive: int

    def add(self, poses: Poses, drives: np.ndarray) -> np.ndarray:
        """Enter its pose; (T,) discriminant in its own measure, here always 1."""
        poses[self.name] = as_pose(place(poses, self.at), drives[:, self.drive])
        return np.ones(len(drives))


@dataclass(frozen=True)
class Bars:
    """Two bars from points A and B to a common pin C; C is on the ``side`` (+-1) left of the way from A to B."""

    names: tuple[str, str]
    a: Point
    b: Point
    lengths: tuple[float, float]
    side: float

    def add(self, poses: Poses, drives: np.ndarray) -> np.ndarray:
        """Enter both poses; discriminant (h / shorter bar)^2, h the height of the triangle over AB."""
        first, second = place(poses, self.a), place(poses, self.b)
        l1, l2 = self.lengths
        line = second - first
        d = np.abs(line)
        gaps = (l1 + l2 - d) * (d - abs(l1 - l2)) * (d + abs(l1 - l2)) * (l1 + l2 + d)
        h = np.sqrt(np.clip(gaps, 0.0, None)) / (2 * d)
        along = (l1**2 - l2**2 + d**2) / (2 * d)
        turned = np.unwrap(np.angle(line))  # the angles at A and B stay within 0 .. pi, so turns are counted right
        poses[self.names[0]] = as_pose(first, turned + self.side * np.arctan2(h, along))
        poses[self.names[1]] = as_pose(second, turned + self.side * np.arctan2(h, along - d))
        return gaps / (2 * d * min(l1, l2)) ** 2


@dataclass(frozen=True)
class RodAndSlider:
    """A rod from A to a block's origin on a line through a point, at an angle there, on the ``side`` along it."""

    rod: str
    slider: str
    a: Point
    line: Point
    angle: float
    length: float
    side: float

    def add(self, poses: Poses, drives: np.ndarray) -> np.ndarray:
        """Enter both poses; discriminant 1 - (distance of A from the line / length)^2."""
        first, base = place(poses, self.a), place(poses, self.line)
        turned = poses[self.line[0]][:, 2] + self.angle
        unit = np.exp(1j * turned)
        local = (first - base) / unit
        off = local.imag
        root = np.sqrt(np.clip((self.length - off) * (self.length + off), 0.0, None))
        end = base + (local.real + self.side * root) * unit
        lean = np.arctan2(-off, root) if self.side > 0 else math.pi + np.arctan2(off, root)
        poses[self.rod] = as_pose(first, turned + lean)
        poses[self.slider] = as_pose(end, turned)
        return 1.0 - (off / self.length) ** 2


@dataclass
class ClosedForm:
    """Groups in the order in which they are solved."""

    groups: list[Crank | Bars | RodAndSlider] = field(default_factory=list)

    def poses(self, drives: np.ndarray) -> tuple[Poses, np.ndarray]:
        """From (T, k) driven angles: poses of all bodies, and (T,) the least discriminant of all groups."""
        poses: Poses = {"ground": np.zeros((len(drives), 3))}
        least = np.ones(len(drives))
        for group in self.groups:
            least = np.minimum(least, group.add(poses, drives))
        return poses, least

    def reach(self, laws: list[Law], duration: float) -> float:
        """Least discriminant over the whole motion, from 4096 instants, refined about the least."""
        times, worst = np.linspace(0.0, duration, 4097), 1.0
        for _ in range(4):
            with np.errstate(all="ignore"):
                least = self.poses(np.stack([law(times)[:, 0] for law in laws], axis=1))[1]
            k = int(np.argmin(least))
            span = times[min(k + 1, len(times) - 1)] - times[max(k - 1, 0)]
            worst = float(least[k])
            times = np.clip(np.linspace(times[k] - span, times[k] + span, 257), 0.0, duration)
        return worst

    def truth(
        self, drivers: list[str], laws: list[Law], duration: float, slack: float = 1e-8
    ) -> Callable[[Solution], list[str]]:
        """The judge of a solution: where a body stands elsewhere, by how much and when.

        Turns are counted along a fine march from the start, so that a solution of few outputs is judged as well.
        """

        def judge(sol: Solution) -> list[str]:
            times = np.union1d(sol.t, np.linspace(0.0, duration, 721))
            drives = np.stack([law(times)[:, 0] for law in laws], axis=1)
            here = np.searchsorted(times, sol.t)
            drives[here] = np.stack([sol.driver(name).value for name in drivers], axis=1)
            with np.errstate(all="ignore"):
                poses, least = self.poses(drives)
            if least[here].min() < -1e-14:
                return [f"closed form: no such pose at t = {sol.t[int(np.argmin(least[here]))]:.6g} s"]
            bound = slack * (1.0 + 1e-3 / np.sqrt(np.clip(least[here], 1e-16, None)))
            out = []
            for name, pose in poses.items():
                if name == "ground" or name not in sol.packed.body_names:  # the pin of a slot is no body
                    continue
                view, exact = sol.body(name), pose[here]
                far = np.hypot(view.x - exact[:, 0], view.y - exact[:, 1]) / sol.packed.size
                turn = view.theta - exact[:, 2]
                turn -= 2 * math.pi * np.round(turn[0] / (2 * math.pi))
                worst = np.maximum(far, np.abs(turn)) / bound
                k = int(np.argmax(np.where(np.isfinite(worst), worst, np.inf)))
                if not worst[k] < 1.0:
                    out.append(
                        f"closed form: '{name}' is {far[k] * sol.packed.size:.3g} m and {abs(turn[k]):.3g} rad off at "
                        f"t = {sol.t[k]:.6g} s"
                    )
            return out

        return judge
