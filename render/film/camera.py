"""The camera of a film: it stands where it holds all that is filmed, or swings about its middle."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from render.film.clock import Clock
from render.film.framing import CameraPose, axes, depth_of_field, fit, half_width, lifted, orbit
from render.film.scene import Point
from shared.contract.shot import Camera

Array = NDArray[np.float64]


class FilmCamera:
    """The camera of a shot; ``filmed`` (n, 3) is what it holds, ``sharp`` (m, 3) what is in focus (m)."""

    def __init__(self, shot: Camera, clock: Clock, filmed: Array, sharp: Array, above: float = 0.0) -> None:
        """``above`` is the part of the picture's height that stays empty at its top beside the margin."""
        self.shot, self.clock, self.filmed, self.sharp, self.above = shot, clock, filmed, sharp, above

    def pose(self, frame: int) -> CameraPose:
        """At a frame: it stands still, or swings about the middle once in each showing of the motion."""
        swing = math.radians(self.shot.orbit)
        if not swing:
            return self._still
        return self._posed(math.radians(self.shot.azimuth) + swing * math.sin(math.tau * self.clock.phase(frame)))

    @cached_property
    def _still(self) -> CameraPose:
        """Of a camera that does not swing: what is in focus is measured once, not a frame."""
        return self._posed(math.radians(self.shot.azimuth))

    def _posed(self, azimuth: float) -> CameraPose:
        """At an azimuth (rad), where the shot has its own or swings about the middle."""
        elevation = math.radians(self.shot.elevation)
        position, target, distance = self._stand
        if self.shot.orbit:
            _, up, forward = axes(azimuth, elevation)
            position = (
                target - forward * distance + up * lifted(self.shot.lens, self.shot.margin, self.above) * distance
            )
        depths = (self.sharp - position) @ axes(azimuth, elevation)[2]
        near, far = float(depths.min()), float(depths.max())
        focus, fstop = depth_of_field(near, far, self.shot.lens, self.shot.blur)
        return CameraPose(
            position=point(position),
            azimuth=azimuth,
            elevation=elevation,
            lens=self.shot.lens,
            focus=focus,
            fstop=fstop,
        )

    @property
    def width(self) -> float:
        """Of the picture where the machine is (m)."""
        return 2 * half_width(self.shot.lens) * self._stand[2]

    @cached_property
    def _stand(self) -> tuple[Array, Array, float]:
        """Camera position, the point it looks at, and their distance."""
        elevation, azimuth = math.radians(self.shot.elevation), math.radians(self.shot.azimuth)
        above = 0.0 if self.shot.orbit else self.above
        position, distance = fit(self.filmed, azimuth, elevation, self.shot.lens, self.shot.margin, above)
        target = position + axes(azimuth, elevation)[2] * distance
        if self.shot.orbit:
            swing = azimuth + math.radians(self.shot.orbit) * np.linspace(-1, 1, 9)
            distance = orbit(self.filmed, target, swing, elevation, self.shot.lens, self.shot.margin, self.above)
        return position, target, distance


def point(vector: Array) -> Point:
    """Three floats of a vector (3,)."""
    x, y, z = (float(value) for value in vector)
    return x, y, z
