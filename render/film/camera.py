"""The camera of a film: it stands where the machine fills the picture, swings, or goes along."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.clock import Clock
from render.film.composing import View, held, outermost
from render.film.framing import CameraPose, Empty, axes, depth_of_field, half_field, in_studio, in_world, lifted, orbit
from render.film.scene import Point
from render.presets import ASPECT
from shared.contract.parts import Mount
from shared.contract.shot import Camera

Array = NDArray[np.float64]
LYING, STANDING, IN_SPACE = (-16.0, 42.0), (-24.0, 10.0), (-34.0, 24.0)
"""Azimuth and elevation (degrees) where a shot says none: of what lies on a desk, at eye level of what stands, and in a
three-quarter view of what moves in space."""
TALL = 9 / 16
LYING_TALL, STANDING_TALL, TALL_IN_SPACE = (-6.0, 15.0), (-12.0, 2.0), (-8.0, 6.0)
"""Degrees added to these in a picture that is 9:16, and in part in those between: from higher up what lies is taller,
and from farther aside what stands is narrower."""


USUAL = {"desk": (LYING, LYING_TALL), "bench": (IN_SPACE, TALL_IN_SPACE)}


def angles(shot: Camera, mount: Mount, aspect: float = ASPECT) -> tuple[float, float]:
    """Return the azimuth and elevation (rad) of the camera.

    What the shot does not specify follows from how the machine stands, and from the ``aspect`` of the picture.
    """
    part = min(max((ASPECT - aspect) / (ASPECT - TALL), 0.0), 1.0)
    usual, more = USUAL.get(mount.kind, (STANDING, STANDING_TALL))
    azimuth, elevation = (value + part * added for value, added in zip(usual, more, strict=True))
    azimuth = azimuth if shot.azimuth is None else shot.azimuth
    elevation = elevation if shot.elevation is None else shot.elevation
    return math.radians(azimuth), math.radians(elevation)


class Subject:
    """The subject of a film, in points (n, 3) of the world (m)."""

    def __init__(
        self,
        machine: Array,
        around: Array,
        drawn: Array,
        sharp: Array,
        way: Array | None = None,
        things: Sequence[Array] = (),
    ) -> None:
        """Keep the points of all of the ``machine``, and of what is ``around`` it, ``drawn`` and ``sharp``.

        ``things`` are large pieces among what is around, which a picture has whole or cuts on purpose. They hold over
        the whole motion. Where the machine is followed, ``way`` (frames, 3) is where it is, and points are as seen from
        there.
        """
        self.machine, self.around, self.drawn, self.sharp, self.way = machine, around, drawn, sharp, way
        self.few, self.things = outermost(machine), tuple(outermost(thing) for thing in things)


class FilmCamera:
    """The camera of a shot, for pictures of an ``aspect``."""

    def __init__(
        self,
        shot: Camera,
        mount: Mount,
        clock: Clock,
        subject: Subject,
        aspect: float = ASPECT,
        empty: Empty = (0.0, 0.0),
    ) -> None:
        """Set up the camera.

        ``empty`` are the parts of the picture's height that stay empty at its top and bottom beside the margin.
        """
        self.shot, self.clock, self.empty, self.up, self.aspect = shot, clock, empty, mount.up, aspect
        self.azimuth, self.elevation = angles(shot, mount, aspect)
        self.machine, self.around, self.drawn, self.sharp = (
            in_studio(points, self.up) for points in (subject.machine, subject.around, subject.drawn, subject.sharp)
        )
        self.few = in_studio(subject.few, self.up)
        self.things = [in_studio(thing, self.up) for thing in subject.things]
        self.way = None if subject.way is None else in_studio(subject.way, self.up)

    def pose(self, frame: int) -> CameraPose:
        """Return the pose at a frame.

        The camera stands still, swings about the middle once in each showing of the motion, or goes along.
        """
        swing = math.radians(self.shot.orbit)
        azimuth = self.azimuth + swing * math.sin(math.tau * self.clock.phase(frame))
        at = np.zeros(3) if self.way is None else self.way[frame % self.clock.frames]
        if not swing:
            return self._moved(at)
        return self._posed(azimuth, at)

    def looks(self) -> list[CameraPose]:
        """Return some of its poses that show where things are in the picture.

        What is followed stands at the start of its way.
        """
        if not self.shot.orbit:
            return [self._still]
        swing = math.radians(self.shot.orbit)
        return [self._posed(self.azimuth + swing * part, np.zeros(3)) for part in np.linspace(-1, 1, 5)]

    def _moved(self, by: Array) -> CameraPose:
        """Return the camera moved by (3,) m of the studio.

        Its focus is measured once, not for each frame.
        """
        if not by.any():
            return self._still
        position = np.array(self._still.position) + in_world(by, self.up)
        return msgspec.structs.replace(self._still, position=point(position))

    @cached_property
    def _still(self) -> CameraPose:
        """Pose of a camera that does not swing, where its way begins to count."""
        return self._posed(self.azimuth, np.zeros(3))

    def _posed(self, azimuth: float, by: Array) -> CameraPose:
        """Return the camera at an azimuth (rad), moved by (3,) m.

        The azimuth is the shot's own, or one of a swing about the middle.
        """
        elevation = self.elevation
        position, target, distance = self._stand
        if self.shot.orbit:
            _, up, forward = axes(azimuth, elevation)
            higher = lifted(self.shot.lens, self.shot.margin, self.empty, self.aspect) * distance
            position = target - forward * distance + up * higher
        depths = (self.sharp - position) @ axes(azimuth, elevation)[2]
        near, far = float(depths.min()), float(depths.max())
        focus, fstop = depth_of_field(near, far, self.shot.lens, self.shot.blur)
        return CameraPose(
            position=point(in_world(position + by, self.up)),
            azimuth=azimuth,
            elevation=elevation,
            lens=self.shot.lens,
            focus=focus,
            fstop=fstop,
            up=self.up,
        )

    @property
    def width(self) -> float:
        """Width of the picture where the machine is (m)."""
        return 2 * half_field(self.shot.lens, self.aspect)[0] * self._stand[2]

    @cached_property
    def _stand(self) -> tuple[Array, Array, float]:
        """Camera position, the point it looks at, and their distance, in the axes of the studio."""
        empty = (0.0, 0.0) if self.shot.orbit else self.empty
        view = View(self.azimuth, self.elevation, self.shot.lens, self.shot.margin, empty, self.aspect)
        filmed = held(view, self.machine, self.around, self.drawn, self.few, self.things)
        position, distance = view.stand(filmed)
        target = position + axes(self.azimuth, self.elevation)[2] * distance
        if self.shot.orbit:
            swing = self.azimuth + math.radians(self.shot.orbit) * np.linspace(-1, 1, 9)
            distance = orbit(
                filmed, target, swing, self.elevation, self.shot.lens, self.shot.margin, self.empty, self.aspect
            )
        return position, target, distance


def point(vector: Array) -> Point:
    """Return three floats of a vector (3,)."""
    x, y, z = (float(value) for value in vector)
    return x, y, z
