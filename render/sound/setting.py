"""Setting of all sources of sound: the motion on the film's time, and where in the picture they are.

Sources work on series over the times of data.json, and bring them to the film by :meth:`Setting.series`; what happens
at one moment is at the film seconds that :meth:`Setting.when` gives. Both follow the film's TimeMap and nothing else: a
passage in slow motion is heard as it is seen.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from render.film.camera import angles
from render.film.clock import TimeMap
from render.film.film import Film
from render.film.framing import axes
from render.sound.ringing import Modes, modes_of
from render.sound.waves import quick_length
from shared.stage.errors import UserError

Array = NDArray[np.float64]
Item = TypeVar("Item")
RATE = 48_000
"""Samples a second."""
CONTROL = 1000
"""Values a second of whatever changes more slowly than a wave: levels, places, speeds."""
WIDEST = 0.8
"""Side at which things at the edge are heard, 0 .. 1."""
LONGEST = 300.0
"""Film seconds of a showing that has a sound: all of its waves are in memory at once."""
FADE = 0.012
"""Seconds in which a tone comes and goes where the film cuts."""


class Setting:
    """One showing of a film, as sources hear it."""

    def __init__(
        self, film: Film, time_map: TimeMap | None = None, within: tuple[float, float] = (-1.0, 1.0), streams: int = 0
    ) -> None:
        """Set up the motion on the film's time.

        ``time_map`` is of another film of the same motion, such as a story; it is that of the film's clock if not
        given.

        ``within`` is where the machine's picture begins and ends in the whole picture, -1 at its left edge, 1 at its
        right; ``streams`` is the number of the first stream of chance of its noises.

        That other film is shown once; here its last moment is held for some tenths of a second more, until a number of
        samples whose spectrum is quickly made. :attr:`heard_samples` are its own.

        Raises UserError where the showing is longer than what there is room for.
        """
        self.film, self.motion, self.map = film, film.motion, time_map or film.clock.time_map
        self.within, self.streams = within, streams
        self.seconds = self.map.seconds
        if self.seconds > LONGEST:
            raise UserError(
                f"{film.motion.mechanism}: a showing of the film lasts {self.seconds:.0f} s, and sound lasts "
                f"{LONGEST:.0f} s at most. Give the shot fewer seconds_per_turn, or film it with SOUND=off"
            )
        self.samples = self.heard_samples = max(64, round(self.seconds * RATE))
        """Samples of the ring, and those of the film in it."""
        if time_map is not None:  # a prime number of frames would take four times as long
            self.samples = quick_length(self.samples)
            self.map = self.map.held(self.samples / RATE)
            self.seconds = self.map.seconds
        self.time = np.asarray(film.motion.time)
        self.steps = max(16, round(self.seconds * CONTROL))
        self.at = np.linspace(0.0, self.seconds, self.steps + 1)
        """(M + 1,) film seconds of what changes slowly, both ends included."""
        self.model, self.rate = self.map.moments_at(self.at)
        """(M + 1,) moments of the motion (s), and its rate there."""

    def heard(self, items: Mapping[str, Item]) -> Iterator[tuple[str, Item]]:
        """Yield the items that the shot does not silence, by name."""
        silent = self.film.shot.sound.silent
        return ((name, item) for name, item in items.items() if name not in silent)

    def series(self, values: Array) -> Array:
        """Return (M + 1,) a series (T,) of the motion on the film's time."""
        return np.interp(self.model, self.time, values)

    def when(self, times: Array) -> tuple[Array, NDArray[np.intp]]:
        """Return the film seconds at which moments (n,) of the motion are shown, and the index of each."""
        film, index = self.map.when(np.asarray(times, float))
        return np.minimum(film, self.seconds), index

    def continued(self, way: Array) -> Array:
        """Return a way or phase (M + 1,) that goes on where the film jumps, at the speed around it.

        Else a jump would be heard as a burst of all that lies between.
        """
        steps, at = np.diff(way), np.flatnonzero(self.jumps)
        if not len(at):
            return way
        steps[at] = 0.0
        before, after = steps[np.maximum(at - 1, 0)], steps[np.minimum(at + 1, len(steps) - 1)]
        steps[at] = (before + after) / 2
        return way[0] + np.concatenate([[0.0], np.cumsum(steps)])

    @cached_property
    def jumps(self) -> NDArray[np.bool_]:
        """(M,) whether the film jumps to another moment between two values."""
        step = self.seconds / self.steps
        passed = step * (self.rate[:-1] + self.rate[1:]) / 2
        return np.abs(np.diff(self.model) - passed) > step * np.abs(np.diff(self.rate)) + 1e-9 * np.ptp(self.time)

    def closed(self, phase: Array) -> Array:
        """Return a phase (M + 1,) in cycles, so stretched that a film that loops has a whole number of them."""
        cycles = float(phase[-1] - phase[0])
        if not self.map.closes or abs(cycles) < 0.5:
            return phase
        return phase[0] + (phase - phase[0]) * (round(cycles) / cycles)

    def angle(self, body: str) -> Array:
        """Return (M + 1,) the angle of a body (rad), as exactly as the film shows it; 0 of ground."""
        return self.film.poses.over(body, self.model)[:, 2]

    def place(self, body: str, x: float, y: float) -> Array:
        """Return (M + 1, 2) where a point (x, y) of a body's frame is (m)."""
        pose = self.film.poses.over(body, self.model)
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        return pose[:, :2] + np.stack([c * x - s * y, s * x + c * y], axis=1)

    def modes(self, body: str) -> Modes | None:
        """Return the modes of a body, or of ground; None for one without solids."""
        if body not in self._modes:
            solids = self.film.parts.bodies.get(body)
            self._modes[body] = modes_of(solids) if solids else None
        return self._modes[body]

    @cached_property
    def _modes(self) -> dict[str, Modes | None]:
        return {}

    def mass(self, *bodies: str) -> float:
        """Return the mass (kg) that two bodies have as they push on each other; ground does not move."""
        masses = [self.motion.bodies[name].mass for name in bodies if name in self.motion.bodies]
        return 1.0 / sum(1.0 / max(mass, 1e-6) for mass in masses) if masses else 1.0

    def slip(self, bodies: tuple[str, str], x: Array, y: Array) -> Array:
        """Return the speed (T,; m/s) at which the second body slides on the first at places (T,; m).

        Places are of the world.
        """
        first, second = (self._velocity(body, x, y) for body in bodies)
        return np.hypot(*(second - first))

    def turning(self, bodies: tuple[str, str]) -> Array:
        """Return (T,) angular velocity of the second body against the first (rad/s)."""
        first, second = (
            np.asarray(self.motion.bodies[name].omega) if name in self.motion.bodies else np.zeros(len(self.time))
            for name in bodies
        )
        return second - first

    def _velocity(self, name: str, x: Array, y: Array) -> Array:
        if name not in self.motion.bodies:
            return np.zeros((2, len(self.time)))
        body = self.motion.bodies[name]
        omega = np.asarray(body.omega)
        return np.stack(
            [
                np.asarray(body.vx) - omega * (y - np.asarray(body.y)),
                np.asarray(body.vy) + omega * (x - np.asarray(body.x)),
            ]
        )

    def side(self, x: Array, y: Array) -> Array:
        """Return (M + 1,) where places (T,) of the world are heard: -1 at the left, 1 at the right.

        The edges of what moves are at the edges; the camera's distance, which is costly, is not asked for.
        """
        right, middle, half = self._across
        return self._laid(np.clip((self.series(right[0] * x + right[1] * y) - middle) / half, -1.0, 1.0))

    def side_of(self, body: str) -> Array:
        """Return (M + 1,) the same of a body's centre of mass; the middle of ground."""
        if body not in self.motion.bodies:
            return self._laid(np.zeros(self.steps + 1))
        moved = self.motion.bodies[body]
        c, s = np.cos(moved.theta), np.sin(moved.theta)
        x, y = moved.com
        return self.side(np.asarray(moved.x) + c * x - s * y, np.asarray(moved.y) + s * x + c * y)

    def _laid(self, side: Array) -> Array:
        """Return sides (n,) in the machine's picture as they are heard in the whole one."""
        low, high = self.within
        return (low + (high - low) * (side + 1) / 2) * WIDEST

    @cached_property
    def _across(self) -> tuple[Array, Array | float, float]:
        """Return the world's direction to the right (3,), the picture's middle along it, half its width (m)."""
        film, mount = self.film, self.film.parts.mount
        right = axes(*angles(film.shot.camera, mount, film.aspect), mount.up)[0]
        along = film.space.machine @ right
        low, high = float(along.min()), float(along.max())
        if film.travel is None:
            return right, (low + high) / 2, max((high - low) / 2, 1e-9)
        moments, _ = film.clock.time_map.moments_at(np.arange(len(film.travel)) / film.shot.fps)
        way = np.interp(self.model, moments, film.travel @ right)
        return right, way + float(right @ film.space.middle - way.mean()), max(film.size / 2, 1e-9)

    @cached_property
    def fade(self) -> Array:
        """Return (M + 1,) 0 where the film cuts to another moment, 1 away from there.

        Tones of two moments have two pitches. Where a period begins anew nothing changes.
        """
        cuts = self._cuts
        if not cuts:
            return np.ones_like(self.at)
        away = np.abs(self.at[:, None] - np.array(cuts))
        away = np.minimum(away, self.seconds - away).min(axis=1)
        return np.clip(away / FADE, 0.0, 1.0)

    @property
    def _cuts(self) -> list[float]:
        clock, pieces = self.film.clock, self.map.pieces
        whole = clock.end - clock.start if clock.repeats else np.inf
        jumps = {b.film[0]: abs(b.model[0] - a.model[1]) for a, b in pairwise(pieces)}
        return [cut for cut in self.map.cuts if abs(jumps.get(cut, 0.0) - whole) > 1e-6 * whole or cut not in jumps]
