"""MuJoCo: simulated, as it has no sweep; the driven shaft has an inertia that nothing slows down.

Gears are equalities of joint angles, loops "connect" or a slide along the slot, all of them soft by design, at the
highest impedance; the error is taken at the angle at which the shaft is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from benchmarks import calls, machines

VERSION = mujoco.__version__
CONTACT_STEPS = 100_000
CONTACT_INTEGRATOR = "implicitfast"
HEAVY = 1e8


def settings(problem: str) -> str:
    """In words."""
    if problem == machines.CONTACT:
        return f"sphere on a plane, {CONTACT_INTEGRATOR}, {CONTACT_STEPS} steps"
    return f"RK4, Newton, softness 2, {machines.STEPS} steps"


def _body(name: str, x: float, y: float, inner: str = "", inertia: float = 1.0) -> str:
    """With its hinge at (x, y) of its parent, at the start pose unturned."""
    return (
        f'<body name="{name}" pos="{x!r} {y!r} 0"><joint name="{name}" type="hinge" axis="0 0 1"/>'
        f'<inertial pos="0 0 0" mass="1" diaginertia="{inertia} {inertia} {inertia}"/>{inner}</body>'
    )


def _soft() -> str:
    return 'solimp="0.9999 0.9999 0.001 0.5 2"'


def _planetary() -> tuple[str, str, str]:
    theta = calls.START[0]
    inner = _body("planet", calls.CRANK, 0.0) + _body("coupler", calls.CRANK, 0.0)
    bodies = _body("sun", 0.0, 0.0, inertia=HEAVY) + _body("carrier", 0.0, 0.0, inner)
    bodies += _body("rocker", calls.GROUND, 0.0)
    x, y = calls.COUPLER * math.cos(theta), calls.COUPLER * math.sin(theta)
    planet = -machines.SUN / machines.PLANET * (1 - machines.RATIO)
    equal = f'<connect body1="coupler" body2="rocker" anchor="{x!r} {y!r} 0" SOFT/>'
    for name, factor in (("carrier", machines.RATIO), ("planet", planet)):
        equal += f'<joint joint1="{name}" joint2="sun" polycoef="0 {factor!r} 0 0 0" SOFT/>'
    return bodies, equal, "sun"


def _geneva() -> tuple[str, str, str]:
    start = float(machines.exact(machines.GENEVA, np.array([-machines.INDEX]))[0, 0])
    x, y = machines.RADIUS * math.cos(-machines.INDEX), machines.RADIUS * math.sin(-machines.INDEX)
    slide = (
        f'<body name="slide" pos="{x - machines.DISTANCE!r} {y!r} 0"><joint name="slide" type="slide" '
        f'axis="{math.cos(start)!r} {math.sin(start)!r} 0"/><inertial pos="0 0 0" mass="0.01" '
        'diaginertia="1e-4 1e-4 1e-4"/></body>'
    )
    bodies = _body("crank", 0.0, 0.0, inertia=HEAVY) + _body("wheel", machines.DISTANCE, 0.0, slide)
    return bodies, '<connect body1="slide" body2="crank" anchor="0 0 0" SOFT/>', "crank"


def _cam() -> tuple[str, str, str]:
    start = float(machines.exact(machines.CAM, np.zeros(1))[0, 0])
    x, y = machines.PIVOT + machines.ARM * math.cos(start), machines.ARM * math.sin(start)
    bodies = _body("cam", 0.0, 0.0, _body("rod", machines.ECCENTRIC, 0.0), HEAVY) + _body("arm", machines.PIVOT, 0.0)
    anchor = f"{x - machines.ECCENTRIC!r} {y!r} 0"
    return bodies, f'<connect body1="rod" body2="arm" anchor="{anchor}" SOFT/>', "cam"


SWEEPS = {machines.PLANETARY: _planetary, machines.GENEVA: _geneva, machines.CAM: _cam}
WATCHED = {
    machines.PLANETARY: (("carrier", "coupler"), ("rocker",)),
    machines.GENEVA: (("wheel",),),
    machines.CAM: (("arm",),),
}
"""Joints whose angles add up to each angle that counts."""


def prepare(problem: str) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` makes one of its own."""
    if problem == machines.CONTACT:
        return _falling()
    bodies, equal, driven = SWEEPS[problem]()
    first, last = machines.SPAN[problem]
    step = (last - first) / machines.STEPS
    soft = f'solref="{2 * step!r} 1" {_soft()}'
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler angle="radian" autolimits="false"/>'
        f'<option timestep="{step!r}" integrator="RK4" gravity="0 0 0" tolerance="1e-12">'
        '<flag contact="disable" refsafe="disable"/></option>'
        f"<worldbody>{bodies}</worldbody><equality>{equal.replace('SOFT', soft)}</equality></mujoco>"
    )
    data = mujoco.MjData(model)
    names = [model.joint(k).name for k in range(model.njnt)]
    whole = machines.exact(problem, np.array([first - 1e-6, first, first + 1e-6]))
    rates = np.unwrap(whole, axis=0)
    rates = (rates[2] - rates[0]) / 2e-6

    def reset() -> None:
        mujoco.mj_resetData(model, data)
        data.qvel[model.joint(driven).dofadr[0]] = 1.0
        if problem == machines.PLANETARY:
            data.qvel[model.joint("carrier").dofadr[0]] = machines.RATIO
            planet = -machines.SUN / machines.PLANET * (1 - machines.RATIO)
            data.qvel[model.joint("planet").dofadr[0]] = planet
        for joints, rate in zip(WATCHED[problem], rates, strict=True):
            before = sum(data.qvel[model.joint(name).dofadr[0]] for name in joints[:-1])
            data.qvel[model.joint(joints[-1]).dofadr[0]] = rate - before
        if problem == machines.GENEVA:
            reach = [math.dist((machines.DISTANCE, 0), _pin(first + x)) for x in (-1e-6, 1e-6)]
            data.qvel[model.joint("slide").dofadr[0]] = (reach[1] - reach[0]) / 2e-6
        if problem == machines.CAM:
            tips = [_rod(first + x) for x in (-1e-6, 1e-6)]
            data.qvel[model.joint("rod").dofadr[0]] = (tips[1] - tips[0]) / 2e-6 - 1.0
        mujoco.mj_forward(model, data)

    def fresh() -> Callable[[], Any]:
        reset()
        return lambda: mujoco.mj_step(model, data, machines.STEPS)

    def error(_: Any) -> float:
        reset()
        out = 0.0
        for _step in range(machines.STEPS):
            mujoco.mj_step(model, data)
            at = dict(zip(names, data.qpos, strict=True))
            wanted = machines.exact(problem, np.array([first + at[driven]]))[0]
            for k, joints in enumerate(WATCHED[problem]):
                angle = whole[1, k] + sum(at[name] for name in joints)
                out = max(out, machines.worst(np.array(angle), np.array(wanted[k])))
        return out

    return fresh, error


def _pin(phi: float) -> tuple[float, float]:
    return machines.RADIUS * math.cos(phi), machines.RADIUS * math.sin(phi)


def _rod(phi: float) -> float:
    """Angle of the line from the disc's centre to the roller (rad)."""
    arm = float(machines.exact(machines.CAM, np.array([phi]))[0, 0])
    x = machines.PIVOT + machines.ARM * math.cos(arm) - machines.ECCENTRIC * math.cos(phi)
    return math.atan2(machines.ARM * math.sin(arm) - machines.ECCENTRIC * math.sin(phi), x)


def _falling() -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    step = machines.DURATION / CONTACT_STEPS
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{step!r}" integrator="{CONTACT_INTEGRATOR}" gravity="0 0 {-machines.GRAVITY}">'
        '<flag refsafe="disable" eulerdamp="disable"/></option>'
        f'<worldbody><geom type="plane" size="1 1 1" solref="{-machines.STIFFNESS} 0" {_soft()} friction="0 0 0" '
        f'condim="1"/><body pos="0 0 {machines.HEIGHT + 0.1}"><joint type="slide" axis="0 0 1"/>'
        f'<geom type="sphere" size="0.1" mass="1" condim="1" friction="0 0 0" solref="{-machines.STIFFNESS} 0" '
        f"{_soft()}/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)

    def fresh() -> Callable[[], Any]:
        mujoco.mj_resetData(model, data)
        mujoco.mj_forward(model, data)
        return lambda: mujoco.mj_step(model, data, CONTACT_STEPS)

    def error(_: Any) -> float:
        return abs(float(data.qpos[0]) + machines.HEIGHT - machines.height(machines.DURATION))

    return fresh, error
