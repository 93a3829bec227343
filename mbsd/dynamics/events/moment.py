"""The motion at one time, as event functions and actions see it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.states import own_states, states_of
from mbsd.base.arguments import LARGEST, described
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, no_such, shown
from mbsd.compiling.callback import as_numbers
from mbsd.model.body import Marker, at_end, finite_number
from mbsd.model.event import Event

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


@dataclass(frozen=True)
class Frame(Suggesting):
    """A frame now: m, rad, m/s, rad/s."""

    x: float
    y: float
    theta: float
    vx: float
    vy: float
    omega: float


class Moment(Suggesting):
    """``moment.t``, ``moment.body("crank").omega``, ``moment.point(marker).x``; actions may also change it."""

    def __init__(self, packed: Packed, t: float, q: np.ndarray, v: np.ndarray) -> None:
        self.packed = packed
        self.t = t
        """s"""
        self.q = q
        """(3 nb,) centres of mass (m) and angles (rad)."""
        self.v = v
        """(3 nb,)"""
        self.released: list[int] = []
        """Numbers of the joints that an action released."""

    def body(self, name: str) -> Frame:
        """Return a body's frame."""
        return self._frame(self._number(name), (0.0, 0.0), 0.0)

    def point(self, marker: Marker) -> Frame:
        """Return a marker's frame; the end of a bar is where the bar ends in this mechanism, perhaps a changed copy."""
        return self._frame(self._number(marker.body.name), place_of(self.packed, marker), marker.angle)

    def numbers(self, frames: Sequence[Marker]) -> tuple[np.ndarray, np.ndarray]:
        """Return x, y, theta of each frame in turn (m, rad) and their rates: (3 f,) and (3 f,)."""
        seen = [self.point(marker) for marker in frames]
        places = [number for frame in seen for number in (frame.x, frame.y, frame.theta)]
        rates = [number for frame in seen for number in (frame.vx, frame.vy, frame.omega)]
        return np.array(places), np.array(rates)

    def state(self, force: str, name: str) -> float:
        """Return a state of a force (SI), such as ``pressure_a`` of a hydraulic cylinder; ModelError if unknown."""
        known = {
            with_states.name: with_states.kind.states.names
            for with_states in self.packed.forces
            if with_states.kind.states is not None
        }
        if not isinstance(force, str) or force not in known:
            raise ModelError(f"{self.packed.name}: {no_such('force with states', force, known)}")
        if name not in known[force]:
            raise ModelError(f"{self.packed.name}: force '{force}': {no_such('state', name, known[force])}")
        own = states_of(self.packed, self.v)[own_states(self.packed.forces, force)]
        return float(own[known[force].index(name)])

    def act(self, event: Event) -> None:
        """Let the action of an event act, and release its joints. Raises ModelError where it fails."""
        action = event.action
        assert action is not None
        try:
            if event.frames:
                given = action(self.t, *self.numbers(event.frames))
                self.set_numbers(event.frames, as_numbers(given, 3 * len(event.frames)))
            else:
                action(self)
        except Exception as error:
            raise ModelError(
                f"{self.packed.name}: event '{event.name}': its action fails at t = {self.t:.6g} s: {described(error)}"
            ) from error
        for name in event.releases:
            self.release(name)

    # -- for actions --------------------------------------------------------------------------------------------

    def set_velocity(self, name: str, vx: float, vy: float, omega: float) -> None:
        """Give a body's frame a velocity (m/s, m/s, rad/s); what the joints forbid of it is then taken away."""
        self._set_velocity(name, (0.0, 0.0), (vx, vy, omega))

    def set_numbers(self, frames: Sequence[Marker], velocities: np.ndarray) -> None:
        """Give frames velocities (3 f,), as :meth:`set_velocity` does."""
        for marker, velocity in zip(frames, velocities.reshape(-1, 3).tolist(), strict=True):
            self._set_velocity(marker.body.name, (marker.x, marker.y), velocity)

    def _set_velocity(self, name: str, place: tuple[float, float], velocity: Sequence[float]) -> None:
        what = f"{self.packed.name}: velocity of '{name}' in an event"
        vx, vy, omega = (finite_number(what, value) for value in velocity)
        b = self._number(name, moving=True)
        x, y = self._arm(b, place)
        self.v[3 * b : 3 * b + 3] = vx + omega * y, vy - omega * x, omega

    def push(self, marker: Marker, px: float, py: float, turning: float = 0.0) -> None:
        """Give an impulse (N s) at a marker and a turning impulse (N m s) to its body alone.

        Its joints are served afterwards, by the smallest change of velocities in the metric of the masses, which is
        what their impulses do. Raises ModelError for a body without mass.
        """
        what = f"{self.packed.name}: impulse on '{marker.body.name}' in an event"
        px, py, turning = (finite_number(what, value) for value in (px, py, turning))
        b = self._number(marker.body.name, moving=True)
        mass, inertia = self.packed.system.mass[b], self.packed.system.inertia[b]
        x, y = self._arm(b, (marker.x, marker.y))
        torque = turning + x * py - y * px
        if (mass == 0.0 and (px or py)) or (inertia == 0.0 and torque):
            raise ModelError(f"{what}: the body has mass {mass:g} kg and inertia {inertia:g} kg m^2; give it both")
        self.v[3 * b] += px / mass if px else 0.0
        self.v[3 * b + 1] += py / mass if py else 0.0
        self.v[3 * b + 2] += torque / inertia if torque else 0.0

    def release(self, joint: str) -> None:
        """Let a joint or driver go for good, as if it broke."""
        names = [candidate.name for candidate in self.packed.joints[: len(self.packed.joints) - self.packed.contacts]]
        if not isinstance(joint, str) or joint not in names:
            raise ModelError(f"{self.packed.name}: {no_such('joint to release', joint, names)}")
        self.released.append(names.index(joint))

    # -----------------------------------------------------------------------------------------------------------

    def _number(self, name: str, moving: bool = False) -> int:
        names = self.packed.body_names[1 if moving else 0 : len(self.packed.body_names) - self.packed.states]
        if not isinstance(name, str) or name not in names:
            raise ModelError(f"{self.packed.name}: {no_such('body', name, names)}")
        return self.packed.body_names.index(name)

    def _arm(self, b: int, place: tuple[float, float]) -> tuple[float, float]:
        """Return the vector (m), in world axes, from the centre of mass to a position in the author's frame."""
        x, y = place[0] - self.packed.com[b, 0], place[1] - self.packed.com[b, 1]
        c, s = math.cos(self.q[3 * b + 2]), math.sin(self.q[3 * b + 2])
        return c * x - s * y, s * x + c * y

    def _frame(self, b: int, place: tuple[float, float], turned: float) -> Frame:
        x, y = self._arm(b, place)
        qx, qy, theta = self.q[3 * b : 3 * b + 3]
        vx, vy, omega = self.v[3 * b : 3 * b + 3]
        return Frame(
            float(qx + x),
            float(qy + y),
            float(theta + turned),
            float(vx - omega * y),
            float(vy + omega * x),
            float(omega),
        )


def place_of(packed: Packed, marker: Marker) -> tuple[float, float]:
    """Return the place (m) of a marker in its body; at the end of a bar it is where the bar ends in this mechanism."""
    own, length = packed.bars.get(marker.body.name), marker.body.length
    x = own if own is not None and length is not None and at_end(marker, length) else marker.x
    return x, marker.y


def value_at(packed: Packed, event: Event, moment: Moment) -> float:
    """Return the value of an event; raises ModelError where the function fails or gives no finite number."""
    what = f"{packed.name}: event '{event.name}'"
    try:
        value = event.value_at(moment)
    except Exception as error:
        raise ModelError(f"{what}: its function fails at t = {moment.t:.6g} s: {described(error)}") from error
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    number = not isinstance(value, bool) and isinstance(value, int | float | np.floating | np.integer)
    if not number or not -LARGEST <= value <= LARGEST:
        raise ModelError(f"{what} is {shown(value)} at t = {moment.t:.6g} s; it must be a finite number")
    return float(value)
