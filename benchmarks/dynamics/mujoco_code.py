"""MuJoCo: trees of hinges; loops are closed by its soft "connect" constraints, as stiff as the step allows."""

from __future__ import annotations

import itertools
import time

import mujoco
import numpy as np

from benchmarks.dynamics.problems import Plain, Problem

VERSION = mujoco.__version__


def _candidates(steps: tuple[float, ...], softness: tuple[float, ...]) -> list[dict]:
    return [
        {"integrator": way, "step": step, "time_constant": soft * step}
        for step, way, soft in itertools.product(steps, ("RK4", "implicitfast"), softness)
    ]


_LOOPS = _candidates((0.01, 0.005, 0.002, 0.001, 0.0005), (2.0, 4.0))
CANDIDATES = {
    "A01": _candidates((0.04, 0.02, 0.01, 0.005, 0.002), (2.0,)),
    "A02 N=1": _LOOPS,
    "A02 N=10": _LOOPS,
    "A02 N=40": _candidates((0.005, 0.002, 0.001), (2.0,)),
    "A03": [],
}
"""A03's closed loops with masses of grams are beyond the soft constraints at the error asked for: not run."""


def _text(plain: Plain, settings: dict) -> tuple[str, list[int]]:
    """The model as MuJoCo's XML, and the body (or -1) that each body hangs on, by its first pin."""
    parent: dict[int, tuple] = {}
    loops = []
    seen = {-1}
    open_pins = list(plain.pins)
    while open_pins:
        for pin in open_pins:
            i, xi, yi, j, xj, yj = pin
            if (i in seen) != (j in seen):
                child = (i, (j, xj, yj), (xi, yi)) if j in seen else (j, (i, xi, yi), (xj, yj))
                parent[child[0]] = child[1:]
                seen.add(child[0])
                open_pins.remove(pin)
                break
        else:
            loops, open_pins = open_pins, []

    def body(number: int) -> str:
        (base, bx, by), (x, y) = parent[number]
        # the body's frame sits in its pin, axes as at the start; the parent's frame likewise
        if base < 0:
            px, py = bx, by
            turn = plain.q[number, 2]
        else:
            ox, oy = parent[base][1]
            px, py = bx - ox, by - oy
            turn = plain.q[number, 2] - plain.q[base, 2]
        inside = "".join(body(k) for k, (end, _) in parent.items() if end[0] == number)
        tiny = max(float(plain.inertia[number]), 1e-6)
        return (
            f'<body name="b{number}" pos="{px} {py} 0" euler="0 0 {turn}"><joint name="j{number}" type="hinge" '
            f'axis="0 0 1"/><inertial pos="{-x} {-y} 0" mass="{plain.mass[number]}" '
            f'diaginertia="{tiny} {tiny} {tiny}"/>{inside}</body>'
        )

    trees = "".join(body(k) for k, (end, _) in parent.items() if end[0] < 0)
    ties = ""
    for i, xi, yi, j, _, _ in loops:
        ox, oy = parent[i][1] if i >= 0 else (0.0, 0.0)
        name = f"b{j}" if j >= 0 else "world"
        ties += (
            f'<connect body1="b{i}" body2="{name}" anchor="{xi - ox} {yi - oy} 0" '
            f'solref="{settings["time_constant"]} 1" solimp="0.9999 0.9999 0.001 0.5 2"/>'
        )
    jacobian = "dense" if len(plain.mass) < 20 else "sparse"
    text = (
        f'<mujoco><compiler angle="radian"/><option timestep="{settings["step"]}" '
        f'integrator="{settings["integrator"]}" '
        f'gravity="0 {-plain.gravity} 0" iterations="50" tolerance="1e-12" jacobian="{jacobian}">'
        f'<flag contact="disable"/></option><size memory="200M"/><worldbody>{trees}</worldbody>'
        f"<equality>{ties}</equality></mujoco>"
    )
    return text, [parent[k][0][0] for k in range(len(plain.mass))]


def run(problem: Problem, settings: dict, samples: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """See the package."""
    plain = problem.plain
    text, base = _text(plain, settings)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    bodies = [model.body(f"b{k}").id for k in range(len(base))]
    places = [int(model.joint(f"j{k}").qposadr[0]) for k in range(len(base))]
    for k, parent in enumerate(base):
        data.qvel[model.joint(f"j{k}").dofadr[0]] = plain.v[k, 2] - (plain.v[parent, 2] if parent >= 0 else 0.0)
    steps = round(problem.duration / settings["step"])
    chunk = steps if samples <= 2 else max(1, steps // (samples - 1))
    times, poses, velocities = [], [], []

    def keep() -> None:
        mujoco.mj_forward(model, data)
        angle = np.zeros(len(base))
        velocity = np.zeros((len(base), 6))
        for k, parent in enumerate(base):  # parents come before children
            angle[k] = data.qpos[places[k]] + plain.q[k, 2]
            if parent >= 0:
                angle[k] += angle[parent] - plain.q[parent, 2]
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, bodies[k], velocity[k], 0)
        times.append(data.time)
        poses.append(np.column_stack([data.xipos[bodies, :2], angle]))
        velocities.append(velocity[:, [3, 4, 2]])

    keep()
    seconds, done = 0.0, 0
    while done < steps:
        many = min(chunk, steps - done)
        started = time.perf_counter()
        mujoco.mj_step(model, data, many)
        seconds += time.perf_counter() - started
        done += many
        keep()
    if not np.isfinite(poses[-1]).all():
        raise ArithmeticError("numbers are no longer finite")
    return seconds, np.array(times), np.array(poses), np.array(velocities)
