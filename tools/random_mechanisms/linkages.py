"""Random closed linkages for tests: loops of bars, sliders, slots and rods.

A linkage is made from its start pose, so it closes. The first loop is a four-bar; each further one hangs between two
random bodies and adds a freedom or none. Springs, dampers and torsion springs pull at it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from mbsd import Mechanism, constant_rate, harmonic
from mbsd.mechanism import Body, Marker

GRAVITY = 9.81
ADDS = {"three bars": 1, "two bars": 0, "bar in slot": 0, "bar and slider": 0, "bar and rod": 0}
"""Freedoms that a loop of each kind adds."""


@dataclass(frozen=True)
class Spring:
    """Between points i and j (m, frames of their bodies), with stiffness, damping and free length."""

    i: Marker
    j: Marker
    stiffness: float
    damping: float
    free_length: float


@dataclass(frozen=True)
class Twist:
    """A torsion spring between two bodies."""

    first: Body
    second: Body
    stiffness: float
    damping: float
    free_angle: float


@dataclass
class Linkage:
    """A mechanism, what pulls at it, and the bars that drivers may turn, with their partners."""

    m: Mechanism
    springs: list[Spring] = field(default_factory=list)
    twists: list[Twist] = field(default_factory=list)
    cranks: list[tuple[Body, Body]] = field(default_factory=list)
    frames: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    """Place (m) and angle (rad) of each body's frame at the start."""

    def marker(self, body: Body, place: np.ndarray, angle: float = 0.0) -> Marker:
        """The marker on a body that is at ``place`` at the start, and turned by ``angle``."""
        x, y, turned = self.frames[body.name]
        c, s = math.cos(turned), math.sin(turned)
        dx, dy = place[0] - x, place[1] - y
        return body.at(float(c * dx + s * dy), float(-s * dx + c * dy), float(angle - turned))


@dataclass(frozen=True)
class Carried:
    """The whole turned (rad) about the origin and then moved (m)."""

    turned: float = 0.0
    moved: tuple[float, float] = (0.0, 0.0)

    def __call__(self, vectors: np.ndarray) -> np.ndarray:
        """(..., 2) directions."""
        c, s = math.cos(self.turned), math.sin(self.turned)
        return vectors @ np.array([[c, s], [-s, c]])

    def place(self, point: np.ndarray) -> np.ndarray:
        """(..., 2) places."""
        return self(point) + np.array(self.moved)


def linkage(seed: int, loops: int, damping: bool = False, carried: Carried | None = None) -> Linkage:
    """One of many; the same seed gives the same one, ``carried`` as a whole."""
    rng, carried = np.random.default_rng(seed), carried or Carried()
    pull = rng.uniform(-math.pi, math.pi)
    gravity = carried(GRAVITY * np.array([math.cos(pull), math.sin(pull)]))
    made = Linkage(Mechanism("random", gravity=(float(gravity[0]), float(gravity[1]))))
    made.frames["ground"] = (0.0, 0.0, 0.0)
    middles = {"ground": np.array([0.5, 0.0])}  # where new pins are set, before the whole is carried off
    for loop in range(loops):
        kind = "three bars" if loop == 0 else str(rng.choice(list(ADDS)))
        hosts = ("ground", "ground") if loop == 0 else tuple(rng.choice(list(middles), 2, replace=False))
        _add_loop(made, rng, carried, loop, kind, (str(hosts[0]), str(hosts[1])), middles)
    _add_forces(made, rng, carried, damping, middles)
    return made


def driven_linkage(seed: int, loops: int) -> Mechanism:
    """A linkage whose cranks turn steadily or swing; most cannot follow all the way."""
    made, rng = linkage(seed, loops), np.random.default_rng(seed)
    for k, (host, crank) in enumerate(made.cranks):
        rate = float(rng.choice([-1, 1]) * rng.choice([0.5, 1.0, 2.0]))
        lies = made.frames[crank.name][2] - made.frames[host.name][2]
        law = (
            harmonic(float(rng.uniform(0.2, 3.0)), rate, 0.0, lies) if rng.random() < 0.3 else constant_rate(rate, lies)
        )
        made.m.drive_relative_angle(f"motor{k}", host, crank, law)
    return made.m


def _add_loop(
    made: Linkage,
    rng: np.random.Generator,
    carried: Carried,
    loop: int,
    kind: str,
    hosts: tuple[str, str],
    middles: dict[str, np.ndarray],
) -> None:
    m = made.m
    count = {"three bars": 3, "two bars": 2}.get(kind, 1)
    points = _points(rng, middles[hosts[0]], middles[hosts[1]], count + (kind == "bar and rod"))
    slope = carried.turned + rng.uniform(-math.pi, math.pi)
    before = m.bodies[hosts[0]]
    for k in range(count):
        name, start, way = f"bar{loop}{'abc'[k]}", carried.place(points[k]), points[k + 1] - points[k]
        angle = math.atan2(way[1], way[0]) + carried.turned
        bar = _body(made, rng, name, start, angle, math.hypot(*way))
        middles[name] = (points[k] + points[k + 1]) / 2
        m.revolute(f"pin{loop}{'abc'[k]}", made.marker(before, start), bar.origin)
        if k == 0 and kind == "three bars":
            made.cranks.append((before, bar))
        before = bar
    last, host = carried.place(points[count]), m.bodies[hosts[1]]
    if kind == "bar in slot":
        m.pin_in_slot(f"slot{loop}", made.marker(host, last, slope), made.marker(before, last))
    elif kind == "bar and slider":
        block = _body(made, rng, f"block{loop}", last, slope, 0.2)
        middles[block.name] = points[count]
        m.revolute(f"wrist{loop}", made.marker(before, last), block.origin)
        m.prismatic(f"rail{loop}", made.marker(host, last, slope), block.origin)
    elif kind == "bar and rod":
        far = carried.place(points[count + 1])
        length = float(np.hypot(*(far - last)))
        m.distance(f"rod{loop}", made.marker(host, far), made.marker(before, last), length)
    else:
        m.revolute(f"end{loop}", made.marker(host, last), made.marker(before, last))


def _points(rng: np.random.Generator, first: np.ndarray, last: np.ndarray, bars: int) -> np.ndarray:
    """Return (bars + 1, 2) pins from near one host to near the other.

    No bar is shorter than 0.25 m or almost along the next.
    """
    for _ in range(1000):
        share = np.linspace(0.0, 1.0, bars + 1)[:, None]
        points = first + share * (last - first) + rng.normal(scale=0.35, size=(bars + 1, 2))
        sides = np.diff(points, axis=0)
        lengths = np.hypot(*sides.T)
        sines = np.abs(sides[:-1, 0] * sides[1:, 1] - sides[:-1, 1] * sides[1:, 0]) / (lengths[:-1] * lengths[1:])
        if lengths.min() > 0.25 and (sines > 0.4).all():
            return points
    raise AssertionError("no such points")


def _body(made: Linkage, rng: np.random.Generator, name: str, place: np.ndarray, angle: float, length: float) -> Body:
    mass, com = rng.uniform(0.3, 2.0), rng.uniform([0.2, -0.1], [0.8, 0.1]) * length
    body = made.m.body(name, mass, (float(com[0]), float(com[1])), mass * length**2 * rng.uniform(0.05, 0.3))
    made.frames[name] = (float(place[0]), float(place[1]), angle)
    made.m.start_near(**{name: (float(place[0]), float(place[1]), math.degrees(angle))})
    return body


def _add_forces(
    made: Linkage, rng: np.random.Generator, carried: Carried, damping: bool, middles: dict[str, np.ndarray]
) -> None:
    m, names = made.m, list(middles)
    for k in range(int(rng.integers(1, 4))):
        ends = [str(name) for name in rng.choice(names, 2, replace=False)]
        i, j = (made.marker(m.bodies[end], carried.place(middles[end] + rng.normal(scale=0.2, size=2))) for end in ends)
        stiffness, drag = float(rng.uniform(5, 80)), float(rng.uniform(0, 3)) if damping else 0.0
        spring = Spring(i, j, stiffness, drag, float(rng.uniform(0.1, 0.6)))
        made.springs.append(spring)
        m.spring(f"spring{k}", i, j, stiffness, damping=drag, free_length=spring.free_length)
    first, second = (m.bodies[str(name)] for name in rng.choice(names, 2, replace=False))
    free = made.frames[second.name][2] - made.frames[first.name][2] + float(rng.uniform(-1, 1))
    twist = Twist(first, second, float(rng.uniform(0.5, 5)), float(rng.uniform(0, 0.3)) if damping else 0.0, free)
    made.twists.append(twist)
    m.torsion_spring("twist", first, second, twist.stiffness, damping=twist.damping, free_angle=free)
