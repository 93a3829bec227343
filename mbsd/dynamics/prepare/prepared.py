"""A mechanism that is ready for forward dynamics, as data: arrays, independent rows, elimination sequence, start.

With it come points on curves that cross themselves, wheels that may meet, and how fast contacts approached when they
began: a simulation looks at these step by step.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.arrays.packing import Packed
from mbsd.compiling.jit import Often
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.large import MANY_COORDINATES
from mbsd.dynamics.prepare.stops import Stops, stops_of
from mbsd.dynamics.reference.arrays import Dynamics, Scratch, scratch_for
from mbsd.dynamics.state import PAUSED, TIME, State
from mbsd.dynamics.switches import JointStick, Switches
from mbsd.equations.interactions.switching import APPROACHED
from mbsd.equations.loads import Loads, remembers
from mbsd.kinematics.limits.free_wheels import FreeWheels
from mbsd.kinematics.pose.initial import Initial
from mbsd.results.views import Mobility

SHORTEST = 1e-9
"""A step may be divided down to this part of itself."""


class Following(CurveBranches):
    """The rows of a packed mechanism whose curves cross themselves, and the wheels that no body carries."""

    def __init__(self, packed: Packed) -> None:
        super().__init__(packed)
        self.wheels = FreeWheels(packed)

    def __bool__(self) -> bool:
        return bool(self.rows or self.wheels)


class Approaches:
    """Speeds that contacts of a mechanism remember, after each accepted step; kernels read and write the last."""

    def __init__(self, loads: Loads) -> None:
        self._now = loads.switch[1:, APPROACHED]
        self._asked = remembers(loads)
        self.forget()

    def __bool__(self) -> bool:
        return self._asked

    def forget(self) -> None:
        """Nothing has happened yet."""
        self._now[:] = np.nan
        self._times: list[float] = []
        self._speeds: list[np.ndarray] = []

    def copy(self) -> Approaches | None:
        """All that is noted, for results; None where no contact asks for it."""
        if not self._asked:
            return None
        out = object.__new__(Approaches)
        out._now, out._asked, out._times, out._speeds = self._now, True, [*self._times], [*self._speeds]
        return out

    def at(self, times: np.ndarray) -> np.ndarray:
        """(T, n) what was remembered in the steps that passed these times (m/s)."""
        none = np.full(len(self._now), np.nan)
        before = [bisect_left(self._times, t) - 1 for t in times]
        return np.array([none if k < 0 else self._speeds[k] for k in before]).reshape(len(times), -1)

    def recall(self, time: float) -> None:
        """Let kernels go on from this time (s)."""
        self._now[:] = self.at(np.array([time]))[0]

    def note(self, time: float) -> None:
        """Keep what is remembered at a time (s), and forget what was noted later, in steps that were taken back."""
        if self._asked:
            kept = bisect_left(self._times, time)
            del self._times[kept:], self._speeds[kept:]
            self._times.append(time)
            self._speeds.append(self._now.copy())

    def through(self, advance: Callable[..., int], arrays: Any, scratch: Any, state: State, *rest: Any) -> int:
        """``advance`` of an Integrator, a step at a time, with what each step leaves noted."""
        out, settings, end, steps = rest
        kept = bisect_right(self._times, float(state.clock[TIME]))
        del self._times[kept:], self._speeds[kept:]  # steps that were taken back
        for _ in range(steps):
            status = advance(arrays, scratch, state, out, settings, end, 1)
            self._times.append(float(state.clock[TIME]))
            self._speeds.append(self._now.copy())
            if status != PAUSED:
                return status
        return PAUSED


UNKNOWN = object()
"""Not looked for yet."""


@dataclass
class PreparedDynamics:
    """A mechanism that can be simulated over and over."""

    packed: Packed
    dynamics: Dynamics
    initial: Initial
    start: float
    end: float
    mobility: Mobility
    switches: Switches
    """The contacts and joints whose rows are released and held."""
    sticks: list[JointStick]
    """Joints that stick by events."""
    masses_apart: bool = False
    """True if masses of connected bodies are so far apart that the equations of motion are solved several times."""
    advancing: dict[tuple[str, type], Often] = field(default_factory=dict)
    """The loops of integrators by name and formulation."""
    dropped: tuple[int, ...] = ()
    """Rows left out because they repeat others."""
    independent: Any = UNKNOWN
    """The mechanism in independent coordinates that suit its start, None where there are none.

    See runs/embedding.py.
    """

    def loop(self, name: tuple[str, type], kernel: Callable[..., int]) -> Often:
        """Return the loop of this name and formulation, ready to be called over and over."""
        return self.advancing.setdefault(name, Often(kernel))

    @property
    def is_switched(self) -> bool:
        """True if steps are looked at one by one: rows of J come and go, or points and wheels are followed."""
        return bool(self.switches.contacts or self.sticks or self.switches.spare or self.following)

    @property
    def shares_loads(self) -> bool:
        """True if joints share loads in many ways, of which that of least norm is meant.

        Friction came from one of these ways; in large mechanisms one set of joints carries all.
        """
        large = self.packed.coordinates > MANY_COORDINATES
        return bool(self.mobility.redundant_rows) and not large and not len(self.dynamics.loads.friction)

    @cached_property
    def following(self) -> Following:
        """The points on curves that cross themselves."""
        return Following(self.packed)

    @cached_property
    def approaches(self) -> Approaches:
        """How fast contacts approached when they began."""
        return Approaches(self.dynamics.loads)

    @cached_property
    def stops(self) -> Stops:
        """Where steps end because loads or laws jump or are short there."""
        loads, laws, initial = self.dynamics.loads, self.dynamics.laws, self.initial
        return stops_of(self.packed, loads, laws, self.start, self.end, initial.q, initial.v)

    def evaluate_start(self) -> tuple[np.ndarray, np.ndarray, Scratch]:
        """Return d(state)/dt (2, 3 nb) and multipliers (m,) at the start, and the scratch of that evaluation."""
        packed, state = self.packed, np.stack([self.initial.q, self.initial.v])
        out, lam = np.zeros_like(state), np.zeros(len(packed.ws.phi))
        scratch = scratch_for(self.dynamics, packed.ws, len(packed.motions), 1)
        derivative(self.dynamics, scratch, self.start, state, out, lam)
        packed.specials.check()
        return out, lam, scratch

    def begun(self, times: np.ndarray) -> tuple[run_state.State, run_state.Output]:
        """A run at its consistent start, and room for its outputs."""
        self.following.settle(self.initial.q, self.initial.v)
        rows = len(self.packed.ws.phi)
        state = run_state.start_state(np.stack([self.initial.q, self.initial.v]), rows, float(times[0]))
        return state, run_state.output_for(times, len(self.initial.q), rows)
