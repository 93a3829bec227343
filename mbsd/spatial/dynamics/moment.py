"""The motion at one time, as functions and actions of events see it in space."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import described
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, no_such
from mbsd.compiling.callback import as_numbers
from mbsd.model.event import Event
from mbsd.spatial.model.body import Marker, place_given
from mbsd.spatial.model.rotation import rotation_matrix
from mbsd.spatial.results.frames import BodyMotion, marker_frame, slides_between
from mbsd.spatial.results.views import FrameView

if TYPE_CHECKING:
    from mbsd.spatial.arrays.packing import Packed


@dataclass(frozen=True)
class FrameNow(Suggesting):
    """A frame now: place (3,) in the world (m), orientation (w, x, y, z), velocity (m/s), w in the world (rad/s)."""

    place: np.ndarray
    orientation: np.ndarray
    velocity: np.ndarray
    w: np.ndarray

    @property
    def rotation(self) -> np.ndarray:
        """Rotation (3, 3) from the frame to the world."""
        return rotation_matrix(self.orientation)


@dataclass(frozen=True)
class JointNow(Suggesting):
    """Turn (rad, with its whole turns) and slide (m) of a joint now, with their rates; NaN where it has none."""

    turn: float
    turn_rate: float
    slide: float
    slide_rate: float


class Moment(Suggesting):
    """``moment.t``, ``moment.body("top").w``, ``moment.joint("hinge").turn``, ``moment.point(marker).place``."""

    def __init__(self, packed: Packed, t: float, q: np.ndarray, v: np.ndarray, counted: np.ndarray) -> None:
        self.packed, self._counted = packed, counted
        self.t = t
        """s"""
        self.q = q
        """(3 + 7 n,) see mbsd/spatial/equations/system.py."""
        self.v = v
        """(3 + 6 n,) or longer; angular velocities about principal axes."""

    def body(self, name: str) -> FrameNow:
        """Return a body's frame."""
        return self.point(self.packed.bodies[self._number(name)].origin)

    def point(self, marker: Marker) -> FrameNow:
        """Return a marker's frame."""
        seen = self._frame(marker)
        return FrameNow(seen.place[0], seen.orientation[0], seen.velocity[0], seen.w[0])

    def joint(self, name: str) -> JointNow:
        """Return turn and slide of a joint, and their rates."""
        known = {joint.name: joint for joint in self.packed.passive_joints}
        if name not in known:
            raise ModelError(f"{self.packed.name}: {no_such('joint', name, known)}")
        joint, out = known[name], [math.nan] * 4
        i, j = self._frame(joint.i), self._frame(joint.j)
        if joint.kind.turns:
            x, y, axis = i.rotation[0].T
            raw = math.atan2(y @ j.rotation[0, :, 0], x @ j.rotation[0, :, 0])
            rate, k = float(axis @ (j.w[0] - i.w[0])), self.packed.watched[name]
            led = self.packed.ws.guess[k] + 0.5 * (rate + self._counted[1 + k]) * (self.t - self._counted[0])
            out[:2] = raw + 2 * math.pi * round((led - raw) / (2 * math.pi)), rate
        if joint.kind.slides:
            value, rate, _ = slides_between(i, j)
            out[2:] = float(value[0]), float(rate[0])
        return JointNow(*out)

    def numbers(self, frames: Sequence[Marker]) -> tuple[np.ndarray, np.ndarray]:
        """Return place and Euler parameters of each frame in turn (7 f,), and their rates (6 f,)."""
        seen = [self._frame(marker) for marker in frames]
        places = [part[0] for frame in seen for part in (frame.place, frame.orientation)]
        rates = [part[0] for frame in seen for part in (frame.velocity, frame.w)]
        return np.concatenate(places), np.concatenate(rates)

    def set_velocity(self, name: str, velocity: Sequence[float], w: Sequence[float]) -> None:
        """Give a body's frame a velocity (m/s) and an angular velocity (rad/s), both in the world.

        What the joints forbid of it is then taken away.
        """
        self._move(self.packed.bodies[self._number(name)].origin, velocity, w)

    def act(self, event: Event) -> None:
        """Let the action of an event act. Raises ModelError where it fails."""
        action = event.action
        assert action is not None
        frames: Any = event.frames
        try:
            if frames:
                given = as_numbers(action(self.t, *self.numbers(frames)), 6 * len(frames)).reshape(-1, 6)
                for marker, numbers in zip(frames, given, strict=True):
                    self._move(marker, numbers[:3].tolist(), numbers[3:].tolist())
            else:
                action(self)
        except Exception as error:
            raise ModelError(
                f"{self.packed.name}: event '{event.name}': its action fails at t = {self.t:.6g} s: {described(error)}"
            ) from error

    def _move(self, marker: Marker, velocity: Sequence[float], w: Sequence[float]) -> None:
        what = f"{self.packed.name}: velocity of '{marker.body.name}' in an event"
        speed, spin = np.array(place_given(what, velocity)), np.array(place_given(what, w))
        b = self._number(marker.body.name)
        if b == 0:
            raise ModelError(f"{what}: ground does not move; name another body")
        c, d = 7 * b - 4, 6 * b - 3
        arm = self._frame(marker).place[0] - self.q[c : c + 3]
        self.v[d : d + 3] = speed - np.cross(spin, arm)
        self.v[d + 3 : d + 6] = rotation_matrix(self.q[c + 3 : c + 7]).T @ spin

    def _frame(self, marker: Marker) -> FrameView:
        b = self._number(marker.body.name)
        rest = np.zeros((1, 3))
        if b == 0:
            return marker_frame(marker, BodyMotion(rest, np.array([[1.0, 0, 0, 0]]), rest, rest, rest, rest))
        c, d = 7 * b - 4, 6 * b - 3
        e = self.q[None, c + 3 : c + 7]
        w = (rotation_matrix(e[0]) @ self.v[d + 3 : d + 6])[None]
        e = e / np.linalg.norm(e)
        return marker_frame(marker, BodyMotion(self.q[None, c : c + 3], e, self.v[None, d : d + 3], w, rest, rest))

    def _number(self, name: str) -> int:
        names = self.packed.body_names
        if name not in names:
            raise ModelError(f"{self.packed.name}: {no_such('body', name, names)}")
        return names.index(name)
