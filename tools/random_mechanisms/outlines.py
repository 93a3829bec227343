"""Random pairs of outlines that collide, and the books of momentum and energy of what they do."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd import Mechanism, ModelError, Solution, circle, spline_through
from mbsd.model.outlines.geometry import depths_in


class Books(NamedTuple):
    """Changes by a collision: momentum (kg m/s), spin (kg m^2/s), energy gained (J); how deep bodies got (m)."""

    momentum: float
    spin: float
    gained: float
    depth: float


def random_path(random: np.random.Generator) -> list[Any]:
    """Return a path of about 50 mm: a polygon, one of arcs, a spline or a circle; convex or not."""
    n = int(random.integers(3, 9))
    turns = np.sort((np.arange(n) + 0.35 * random.uniform(-1, 1, n)) * 2 * math.pi / n)
    sizes = 0.05 * random.uniform(0.35, 1, n)
    points = [(float(r * math.cos(a)), float(r * math.sin(a))) for a, r in zip(turns, sizes, strict=True)]
    kind = int(random.integers(4))
    if kind == 1:
        return [spline_through(points)]
    if kind == 2:
        return [(x, y, float(random.uniform(-0.25, 0.35))) for x, y in points]
    return circle(0.03) if kind == 3 else points


def colliding(seed: int) -> Mechanism:
    """Return two free bodies that fly at each other."""
    random = np.random.default_rng(seed)
    m = Mechanism("pair", gravity=None)
    a = m.body("a", 1.0, inertia=6e-4 * random.uniform(0.5, 2))
    b = m.body("b", random.uniform(0.3, 3), inertia=6e-4 * random.uniform(0.5, 2))
    while len(m.outlines) < 2:
        try:
            m.outline(a if not m.outlines else b, random_path(random))
        except ModelError:  # a random path may cross itself
            continue
    friction = float(random.choice([0.0, random.uniform(0, 1)]))
    m.outline_contact("c", a, b, restitution=random.uniform(0, 1), friction=friction)
    m.start_near(a=(0, 0, random.uniform(0, 360)), b=(0.16, random.uniform(-0.05, 0.05), random.uniform(0, 360)))
    m.start_moving(a=(1, 0, random.uniform(-30, 30)), b=(-1, random.uniform(-0.3, 0.3), random.uniform(-30, 30)))
    return m


def collision(seed: int) -> Books:
    """Return the books of a random collision, which lasts a quarter of a second."""
    m = colliding(seed)
    sol = m.simulate(0.25, steps=60, tolerance=1e-9)
    bodies = [(m.bodies[name], sol.body(name)) for name in ("a", "b")]
    px, py, spin, energy = (np.zeros(len(sol.t)) for _ in range(4))
    for body, seen in bodies:
        px += body.mass * seen.vx
        py += body.mass * seen.vy
        spin += body.mass * (seen.x * seen.vy - seen.y * seen.vx) + body.inertia * seen.omega
        energy += 0.5 * body.mass * (seen.vx**2 + seen.vy**2) + 0.5 * body.inertia * seen.omega**2
    for event in sol.events:
        energy -= np.where(sol.t > event.time, event.energy, 0.0)
    most = max([float(np.diff(energy).max()), *(event.energy for event in sol.events)])
    return Books(max(float(np.ptp(px)), float(np.ptp(py))), float(np.ptp(spin)), most, _depth(m, sol))


def _depth(m: Mechanism, sol: Solution) -> float:
    """Return how deep points of one outline were in the other at any output (m), by polygons alone."""
    deep = 0.0
    for k in range(len(sol.t)):
        paths = []
        for name in ("a", "b"):
            seen, path = sol.body(name), m.outlines[name].path(0.02)
            c, s = math.cos(seen.theta[k]), math.sin(seen.theta[k])
            paths.append(path @ np.array([[c, s], [-s, c]]) + (seen.x[k], seen.y[k]))
        for first, other in (paths, paths[::-1]):
            deep = max(deep, float(depths_in(first, other).max()))
    return deep
