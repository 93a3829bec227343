"""One mechanism in other words: other frames, another world, a base between it and ground.

Each function makes a new mechanism, with bodies of its own, that moves alike. A frame P of a body, given in its old
frame as (x, y, angle), takes a marker M to P^-1 M; G is the new frame of ground, so a start pose S becomes G^-1 S P and
an angle of body j against body i grows by angle(P_j) - angle(P_i). Kinds that name bodies instead of markers measure
that angle, and their law or number is raised by it.
"""

from __future__ import annotations

import copy
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.arrays.starts import started_at
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.formulas import ConstantRate, Cycloidal, Harmonic, Polynomial
from mbsd.model.laws.splines import Recorded, Table
from mbsd.model.mechanism import Start, StartVelocity

# Laws and curves moved by a constant, or with their sign changed, each as a law of its own kind where it has one.


@dataclass(frozen=True, eq=False)
class Raised(Motion):
    """sign times a law, and a constant."""

    law: Motion
    by: float
    sign: float

    @property
    def period(self) -> float | None:
        """Period of the law (s)."""
        return self.law.period

    def over(self, first: float, last: float) -> Motion:
        """The law made ready."""
        return Raised(self.law.over(first, last), self.by, self.sign)

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """(T,) times to (T, 3)."""
        return self.sign * self.law(times) + np.array([self.by, 0.0, 0.0])


def raised(law: Motion, by: float, sign: float = 1.0) -> Motion:
    """sign * law + by."""
    if by == 0.0 and sign == 1.0:
        return law
    if isinstance(law, ConstantRate):
        return replace(law, rate=sign * law.rate, start=sign * law.start + by)
    if isinstance(law, Harmonic):
        return replace(law, amplitude=sign * law.amplitude, mean=sign * law.mean + by)
    if isinstance(law, Cycloidal):
        return replace(law, rise=sign * law.rise, start=sign * law.start + by)
    if isinstance(law, Polynomial):
        first, *rest = law.coefficients
        return Polynomial((sign * first + by, *(sign * c for c in rest)))
    if isinstance(law, Table):
        return Table(law.times, sign * law.values + by, law.periodic)
    if isinstance(law, Recorded) and law.noise is not None:
        return Recorded(law.times, sign * law.values + by, law.noise)
    return Raised(law, by, sign)


def raised_curve(curve: Curve, by: float) -> Curve:
    """The same curve, its x counted from elsewhere."""
    return Curve(curve.x + by, curve.y, curve.kind)


Pose = tuple[float, float, float]
"""x, y (m) and angle (rad)."""
BASE = "welded base"
NOWHERE: Pose = (0.0, 0.0, 0.0)
ANGLES_OF_BODIES = {
    "drive_angle",
    "drive_relative_angle",
    "torsion_spring",
    "curve_of_angle",
    "torque",
    "one_way",
    "user_force",
    "force",
}
"""Kinds that name bodies, and that this file knows how to turn."""


def after(first: Pose, second: Pose) -> Pose:
    """The frame ``second``, given in the axes of ``first``, in the axes that ``first`` is given in."""
    c, s = math.cos(first[2]), math.sin(first[2])
    x, y = second[0], second[1]
    return first[0] + c * x - s * y, first[1] + s * x + c * y, first[2] + second[2]


def back(pose: Pose) -> Pose:
    """The frame that undoes one."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return -c * pose[0] - s * pose[1], s * pose[0] - c * pose[1], -pose[2]


def turnable(m: Mechanism) -> set[str]:
    """Return bodies, ground among them, whose frames may be turned.

    They are those that no kind unknown to this file measures.
    """
    fixed: set[str] = set()
    for entry in (*m.joints.values(), *m.drivers.values(), *m.forces.values(), *m.contacts.values()):
        method = getattr(m, entry.kind.name)
        names_bodies = any("Body" in str(p.annotation) for p in inspect.signature(method).parameters.values())
        if names_bodies and entry.kind.name not in ANGLES_OF_BODIES:
            fixed |= set(entry.bodies)
    return set(m.bodies) - fixed


def seen_from(m: Mechanism, frames: Mapping[str, Pose]) -> Mechanism:
    """The mechanism with other frames of its bodies, and of ground; bodies that are not named keep theirs."""
    ground = frames.get("ground", NOWHERE)
    world = back(ground)
    out = Mechanism(m.name)
    gx, gy = m.gravity or (0.0, 0.0)
    out.gravity = after((0.0, 0.0, world[2]), (gx, gy, 0.0))[:2]
    for name, body in m.bodies.items():
        if name != "ground":
            com = after(back(frames.get(name, NOWHERE)), (*body.com, 0.0))[:2]
            out.bodies[name] = Body(name, m.name, body.mass, com, body.inertia)

    def marker(old: Marker) -> Marker:
        x, y, angle = after(back(frames.get(old.body.name, NOWHERE)), (old.x, old.y, old.angle))
        return out.bodies[old.body.name].at(x, y, angle)

    def grows(entry: Joint | Force) -> float:
        first, second = (frames.get(name, NOWHERE)[2] for name in entry.bodies)
        return second - first

    for table, new in ((m.joints, out.joints), (m.drivers, out.drivers), (m.contacts, out.contacts)):
        for name, joint in table.items():
            params = _phased(joint, frames)
            i, j = marker(joint.i), marker(joint.j)
            motion = joint.motion
            if joint.kind.name in ("drive_angle", "drive_relative_angle"):
                assert motion is not None
                motion = raised(motion, grows(joint))
                i, j = (out.bodies[body].origin for body in joint.bodies)
            new[name] = replace(joint, i=i, j=j, params=params, motion=motion)
    for name, force in m.forces.items():
        out.forces[name] = _force(m, force, marker, grows(force), world, frames)
    out.traces.update({name: marker(old) for name, old in m.traces.items()})
    out.events.update(m.events)
    for name, start in m.starts.items():
        own = frames.get(name, NOWHERE)
        x, y, angle = after(world, after((*(start.place or (0.0, 0.0)), start.angle), own))
        out.starts[name] = Start(angle, None if start.place is None else (x, y))
    for name, velocity in m.velocities.items():
        out.velocities[name] = _velocity(velocity, m.starts.get(name), frames.get(name, NOWHERE), world)
    return out


def _velocity(old: StartVelocity, start: Start | None, own: Pose, world: Pose) -> StartVelocity:
    if old.place is None:
        return old
    c, s = (math.cos(start.angle), math.sin(start.angle)) if start is not None else (1.0, 0.0)
    arm = c * own[0] - s * own[1], s * own[0] + c * own[1]
    here = old.place[0] - old.omega * arm[1], old.place[1] + old.omega * arm[0]
    return StartVelocity(old.omega, after((0.0, 0.0, world[2]), (*here, 0.0))[:2])


def _phased(entry: Joint | Force, frames: Mapping[str, Pose]) -> dict[str, Any]:
    """Return the numbers of a joint or a force with the angles of its bodies in the new frames."""
    params, ground = dict(entry.params), frames.get("ground", NOWHERE)[2]
    if params.get("phase") is not None:
        params["phase"] = tuple(
            angle + frames.get(body, NOWHERE)[2] - ground
            for angle, body in zip(params["phase"], entry.bodies, strict=True)
        )
    return params


def _force(
    m: Mechanism,
    force: Force,
    marker: Callable[[Marker], Marker],
    grows: float,
    world: Pose,
    frames: Mapping[str, Pose],
) -> Force:
    """A force in other words; what it says in the axes of the world is turned."""
    params, laws = _phased(force, frames), dict(force.laws)
    i, j = marker(force.i), marker(force.j)
    name = force.kind.name
    if params.get("fires_at") is not None:
        crank, cylinder = (frames.get(body, NOWHERE)[2] for body in (params["crank"], force.bodies[0]))
        params["fires_at"] += crank - cylinder
    if name in ("torsion_spring", "bushing"):
        if "free_angle" in laws:
            laws["free_angle"] = raised(laws["free_angle"], grows)  # pyright: ignore[reportArgumentType]
        else:
            params["free_angle"] = params.get("free_angle", 0.0) + grows
    elif name == "curve_of_angle" and "of_angle" in laws:
        laws["of_angle"] = raised_curve(laws["of_angle"], grows)  # pyright: ignore[reportArgumentType]
    elif name == "force":
        params["direction"] = i.angle
    elif name == "drag":
        params["wind"] = after((0.0, 0.0, world[2]), (*params["wind"], 0.0))[:2]
        i = i.body.origin
    elif name == "rotating_frame":
        params["centre"] = after(world, (*params["centre"], 0.0))[:2]
        i, j = i.body.at(*params["centre"]), j.body.origin
    elif name == "user_force":
        params["function"] = _in_old_words(params["function"], params["bodies"], world, frames)
    return replace(force, i=i, j=j, params=params, laws=laws)


def _in_old_words(
    function: Callable[..., Any], bodies: list[str], world: Pose, frames: Mapping[str, Pose]
) -> Callable[..., Any]:
    """The user's function, given places in the old words and giving forces at the new frames' origins."""
    from numba.core.dispatcher import Dispatcher

    plain = function.py_func if isinstance(function, Dispatcher) else function
    poses = [frames.get(name, NOWHERE) for name in bodies]
    turn = (0.0, 0.0, world[2])

    def seen(t: float, q: np.ndarray, v: np.ndarray) -> list[float]:
        old_q, old_v, arms = [], [], []
        for k, own in enumerate(poses):
            x, y, theta = after(after(back(world), tuple(q[3 * k : 3 * k + 3])), back(own))  # pyright: ignore[reportArgumentType]
            vx, vy, _ = after(back(turn), (v[3 * k], v[3 * k + 1], 0.0))
            new = after(back(world), tuple(q[3 * k : 3 * k + 3]))  # pyright: ignore[reportArgumentType]
            arm = x - new[0], y - new[1]
            omega = v[3 * k + 2]
            old_q += [x, y, theta]
            old_v += [vx - omega * arm[1], vy + omega * arm[0], omega]
            arms.append(arm)
        pushed = list(plain(t, np.array(old_q), np.array(old_v)))
        out: list[float] = []
        for k, arm in enumerate(arms):
            fx, fy, torque = pushed[3 * k : 3 * k + 3]
            wx, wy, _ = after(turn, (fx, fy, 0.0))
            out += [wx, wy, torque + arm[0] * fy - arm[1] * fx]
        return out

    return seen


def on_a_base(m: Mechanism, world: Pose, mass: float = 0.0) -> Mechanism:
    """The whole carried off by ``world`` on a body that is welded to ground there."""
    out = seen_from(m, {"ground": back(world)})
    base = out.bodies[BASE] = Body(BASE, m.name, mass, (0.0, 0.0), mass)
    entries = dict(out.bodies)
    out.bodies.clear()
    out.bodies.update({"ground": entries.pop("ground"), BASE: entries.pop(BASE)} | entries)
    for old, new in ((m.joints, out.joints), (m.contacts, out.contacts), (m.drivers, out.drivers)):
        for name, entry in old.items():
            if entry.kind.name == "drive_angle":
                continue
            new[name] = _rehosted(entry, new[name], base)
    for name, force in m.forces.items():
        if force.kind.name in (
            "spring",
            "bushing",
            "actuator",
            "curve_of_length",
            "gravitation",
            "contact",
            "friction",
            "double_acting_cylinder",
        ):
            out.forces[name] = _rehosted(force, out.forces[name], base)
            if force.kind.name == "bushing":
                out.forces[name] = replace(out.forces[name], params=dict(force.params))
    out.weld(BASE, out.ground.at(*world), base.origin)
    out.starts[BASE] = Start(world[2], world[:2])
    return out


def _rehosted(old: Any, new: Any, base: Body) -> Any:
    """Markers that stood on ground stand on the base, where they were."""
    i, j = (
        base.at(was.x, was.y, was.angle) if was.body.name == "ground" else now
        for was, now in ((old.i, new.i), (old.j, new.j))
    )
    motion = {"motion": old.motion} if isinstance(new, Joint) and old.kind.name == "drive_relative_angle" else {}
    if motion and "ground" not in old.bodies:
        motion = {}
    return replace(new, i=i, j=j, **motion)


def restarted(m: Mechanism, sol: Solution, k: int) -> Mechanism:
    """The same mechanism that starts where a solution of it is at its output k."""
    states = None if sol.states is None else sol.states[k]
    return started_at(m, sol.packed, sol.q[k].ravel(), sol.v[k].ravel(), states)


def duplicate(m: Mechanism) -> Mechanism:
    """A mechanism of its own with equal contents."""
    return seen_from(copy.copy(m), {})
