"""Trails of traced points: how fine they are, and where they lie in each frame."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from render.film.clock import Clock
from render.film.poses import Poses
from render.film.scene import Point, TrailSpec
from shared.contract import AnyMotion
from shared.contract.shot import Colour, Shot, Trail
from shared.contract.signals import SIGNALS, linear

RINGS, MOST_RINGS = 160, 3000
"""Numbers of rings of a trail: the fewest and the most."""
STRAY = 0.15
"""Largest distance of a trail from its point's way between two rings, in its own radii."""
LIGHT, INK = 2.9, 1.2
"""Brightness of a trail: one that shines, and one on what is bright itself."""
BENT = 0.995
"""Part of the motion over which that holds; stiff contacts accelerate a point at will for a moment."""


def trails_of(motion: AnyMotion, shot: Shot) -> tuple[Trail, ...]:
    """Return the shot's trails; every traced point gets one if the shot says nothing."""
    return shot.trails if shot.trails is not None else tuple(Trail(point=point) for point in motion.points)


def colour_of(trail: Trail, dark: bool) -> Colour:
    """Return linear RGB of a trail, where what is behind it is ``dark`` or bright."""
    return trail.colour or linear(SIGNALS["trails"].dark if dark and not trail.ink else SIGNALS["trails"].light)


class Trails:
    """The trails of one film at their heights (m) by point, ``size`` (m) being that of its swept motion."""

    def __init__(self, poses: Poses, clock: Clock, shot: Shot, heights: dict[str, float], size: float) -> None:
        self.poses, self.clock, self.heights, self.size = poses, clock, heights, size
        self.trails = trails_of(poses.motion, shot)

    def specs(self, dark: bool) -> list[TrailSpec]:
        """Return their looks: lights where what is behind them is ``dark``, else as deep as ink."""
        return [
            TrailSpec(
                name=trail.point,
                colour=colour_of(trail, dark),
                strength=INK if trail.ink or not (trail.colour or dark) else LIGHT,
                radius=trail.radius * self.size,
                rings=rings,
            )
            for trail, rings in zip(self.trails, self._rings, strict=True)
        ]

    def paths(self, frame: float) -> list[list[Point]]:
        """Return where each point was, from now back to the end of its tail.

        Where an impact turned it is among the places.
        """
        out = []
        for trail, rings in zip(self.trails, self._rings, strict=True):
            times = self.clock.trail_times(frame, trail.tail, rings)
            step = float(np.abs(np.diff(times)).min())  # where a period begins anew, it is more
            for event in self.poses.motion.events:
                away = np.abs(times[1:] - event.time)
                nearest = int(away.argmin())
                if away[nearest] <= 0.5 * step * (1 + 1e-6):
                    times[1 + nearest] = event.time
            height = self.heights[trail.point]
            out.append([(float(x), float(y), float(z)) for x, y, z in self.poses.path(trail.point, times, height)])
        return out

    @cached_property
    def _rings(self) -> list[int]:
        """Numbers of rings: as many as keep the tube within a part of its own radius of the point's way.

        Between two moments h apart a chord strays by a h^2 / 8 from a way with acceleration a.
        """
        out = []
        for trail in self.trails:
            bend = float(np.quantile(self.poses.bends(trail.point), BENT))
            stray = STRAY * trail.radius * self.size
            length = trail.tail * (self.clock.end - self.clock.start) / self.clock.turns
            wanted = math.ceil(length * math.sqrt(bend / (8 * stray)))
            out.append(min(max(RINGS, wanted), MOST_RINGS))
        return out
