"""MuJoCo: trees of hinges and balls by RK4; loops are closed by soft rows at the highest impedance.

It has no sweep: the crank turns at its rate with an inertia that nothing slows down, in as many steps as there are
poses, and the error is taken at the turn at which it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from mujoco import rollout

from benchmarks import space

VERSION = mujoco.__version__
COUNTS = dict(zip(space.PROBLEMS, (800, 310, 750, 980, 700, space.STEPS), strict=True))
"""Steps of each problem, the fewest that keep its limit."""
HEAVY = 1e8
SOFT = 'solimp="0.9999 0.9999 0.001 0.5 2"'


def settings(problem: str) -> str:
    """Return the settings of a run in words."""
    if problem == space.BATCH:
        return f"rollout, one thread, RK4, {COUNTS[space.TOP]} steps"
    loop = ", Newton, softness 2" if problem in (space.BRICARD, space.SWEEP) else ""
    return f"RK4{loop}, {COUNTS[problem]} steps"


def _numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)


def _inertial(mass: float, com: Any, moments: Any) -> str:
    return f'<inertial pos="{_numbers(com)}" mass="{mass}" diaginertia="{_numbers(moments)}"/>'


def _top() -> tuple[str, str]:
    inner = _inertial(space.TOP_MASS, (0, 1, 0), space.TOP_MOMENTS)
    return f'<body><joint type="ball"/>{inner}<site name="watched" pos="0 1 0"/></body>', ""


def _chain(count: int) -> tuple[str, str]:
    body = f'<site name="watched" pos="{space.LINK} 0 0"/>'
    for k in range(count, 0, -1):
        place = f"{space.LINK if k > 1 else 0.0} 0 0"
        joints = '<joint type="hinge" axis="0 1 0"/><joint type="hinge" axis="0 0 1"/>'
        inner = _inertial(space.LINK_MASS, (space.LINK / 2, 0, 0), space.LINK_MOMENTS)
        body = f'<body pos="{place}">{joints}{inner}{body}</body>'
    return body, ""


def _bricard() -> tuple[str, str]:
    """Return a tree of five hinges, and the last as two points of its axis that coincide."""
    corners = np.array(space.CORNERS, float)
    body = ""
    for k in range(5, 0, -1):
        moved = corners[k - 1] - (corners[k - 2] if k > 1 else 0.0)
        inner = _inertial(1.0, (corners[k] - corners[k - 1]) / 2, space.moments_of_rod(k))
        if k == 3:
            inner += f'<site name="watched" pos="{_numbers(corners[3] - corners[2])}"/>'
        axis = _numbers(space.AXES[k - 1])
        body = f'<body name="rod{k}" pos="{_numbers(moved)}"><joint type="hinge" axis="{axis}"/>{inner}{body}</body>'
    end = corners[5] - corners[4]
    ties = "".join(
        f'<connect body1="rod5" body2="world" anchor="{_numbers(end + shift * np.array(space.AXES[5]))}" SOFT/>'
        for shift in (0.0, 0.5)
    )
    return body, ties


def _slider_crank() -> tuple[str, str]:
    bearing, pin, eye = (np.array(place) for place in (space.BEARING, space.PIN, space.EYE))
    along = pin - eye
    second = np.cross((0, 0, 1), along)
    heavy = _inertial(0.12, (0, 0, 0.04), (HEAVY, HEAVY, HEAVY))
    crank = (
        f'<body name="crank" pos="{_numbers(bearing)}"><joint name="motor" type="hinge" axis="1 0 0"/>{heavy}</body>'
    )
    cross = '<joint type="hinge" axis="0 0 1"/>' + f'<joint type="hinge" axis="{_numbers(second)}"/>'
    rod = f'<body name="rod">{cross}{_inertial(0.5, along / 2, (0.004, 0.004, 0.004))}</body>'
    slide = '<joint type="slide" axis="1 0 0"/>' + _inertial(2.0, (0, 0, 0), (1e-4, 1e-4, 1e-4))
    slider = f'<body pos="{_numbers(eye)}">{slide}{rod}<site name="watched" pos="0 0 0"/></body>'
    return crank + slider, f'<connect body1="rod" body2="crank" anchor="{_numbers(along)}" SOFT/>'


def _model(problem: str, steps: int) -> Any:
    bodies, ties = {space.TOP: _top, space.BRICARD: _bricard, space.SWEEP: _slider_crank}.get(
        problem, lambda: _chain(space.CHAINS[problem])
    )()
    step = space.DURATION[problem] / steps
    gravity = {space.BRICARD: "0 -9.81 0", space.SWEEP: "0 0 0"}.get(problem, "0 0 -9.81")
    soft = f'solref="{2 * step!r} 1" {SOFT}'
    return mujoco.MjModel.from_xml_string(
        '<mujoco><compiler angle="radian" autolimits="false"/>'
        f'<option timestep="{step!r}" integrator="RK4" gravity="{gravity}" tolerance="1e-12">'
        '<flag contact="disable" refsafe="disable"/></option>'
        f"<worldbody>{bodies}</worldbody><equality>{ties.replace('SOFT', soft)}</equality></mujoco>"
    )


def prepare(problem: str, count: int = 0) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` looks at where it ended."""
    if problem == space.BATCH:
        return _prepare_batch(count)
    steps = count or COUNTS[problem]
    model = _model(problem, steps)
    data = mujoco.MjData(model)

    def fresh() -> Callable[[], Any]:
        mujoco.mj_resetData(model, data)
        if problem == space.TOP:
            data.qvel[:] = space.SPIN
        elif problem in space.CHAINS:
            data.qvel[1] = 3.0
        elif problem == space.SWEEP:
            _start_crank(model, data)
        mujoco.mj_forward(model, data)
        return lambda: mujoco.mj_step(model, data, steps)

    def error(_: Any) -> float:
        if problem != space.SWEEP:
            mujoco.mj_forward(model, data)
            return space.error_at_end(problem, data.site("watched").xpos)
        fresh()
        out = 0.0
        for _step in range(steps):
            mujoco.mj_step(model, data)
            wanted = space.slide(data.joint("motor").qpos)[0]
            mujoco.mj_kinematics(model, data)
            out = max(out, abs(float(data.site("watched").xpos[0] - wanted)))
        return out

    return fresh, error


def _prepare_batch(count: int) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    steps = count or COUNTS[space.TOP]
    model = _model(space.TOP, steps)
    data = mujoco.MjData(model)
    kept = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states = np.zeros((space.COUNT, mujoco.mj_stateSize(model, kept)))
    for state, spin in zip(states, space.spins(), strict=True):
        data.qvel[:] = spin
        mujoco.mj_getState(model, data, state, kept)

    def run() -> np.ndarray:
        return rollout.rollout(model, data, states, nstep=steps)[0]

    def error(run: np.ndarray) -> float:
        mujoco.mj_setState(model, data, run[0, -1], kept)
        mujoco.mj_forward(model, data)
        return space.error_at_end(space.TOP, data.site("watched").xpos)

    return lambda: run, error


def _start_crank(model: Any, data: Any) -> None:
    """Set velocities that close the loop at the start: the slider's, and the two of the cross."""
    data.qvel[0] = space.RATE
    small = 1e-6
    turns = space.RATE * small * np.array([-1.0, 1.0])
    reach = space.slide(turns)
    data.qvel[1] = (reach[1] - reach[0]) / (2 * small)
    mujoco.mj_forward(model, data)
    rows = data.efc_J.reshape(-1, model.nv) if mujoco.mj_isSparse(model) == 0 else None
    assert rows is not None
    rows = rows[: data.nefc]
    free = np.linalg.lstsq(rows[:, 2:], -rows[:, :2] @ data.qvel[:2], rcond=None)[0]
    data.qvel[2:] = free
    assert math.isclose(float(np.abs(rows @ data.qvel).max()), 0.0, abs_tol=1e-6)
