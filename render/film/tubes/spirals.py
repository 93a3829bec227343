"""Torsion springs: a flat spiral over the pin of two bodies, each end on a stud of one body.

    r(s)    = R + (H - R) s                     from the stud (s = 0) in to the hub (s = 1)
    a(s, t) = a_stud(t) + 2 pi n(t) s           n(t) turns: as many more as the inner body has turned against the outer

So the spring winds up and unwinds as the bodies turn, and its ends stay where they are fixed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Poses, local_place, moved
from render.film.scene import Point, SurfaceSpec, TubeSpec
from render.film.tubes.stretched import STEEL, placed
from shared.contract import ForceMotion, Motion

Array = NDArray[np.float64]
BLUED = SurfaceSpec(colour=(0.075, 0.115, 0.26), finish="polished", roughness=0.28)
RIM, HUB, WIRE, STUD = 0.056, 0.016, 0.0042, 0.0052
"""Radii of the spiral's outer end, the hub, the wire and the stud, as parts of the size of the swept motion."""
LEAST, USUAL = 1.5, 3.0
"""Turns of the spiral: at least, and where that allows it on average."""
APART = 1.3
"""Distance of its turns in diameters of the wire, at least."""
PER_TURN = 40
"""Points of a turn."""
SAME_PLACE = 1e-6
"""Part of the size by which the pin's place may differ between both bodies."""


@dataclass(frozen=True)
class Site:
    """A place for a spiral: the body with its stud, the direction (rad, in that body), heights (m)."""

    outer: str
    direction: float
    base: float
    """Height on which the stud stands (m)."""
    hub: float
    """Top of the pin."""
    over: float
    """Nothing that passes is higher."""


@dataclass(frozen=True)
class Spiral:
    """One torsion spring, about a place of its outer body (m)."""

    name: str
    outer: str
    inner: str
    at: tuple[float, float, float]
    """x, y in the outer body's frame, and the stud's direction there."""
    turns: float
    """Turns where the inner body's angle against the outer is 0."""
    points: int
    size: float
    wire: float
    site: Site

    @property
    def z(self) -> float:
        """Height of the spiral."""
        return self.site.over + 2.0 * self.wire

    @property
    def rim(self) -> float:
        """Distance of the stud from the pin."""
        return RIM * self.size

    @property
    def top(self) -> float:
        """Top of hub and stud."""
        return self.z + 1.6 * self.wire

    @property
    def specs(self) -> list[TubeSpec]:
        """Spiral, hub and stud."""
        shapes = {"": (self.wire, self.points), " hub": (HUB * self.size, 2), " stud": (STUD * self.size, 2)}
        return [
            TubeSpec(name=f"{self.name}{part}", surface=STEEL if part else BLUED, radius=radius, points=points)
            for part, (radius, points) in shapes.items()
        ]

    def paths(self, poses: Poses, at: Moment) -> list[list[Point]]:
        """Return paths of the three tubes at that moment."""
        pose = poses.body(self.outer, at)
        x, y = placed(pose, self.at)
        c, s = math.cos(pose[2] + self.at[2]), math.sin(pose[2] + self.at[2])
        spiral = self.curve(poses.body(self.inner, at)[2] - pose[2])
        u, v = x + self.rim * c, y + self.rim * s
        return [
            [(float(x + c * a - s * b), float(y + s * a + c * b), float(h)) for a, b, h in spiral],
            [(x, y, self.site.hub), (x, y, self.top)],
            [(u, v, self.site.base), (u, v, self.top)],
        ]

    def curve(self, turned: float) -> Array:
        """Return points (n, 3) of the wire about its pin, its stud on the x axis.

        ``turned``: inner against outer (rad).
        """
        part = np.linspace(0, 1, self.points)
        radius = self.rim + (HUB * self.size - self.rim) * part
        angle = (turned + math.tau * self.turns) * part
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(self.points, self.z)], axis=1)


def spirals(
    motion: Motion, size: float, site: Callable[[tuple[str, str], Array, float], Site | None]
) -> Iterator[Spiral]:
    """Yield all torsion springs whose two bodies share a pin, ``size`` (m) being that of the swept motion.

    ``site(bodies, places, radius)`` finds room over the pin, whose places (T, 2) are given; None: there is none.
    """
    for name, force in motion.forces.items():
        pin = _pin(motion, force, size)
        if pin is None:
            continue
        bodies, places = pin
        place = site(bodies, places, RIM * size)
        if place is None:
            continue
        inner = bodies[1] if place.outer == bodies[0] else bodies[0]
        turned = _theta(motion, inner) - _theta(motion, place.outer)
        least, most = (float(end) / math.tau for end in (turned.min(), turned.max()))
        mean = max(USUAL, LEAST + (most - least) / 2)
        wire = min(WIRE * size, (RIM - HUB) * size / (2 * APART * (mean + (most - least) / 2)))
        local = _local(motion, place.outer, places[0])
        points = math.ceil(PER_TURN * (mean + (most - least) / 2)) + 1
        turns = mean - (least + most) / 2
        yield Spiral(name, place.outer, inner, (*local, place.direction), turns, points, size, wire, place)


def _pin(motion: Motion, force: ForceMotion, size: float) -> tuple[tuple[str, str], Array] | None:
    """Return the two bodies of a torsion spring and the place (T, 2) of their pin; None without a pin."""
    if force.look != "spiral" or force.shape is None:
        return None
    for joint in motion.joints.values():
        if joint.pair == "pin" and set(joint.bodies) == set(force.shape.bodies):
            return force.shape.bodies, np.stack([np.asarray(joint.x), np.asarray(joint.y)], axis=1)
    first, second = (moved(motion, b, m)[0] for b, m in zip(force.shape.bodies, force.shape.markers, strict=True))
    return (force.shape.bodies, second) if np.abs(second - first).max() < SAME_PLACE * size else None


def _theta(motion: Motion, body: str) -> Array:
    return np.asarray(motion.bodies[body].theta) if body in motion.bodies else np.zeros(len(motion.time))


def _local(motion: Motion, body: str, place: Array) -> tuple[float, float]:
    """Return a place of the world at the first time, in a body's frame (m)."""
    if body not in motion.bodies:
        return float(place[0]), float(place[1])
    return local_place(motion.bodies[body], float(place[0]), float(place[1]))
