"""Driven cranks with dyads on them: four-bars to eight-bars, five-bars; all in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np

from mbsd import Mechanism, constant_rate
from mbsd.model.laws import Motion
from mbsd.results.solution import Solution
from tools.random_mechanisms.laws import Drive, swinging, turning
from tools.random_mechanisms.subject import Subject, family

# Closed forms of cranks and dyads, in numpy: they owe nothing to the solver, and cannot leave their branch.
#
# A dyad's pin C lies where two circles, or a circle and a line, meet, on the side s = +-1 that it has at the start. A
# motion that stays assembled keeps s as long as the root's argument, the discriminant, is positive; where it falls
# below zero the motion does not exist. So the branch is decided by a sign, not by a march, and is exact at any step.


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
    """Two bars from points A and B to a common pin C.

    C is on the ``side`` (+-1) left of the way from A to B.
    """

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
    """A rod from A to a block on a line through a point, at an angle there, on the ``side`` along it."""

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


ROOMY = 1e-3
"""A discriminant above this leaves no doubt that a random motion exists; below its negative, none that it does not."""


class Built:
    """A mechanism and its closed form, added to group by group."""

    def __init__(self, name: str, rng: np.random.Generator) -> None:
        self.m = Mechanism(name)
        self.rng, self.form = rng, ClosedForm()
        self.laws: list[Motion] = []
        self.duration = self.turn = 1.0
        self.light = rng.random() < 0.15  # some bodies without mass

    def body(self, name: str, length: float) -> None:
        """A bar with random mass, or without."""
        rng = self.rng
        mass = 0.0 if self.light and rng.random() < 0.5 else float(rng.uniform(0.2, 3.0))
        com = (float(rng.uniform(-0.2, 1.2) * length), float(rng.normal(scale=0.2) * length))
        self.m.bar(name, length, mass, com, mass * length**2 * float(rng.uniform(0.02, 0.3)))

    def crank(self, name: str, at: Point, length: float, drive: Drive) -> Point:
        """A driven crank; its end."""
        host, x, y = at
        self.body(name, length)
        bar = self.m.bodies[name]
        self.m.revolute(f"pin {name}", self.m.bodies[host].at(x, y), bar.start)
        self.m.drive_angle(f"motor {name}", bar, drive.law)
        self.form.groups.append(Crank(name, at, len(self.laws)))
        self.laws.append(drive.law)
        self.duration, self.turn = drive.duration, drive.turn
        return name, length, 0.0

    def bars(self, names: tuple[str, str], a: Point, b: Point, lengths: tuple[float, float], side: float) -> None:
        """A dyad of two bars."""
        for name, end, length in zip(names, (a, b), lengths, strict=True):
            self.body(name, length)
            self.m.revolute(f"pin {name}", self.m.bodies[end[0]].at(*end[1:]), self.m.bodies[name].start)
        self.m.revolute(f"pin {names[0]} {names[1]}", self.m.bodies[names[0]].end, self.m.bodies[names[1]].end)
        self.form.groups.append(Bars(names, a, b, lengths, side))

    def slider(
        self, names: tuple[str, str], a: Point, line: Point, angle: float, length: float, side: float, slot: bool
    ) -> None:
        """A rod from A to a slider on a line; the pin of a slot where there is no slider."""
        rod, block = names
        self.body(rod, length)
        m = self.m
        m.revolute(f"pin {rod}", m.bodies[a[0]].at(*a[1:]), m.bodies[rod].start)
        rail = m.bodies[line[0]].at(line[1], line[2], angle)
        if slot:
            m.pin_in_slot(f"slot {block}", rail, m.bodies[rod].end)
        else:
            m.body(block, float(self.rng.uniform(0.2, 2.0)), inertia=0.01)
            m.revolute(f"pin {block}", m.bodies[rod].end, m.bodies[block].origin)
            m.prismatic(f"rail {block}", rail, m.bodies[block].origin)
        self.form.groups.append(RodAndSlider(rod, block, a, line, angle, length, side))

    def subject(self, possible: bool | None, distance: float, traits: frozenset[str] = frozenset()) -> Subject:
        """With the start pose of the closed form: whole, or as rough angles a user would give."""
        m = self.m
        drives = np.array([[law.over(0.0, self.duration)(np.zeros(1))[0, 0] for law in self.laws]])
        with np.errstate(all="ignore"):
            poses, _ = self.form.poses(drives)
        rough = 2.0 if distance > 0.05 and self.rng.random() < 0.3 else 0.0
        for name in list(m.bodies)[1:]:
            x, y, theta = poses[name][0]
            degrees = math.degrees(theta)
            if rough and m.bodies[name].length is not None:
                m.start_near(**{name: degrees + float(self.rng.uniform(-rough, rough))})
            elif np.isfinite(poses[name]).all():
                m.start_near(**{name: (float(x), float(y), degrees)})
        laws = [law.over(0.0, self.duration) for law in self.laws]
        judge = self.form.truth(list(m.drivers), laws, self.duration)
        return Subject(m, self.duration, True, self.turn, judge, possible, distance, traits)

    def reach(self) -> float:
        """Least discriminant over the motion."""
        return self.form.reach([law.over(0.0, self.duration) for law in self.laws], self.duration)

    def usual(self) -> Subject:
        """Build dyads of usual lengths.

        Only near a change point is it unknown whether they can move all the way.
        """
        least = self.reach()
        possible = True if least > ROOMY else False if least < -ROOMY else None
        return self.subject(possible, math.sqrt(max(least, 0.0)))


def side(rng: np.random.Generator) -> float:
    """+1 or -1."""
    return float(rng.choice([-1.0, 1.0]))


def grashof(rng: np.random.Generator) -> tuple[float, float, float, float]:
    """(ground, crank, coupler, rocker) whose crank turns fully."""
    crank = float(rng.uniform(0.05, 1.0))
    ground, coupler = crank * rng.uniform(1.1, 5.0), crank * rng.uniform(1.1, 5.0)
    if rng.random() < 0.3:  # drag link: the frame is the shortest
        ground, crank = crank, ground
    high = abs(ground - crank) + coupler
    low = max(ground + crank - coupler, coupler - abs(ground - crank))
    if not low < high:
        return grashof(rng)
    return float(ground), float(crank), float(coupler), float(low + rng.uniform(0.02, 0.98) * (high - low))


def four_bar(
    rng: np.random.Generator, lengths: tuple[float, float, float, float], drive: Drive, name: str = "four-bar"
) -> Built:
    """Ground, crank, coupler, rocker."""
    ground, crank, coupler, rocker = lengths
    built = Built(name, rng)
    end = built.crank("crank", ("ground", 0.0, 0.0), crank, drive)
    built.bars(("coupler", "rocker"), end, ("ground", ground, 0.0), (coupler, rocker), side(rng))
    return built


@family("four-bar, crank turns", 2.0)
def turning_four_bar(rng: np.random.Generator) -> Subject:
    """Crank-rockers and drag links."""
    return four_bar(rng, grashof(rng), turning(rng, float(rng.uniform(-4, 4)))).usual()


@family("four-bar, any lengths", 1.0)
def any_four_bar(rng: np.random.Generator) -> Subject:
    """Most cannot turn; they swing, or are refused."""
    lengths = tuple(float(x) for x in rng.uniform(0.1, 1.0, 4))
    start = float(rng.uniform(-4, 4))
    drive = turning(rng, start) if rng.random() < 0.4 else swinging(rng, start, float(rng.uniform(0.1, 1.5)))
    built = four_bar(rng, lengths, drive)  # pyright: ignore[reportArgumentType]
    first = built.form.poses(np.array([[float(drive.law.over(0.0, 1.0)(np.zeros(1))[0, 0])]]))[1][0]
    return any_four_bar(rng) if first < 0.02 else built.usual()


@family("four-bar, near change point", 2.0)
def near_change_point(rng: np.random.Generator) -> Subject:
    """Within 1e-2 to 1e-10 m of folding flat, on either side: it passes, or the crank cannot turn."""
    eps = float(10 ** rng.uniform(-10, -2))
    round_numbers = rng.random() < 0.5
    ground, crank, coupler = (0.30, 0.10, 0.25) if round_numbers else (float(x) for x in rng.uniform(0.1, 0.4, 3))
    sign = float(rng.choice([1.0, 1.0, -1.0]))
    folds_long = round_numbers or rng.random() < 0.5
    if folds_long:
        rocker = (ground + crank) - coupler + sign * eps
        if rocker < 0.03 or abs(ground - crank) <= abs(coupler - rocker) + 0.01:
            return near_change_point(rng)
        gap = Fraction(coupler) + Fraction(rocker) - Fraction(ground) - Fraction(crank)
    else:
        rocker = coupler + abs(ground - crank) - sign * eps
        if abs(ground - crank) < 0.02 or ground + crank >= coupler + rocker - 0.01:
            return near_change_point(rng)
        gap = abs(Fraction(ground) - Fraction(crank)) - abs(Fraction(coupler) - Fraction(rocker))
    speed = float(rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(0, 1.5))
    turn = 2 * math.pi / abs(speed)
    start = float(rng.choice([1.0, 2.0])) if round_numbers else float(rng.uniform(0.5, 2.6) * rng.choice([-1, 1]))
    drive = Drive(constant_rate(speed, start), turn, turn)
    built = four_bar(rng, (ground, crank, coupler, rocker), drive, "near change point")
    known = abs(float(gap)) > 1e-14
    return built.subject(float(gap) > 0 if known else None, math.sqrt(abs(float(gap))) if gap > 0 else 0.0)


@family("slider-crank", 1.5)
def slider_crank(rng: np.random.Generator) -> Subject:
    """With an offset, sometimes near the length where the crank cannot turn; a slider, or a pin in a slot."""
    crank, offset = float(rng.uniform(0.02, 0.3)), float(rng.choice([0.0, 1.0]) * rng.normal(scale=0.1))
    reach = crank + abs(offset)
    near = rng.random() < 0.35
    length = reach + float(rng.choice([1.0, -1.0]) * 10 ** rng.uniform(-10, -2) if near else rng.uniform(0.02, 1.0))
    angle = float(rng.choice([0.0, math.pi / 2, rng.uniform(-3, 3)]))
    built = Built("slider-crank", rng)
    start = angle + float(rng.uniform(-1.0, 1.0) * 0.9)
    end = built.crank("crank", ("ground", 0.0, 0.0), crank, turning(rng, start))
    line = ("ground", -offset * math.sin(angle), offset * math.cos(angle))
    built.slider(("rod", "slider"), end, line, angle, length, side(rng), bool(rng.random() < 0.3))
    if not near:
        return built.usual()
    least = built.reach()
    known = abs(least) > 1e-13
    return built.subject(least > 0 if known else None, math.sqrt(max(least, 0.0)))


@family("six-bar and more", 2.0)
def dyads_on_dyads(rng: np.random.Generator) -> Subject:
    """A four-bar or slider-crank with one to three further dyads: Watt, Stephenson and longer ones."""
    built = four_bar(rng, grashof(rng), turning(rng, float(rng.uniform(-4, 4))), "dyads")
    for k in range(int(rng.integers(1, 4))):
        if not _add_dyad(built, rng, k):
            break
    return built.usual()


@family("six-bar, crank swings", 1.0)
def swinging_dyads(rng: np.random.Generator) -> Subject:
    """The same on a crank that swings."""
    built = four_bar(rng, grashof(rng), swinging(rng, float(rng.uniform(-4, 4)), float(rng.uniform(0.1, 2))), "dyads")
    for k in range(int(rng.integers(1, 4))):
        if not _add_dyad(built, rng, k):
            break
    return built.usual()


def _add_dyad(built: Built, rng: np.random.Generator, k: int) -> bool:
    """Between two points of different bodies; mostly long enough for the whole motion."""
    laws = [law.over(0.0, built.duration) for law in built.laws]
    times = np.linspace(0.0, built.duration, 129)
    poses, least = built.form.poses(np.stack([law(times)[:, 0] for law in laws], axis=1))
    if least.min() < 0:
        return False
    names = [name for name in poses if name in built.m.bodies]
    first, second = (str(name) for name in rng.choice(names, 2, replace=False))
    size = max(float(np.abs(pose[:, :2]).max()) for pose in poses.values())
    a: Point = (first, float(rng.normal(scale=0.4 * size)), float(rng.normal(scale=0.4 * size)))
    b: Point = (second, float(rng.normal(scale=0.4 * size)), float(rng.normal(scale=0.4 * size)))
    pa, pb = place(poses, a), place(poses, b)
    far = np.abs(pb - pa)
    roomy = rng.random() < 0.85
    if rng.random() < 0.35:
        angle = float(rng.uniform(-3, 3))
        off = ((pa - pb) / np.exp(1j * (poses[second][:, 2] + angle))).imag
        length = float(
            np.abs(off).max() * rng.uniform(1.1, 2.5) if roomy else np.abs(off).max() * rng.uniform(0.8, 1.2)
        )
        if length < 0.02 * size or abs(off[0]) > 0.99 * length:
            return True
        built.slider((f"rod{k}", f"block{k}"), a, b, angle, length, side(rng), slot=False)
        return True
    if far.min() < 0.05 * size:
        return True
    low, high = float(far.min()), float(far.max())
    total = high * float(rng.uniform(1.05, 2.0) if roomy else rng.uniform(0.9, 1.1))
    spread = low * float(rng.uniform(-0.9, 0.9))
    l1, l2 = (total + spread) / 2, (total - spread) / 2
    if min(l1, l2) < 0.03 * size or not abs(l1 - l2) < 0.99 * far[0] < 0.98 * (l1 + l2):
        return True
    built.bars((f"left{k}", f"right{k}"), a, b, (l1, l2), side(rng))
    return True


@family("five-bar, two drivers", 1.0)
def five_bar(rng: np.random.Generator) -> Subject:
    """Two cranks with laws of their own, and a dyad between them."""
    built = Built("five-bar", rng)
    r1, r2 = (float(x) for x in rng.uniform(0.1, 0.5, 2))
    ground = float(rng.uniform(0.5, 1.5))
    drive = turning(rng, float(rng.uniform(-3, 3)))
    ratio = float(rng.choice([-2.0, -1.0, 1.0, 2.0, 0.5]))
    a = built.crank("left crank", ("ground", 0.0, 0.0), r1, drive)
    second = constant_rate(ratio * 2 * math.pi / drive.turn, float(rng.uniform(-3, 3)))
    b = built.crank("right crank", ("ground", ground, 0.0), r2, Drive(second, drive.duration, drive.turn))
    far, near = ground + r1 + r2, max(0.0, ground - r1 - r2)
    total, spread = far * float(rng.uniform(0.9, 1.8)), max(near, 0.05) * float(rng.uniform(-0.8, 0.8))
    built.bars(("left", "right"), a, b, ((total + spread) / 2, (total - spread) / 2), side(rng))
    drives = np.array([[law.over(0.0, built.duration)(np.zeros(1))[0, 0] for law in built.laws]])
    if built.form.poses(drives)[1][0] < 0.02:
        return five_bar(rng)
    return built.usual()
