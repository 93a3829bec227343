"""A solved lift: moments that make its motion, forces of floor and pad, path of the bar, work.

The guides of a lift give its motion; the moments at the joints that make the same motion follow by inverse dynamics.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.quantity import written
from mbsd.machines.body.chain import MOMENTS
from mbsd.machines.body.figure import Figure
from mbsd.mechanism import Mechanism
from mbsd.results.solution import Solution

JOINTS = {"hip": "hip_extensors", "knee": "knee_extensors", "ankle": "plantarflexors", "shoulder": "shoulder_extensors"}


@dataclass(frozen=True, eq=False)
class Lift:
    """One repetition of a lift; (T,) or (T, 2) arrays in SI units, axes of ground.

    Both sides are taken together.
    """

    solution: Solution
    """The motion with the moments and reactions; its guides give nothing."""

    @property
    def t(self) -> np.ndarray:
        """Times (s)."""
        return self.solution.t

    def moment(self, joint: str) -> np.ndarray:
        """Return (T,) net moment (N m) at ``hip``, ``knee``, ``ankle`` or ``shoulder``.

        It is positive if it extends the joint.

        Raises ModelError for another joint, and for one that this lift does not move by itself.
        """
        effort = self.solution.force(self._named(joint)).effort
        assert effort is not None, "a torque has one"
        return effort

    def power(self, joint: str) -> np.ndarray:
        """Return (T,) what the muscles of a joint give (W); negative where they brake."""
        return self.solution.force(self._named(joint)).power

    def work(self, joint: str) -> tuple[float, float]:
        """Return the work (J) that a joint's muscles give and absorb in a repetition.

        The second is at most 0.
        """
        power = self.power(joint)
        given, taken = np.maximum(power, 0.0), np.minimum(power, 0.0)
        return float(np.trapezoid(given, self.t)), float(np.trapezoid(taken, self.t))

    def flexion(self, joint: str) -> np.ndarray:
        """Return (T,) flexion of ``hip``, ``knee`` or ``ankle`` (dorsiflexion; rad), 0 in standing."""
        angle = {name: self.solution.body(name).theta for name in ("foot", "shank", "thigh", "trunk")}
        flexions = {
            "hip": np.pi - angle["trunk"] + angle["thigh"],
            "knee": angle["thigh"] - angle["shank"],
            "ankle": angle["foot"] - angle["shank"] - np.pi / 2,
        }
        if joint not in flexions:
            raise ModelError(f"lift: there is no flexion of '{joint}'; known: {', '.join(flexions)}")
        return flexions[joint]

    @cached_property
    def floor(self) -> np.ndarray:
        """(T, 2) force of the floor on the feet (N)."""
        return self.solution.joint("floor").reaction

    @cached_property
    def pressure(self) -> np.ndarray:
        """(T,) where the floor pushes, in front of the ankle (m)."""
        joint = self.solution.joint("floor")
        return joint.x + (joint.torque - joint.y * joint.fx) / joint.fy

    @cached_property
    def pad(self) -> np.ndarray:
        """(T, 2) force of the pad on the back (N); 0 of a lift without a bench."""
        if "pad" not in self.solution.mechanism.joints:
            return np.zeros_like(self.floor)
        return -self.solution.joint("pad").reaction

    @cached_property
    def bar(self) -> np.ndarray:
        """(T, 2) way of the barbell's middle (m)."""
        point = self.solution.point("bar")
        return np.stack([point.x, point.y], axis=1)

    @cached_property
    def rising(self) -> np.ndarray:
        """(T,) whether the bar goes up."""
        return self.solution.point("bar").vy > 1e-9

    def _named(self, joint: str) -> str:
        known = {name: force for name, force in JOINTS.items() if force in self.solution.mechanism.forces}
        if joint not in known:
            raise ModelError(
                f"{self.solution.mechanism.name}: there is no moment at '{joint}'; known: {', '.join(known)}"
            )
        return known[joint]


def lifted(m: Mechanism, steps: int = 360) -> Lift:
    """Solve a repetition of a lift in ``steps`` equal steps.

    Raises what :func:`with_moments` and ``sweep`` raise.
    """
    return Lift(with_moments(m, m.sweep(steps=steps)))


def with_moments(m: Mechanism, motion: Solution) -> Solution:
    """Return the motion of a lift with the moments that make it, in place of its guides.

    Raises ModelError where floor or pad would have to pull, and what ``inverse_dynamics`` raises.
    """
    solution = m.inverse_dynamics(motion, [name for name in MOMENTS if name in m.forces]).solution
    lift = Lift(solution)
    trunk = solution.body("trunk").theta
    pushes = {"floor": lift.floor[:, 1]}
    if "pad" in m.joints:
        pushes["pad"] = lift.pad[:, 0] * np.sin(trunk) - lift.pad[:, 1] * np.cos(trunk)
    for name, push in pushes.items():
        worst = int(push.argmin())
        if push[worst] <= 0.0:
            raise ModelError(
                f"{m.name}: at t = {solution.t[worst]:.3g} s the {name} would have to pull by "
                f"{written(-push[worst], 'N')}; the lifter would fly off. Give the way up or down more time, or change "
                "posture or grip"
            )
    return solution


def peaks(m: Mechanism, figure: Figure, steps: int = 180) -> dict[str, float]:
    """Return a study's measures: largest moments (N m/kg), floor and pad (N), travel (m), work (J).

    Moments are for each kg of body mass. ``slip`` is the largest part of its normal force that the floor must hold by
    friction.
    """
    lift = lifted(m, steps)
    out = {joint: float(lift.moment(joint).max()) / figure.mass for joint in ("hip", "knee", "ankle")}
    out["knee flexors"] = -float(lift.moment("knee").min()) / figure.mass
    out["hip at the top"] = float(lift.moment("hip")[_at_top(lift)]) / figure.mass
    out["floor"] = float(np.hypot(*lift.floor.T).max())
    out["pad"] = float(np.hypot(*lift.pad.T).max())
    out["slip"] = float((np.abs(lift.floor[:, 0]) / lift.floor[:, 1]).max())
    out["travel"] = float(np.ptp(lift.bar[:, 1]))
    out["work of the hip"] = lift.work("hip")[0]
    return out


def _at_top(lift: Lift) -> int:
    """Return the row at which the bar is highest, in the middle of its pause there."""
    highest = np.flatnonzero(lift.bar[:, 1] >= lift.bar[:, 1].max() - 1e-12)
    return int(highest[len(highest) // 2])
