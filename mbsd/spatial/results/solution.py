"""Results of a mechanism in space by name: arrays over time, SI units.

sol.t                                (T,) s
sol.body("rod").place                (T, 3) of the body's frame; orientation (w, x, y, z), velocity, w, acceleration
sol.joint("bearing").force           (T, 3) on the joint's second body, in the world; moment, local_force, along
sol.joint("bearing").turn            also turn_rate, slide, slide_rate
sol.driver("motor").torque           also effort, force, value, rate, power
sol.force("spring").effort           (T,) and value, rate, power; of several rows (T, rows)
sol.point("P").place                 of traced points
sol.energy.kinetic, .potential
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, no_such
from mbsd.base.quantity import counted
from mbsd.model.event import Happening
from mbsd.results.solution import RETURNED
from mbsd.results.views import DriverView, EnergyView, Mobility, Stats
from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.results.forces import ForceView, WrenchView, force_values, force_view, wrench_view
from mbsd.spatial.results.frames import (
    body_motion,
    marker_frame,
    moved_frame,
    slides_between,
    turns_between,
)
from mbsd.spatial.results.reactions import Beside, residuals, with_reactions
from mbsd.spatial.results.views import FrameView, JointView

if TYPE_CHECKING:
    from mbsd.spatial.arrays.packing import Packed


@dataclass(frozen=True, eq=False)
class Solution(Suggesting):
    """Motion of one mechanism. ``motion`` holds all steps, ``wanted`` marks the outputs."""

    other_words = MappingProxyType(
        {"bodies": "body", "joints": "joint", "drivers": "driver", "points": "point", "time": "t", "kinetic": "energy"}
    )

    mechanism: Any
    """The mechanism that was solved."""
    packed: Packed = field(repr=False)
    motion: Any = field(repr=False)
    """mbsd.spatial.kinematics.newton.DrivenMotion"""
    wanted: np.ndarray = field(repr=False)
    mobility: Mobility
    laws: Any = field(repr=False)
    """Laws of drivers and forces, as kernels read them."""
    starts: Mapping[str, Any] = field(repr=False)
    """Turns (rad) and slides (m) that start_near gave; of many motions (R,)."""
    beside: Sequence[Beside] = field(default=(), repr=False)
    """Motions beside change points."""
    inserted_steps: int = 0
    """Steps added between outputs to stay on the branch."""
    steps: int = 0
    """Steps of a simulation."""
    work: np.ndarray | None = field(default=None, repr=False)
    """(T,) of drivers since the start (J), of a simulation."""
    changes: tuple[str, ...] = ()
    """Changes of the given start that made a simulation consistent."""
    events: tuple[Happening, ...] = ()
    """Events of a simulation, in order."""
    formulation: str = ""
    """Coordinates of a simulation: "reference" or "tree"."""

    @cached_property
    def t(self) -> np.ndarray:
        """(T,) s"""
        return self.motion.times[self.wanted]

    @cached_property
    def q(self) -> np.ndarray:
        """(T, 3 + 7 n) coordinates; see mbsd/spatial/equations/system.py."""
        return self.motion.q[self.wanted]

    @cached_property
    def v(self) -> np.ndarray:
        """(T, 3 + 6 n) velocities in the world."""
        return self.motion.v[self.wanted]

    @cached_property
    def a(self) -> np.ndarray:
        """(T, 3 + 6 n) accelerations in the world."""
        return self.motion.a[self.wanted]

    @cached_property
    def lam(self) -> np.ndarray:
        """(T, m) multipliers."""
        return self._whole.lam[self.wanted]

    @cached_property
    def _whole(self) -> Any:
        """The motion with multipliers and wrenches, which are found when they are first asked for."""
        return with_reactions(self.packed, self.laws, self.motion, self.mobility.redundant_rows, self.beside)

    def body(self, name: str) -> FrameView:
        """Return the motion of a body's frame."""
        b = self._index(name, self.packed.body_names, "body")
        body = self.packed.bodies[b]
        return moved_frame(body, body_motion(b, self.q, self.v, self.a), np.zeros(3), np.eye(3))

    def point(self, name: str) -> FrameView:
        """Return the motion of a traced point."""
        self._index(name, list(self.mechanism.traces), "traced point")
        return self.place(self.mechanism.traces[name])

    def place(self, marker: Marker) -> FrameView:
        """Return the motion of a marker of the mechanism."""
        b = self._index(marker.body.name, self.packed.body_names, "body")
        return marker_frame(marker, body_motion(b, self.q, self.v, self.a))

    def joint(self, name: str) -> JointView:
        """Return place, reaction, turn and slide of a joint."""
        joints = self.packed.passive_joints
        k = self._index(name, [joint.name for joint in joints], "joint")
        joint, wrench = joints[k], self._whole.wrench[self.wanted, k]
        i, j = self._frames_of(joint)
        return JointView(
            name=name,
            kind=joint.kind.name,
            place=j.place[self.wanted],
            axes=i.rotation[self.wanted],
            force=wrench[:, :3],
            moment=wrench[:, 3:],
            turns=self._turns(joint, i, j) if joint.kind.turns else None,
            slides=self._of_outputs(slides_between(i, j)) if joint.kind.slides else None,
        )

    def measured(self, joint: Joint, what: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return "turn" (rad) or "slide" (m) of a joint that has it, with its derivatives by time (T,)."""
        i, j = self._frames_of(joint)
        return self._turns(joint, i, j) if what == "turn" else self._of_outputs(slides_between(i, j))

    def driver(self, name: str) -> DriverView:
        """Return value, effort and power of a driver."""
        k = self._index(name, self.packed.driver_names, "driver")
        driver: Joint = self.packed.drivers[k]
        value, rate, acceleration = self.motion.drives[self.wanted, k + 1].T
        effort = -self.lam[:, self.packed.driver_rows + k]
        return DriverView(name, driver.kind.angular, value, rate, acceleration, effort)

    def force(self, name: str) -> ForceView | WrenchView:
        """Return what a force measures, its effort and power; of a function its forces and moments."""
        k = self._index(name, [force.name for force in self.packed.forces], "force")
        if self.packed.forces[k].call is not None:
            return wrench_view(self.packed, k, self.motion, self.wanted)
        return force_view(self.packed, k, self._whole, self.wanted)

    @cached_property
    def energy(self) -> EnergyView:
        """Kinetic and potential energy, springs included; weight counts from the origin."""
        system, count = self.packed.system, len(self.t)
        rates, poses = self.v[:, 3:].reshape(count, -1, 6), self.q[:, 3:].reshape(count, -1, 7)
        kinetic = 0.5 * (system.mass[1:] * (rates[..., :3] ** 2).sum(axis=2)).sum(axis=1)
        for b in range(1, len(system.mass)):
            body = self.packed.bodies[b]
            spin = self.body(body.name).w_body @ body.principal[1]
            kinetic = kinetic + 0.5 * (system.inertia[b] * spin**2).sum(axis=1)
        potential = -(system.mass[1:] * (poses[..., :3] @ system.gravity)).sum(axis=1)
        for k, force in enumerate(self.packed.forces):
            if force.call is not None:
                potential = potential + wrench_view(self.packed, k, self.motion, self.wanted).energy
                continue
            values, _ = force_values(self.packed, k, self.motion, self.wanted)
            for push, x in zip(force.pushes, values.T, strict=True):
                potential = potential + 0.5 * push.stiffness * (x - push.free) ** 2
        return EnergyView(kinetic, potential)

    @cached_property
    def period(self) -> float | None:
        """The time spanned (s) if all returns to the start: poses, velocities, accelerations; else None."""
        first, last = (self.q[k, 3:].reshape(-1, 7).copy() for k in (0, -1))
        last[:, 3:] *= np.where((first[:, 3:] * last[:, 3:]).sum(axis=1, keepdims=True) < 0.0, -1.0, 1.0)
        pairs = ((first, last), (self.v[0], self.v[-1]), (self.a[0], self.a[-1]))
        gaps = (np.abs(end - start).max() <= RETURNED * max(1.0, float(np.abs(start).max())) for start, end in pairs)
        return float(self.t[-1] - self.t[0]) if all(gaps) else None

    @cached_property
    def stats(self) -> Stats:
        """How well the motion fulfils its equations: largest residuals over all steps and rows."""
        steps = self.steps or len(self.motion.times)
        return Stats(*residuals(self.packed, self.laws, self._whole), steps, self.inserted_steps)

    def _begin(self, joint: Joint) -> Any:
        """Return the turn (rad) near which a joint starts, as a driver or start_near has it."""
        for k, driver in enumerate(self.packed.drivers):
            if driver.kind.angular and driver.coupled[0] is joint:
                return float(self.motion.drives[0, k + 1, 0])
        return self.starts.get(joint.name, 0.0)

    def _frames_of(self, joint: Joint) -> list[FrameView]:
        """Return the motions of a joint's markers at all steps."""
        out = []
        for marker in (joint.i, joint.j):
            b = self.packed.body_names.index(marker.body.name)
            out.append(marker_frame(marker, body_motion(b, self.motion.q, self.motion.v, self.motion.a)))
        return out

    def _turns(self, joint: Joint, i: FrameView, j: FrameView) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self._of_outputs(turns_between(i, j, self.motion.times, self._begin(joint)))

    def _of_outputs(self, parts: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        first, second, third = (part[self.wanted] for part in parts)
        return first, second, third

    def _index(self, name: object, known: list[str], what: str) -> int:
        if name not in known:
            raise ModelError(f"{self.packed.name}: {no_such(what, name, known)}")
        return known.index(name)  # pyright: ignore[reportArgumentType]

    def __repr__(self) -> str:
        outputs = counted(len(self.t), "output")
        return f"<Solution of {self.packed.name}: {outputs}, {self.t[0]:g} .. {self.t[-1]:g} s>"
