"""MuJoCo: hinges along a tree, its soft "connect" equality where a loop closes.

A loop is held by a reference acceleration with time constant ``softness`` steps and critical damping, its impedance at
the most that MuJoCo allows (0.9999). Below 2 steps MuJoCo needs an option not to soften it (refsafe off).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import mujoco
import numpy as np

from benchmarks.dynamics.cases import Case
from benchmarks.dynamics.pins import GROUND, Pin, Record, spanning_tree
from benchmarks.dynamics.settings import steps_of

VERSION = mujoco.__version__
SAMPLES = 1000
FINE = 1.0125
"""Ratio of steps of neighbouring rungs where the bar is near: as fine as our own, 24 tolerances a decade at order 8."""
LEAST_INERTIA = 1e-9
"""kg m^2: MuJoCo has no body without inertia."""


def ladders(case: Case) -> Iterator[list[dict[str, Any]]]:
    """Settings to try, each ladder from cheap to exact."""
    if case.name.startswith("A01"):
        for integrator, first in (("RK4", 100), ("implicitfast", 1000), ("Euler", 1000)):
            yield [{"integrator": integrator, "steps": n} for n in steps_of(first, 30_000)]
        return
    if not spanning_tree(case.model)[1]:  # no loop to hold: neither solver nor softness matter
        for integrator, ratio in (("RK4", FINE), ("implicitfast", 1.15), ("Euler", 1.15)):
            yield [{"integrator": integrator, "steps": n} for n in steps_of(500, 20_000, ratio)]
        return
    large = len(case.model.solids) > 8  # where a run takes long, what was worst on the small ones is left out
    first, last = (800, 40_000) if case.name.startswith("A02") else (200, 20_000)
    for integrator in ("RK4", "implicitfast"):
        for solver in ("Newton",) if large else ("Newton", "CG"):
            for softness in (2.5, 2.0, 3.0) if large else (2.5, 2.0, 1.75, 1.5, 1.0, 3.0, 4.0):
                for tolerance in (1e-8, 1e-12):
                    yield [
                        {"integrator": integrator, "solver": solver, "jacobian": "sparse" if large else "dense",
                         "softness": softness, "tolerance": tolerance, "steps": n}
                        for n in steps_of(first, last)
                    ]  # fmt: skip


def _xml(case: Case, settings: dict[str, Any]) -> str:
    parents, loops = spanning_tree(case.model)
    step = case.duration / settings["steps"]
    option = f'<option timestep="{step!r}" integrator="{settings["integrator"]}" gravity="0 {-case.model.gravity} 0"'
    for what in ("solver", "jacobian", "tolerance"):
        option += f' {what}="{settings[what]}"' if what in settings else ""
    solref = f"{settings.get('softness', 2.0) * step!r} 1"

    def children(parent: int) -> str:
        return "".join(element(child, pin) for child, (of, pin) in parents.items() if of == parent)

    def element(body: int, pin: Pin) -> str:
        """A body frame at the start pose, seen from the parent's; the hinge at the pin."""
        solid, parent = case.model.solids[body], parents[body][0]
        base = (0.0, 0.0, 0.0) if parent == GROUND else case.model.solids[parent].pose
        dx, dy, turn = (a - b for a, b in zip(solid.pose, base, strict=True))
        c, s = math.cos(base[2]), math.sin(base[2])
        x, y = pin.b if body == pin.j else pin.a
        inertia = max(solid.inertia, LEAST_INERTIA)
        hooks = "".join(
            f'<site name="s{k}{end}" pos="{point[0]!r} {point[1]!r} 0"/>'
            for k, spring in enumerate(case.model.springs)
            for end, owner, point in (("i", spring.i, spring.a), ("j", spring.j, spring.b))
            if owner == body
        )
        return (
            f'<body name="b{body}" pos="{c * dx + s * dy!r} {c * dy - s * dx!r} 0" euler="0 0 {turn!r}">'
            f'<joint name="j{body}" type="hinge" axis="0 0 1" pos="{x!r} {y!r} 0"/>'
            f'<inertial pos="0 0 0" mass="{solid.mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
            f"{hooks}{children(body)}</body>"
        )

    def name(body: int) -> str:
        return "world" if body == GROUND else f"b{body}"

    ground_hooks = "".join(
        f'<site name="s{k}i" pos="{s.a[0]!r} {s.a[1]!r} 0"/>'
        for k, s in enumerate(case.model.springs) if s.i == GROUND
    )  # fmt: skip
    connects = "".join(
        f'<connect body1="{name(p.j)}" body2="{name(p.i)}" anchor="{p.b[0]!r} {p.b[1]!r} 0" solref="{solref}" '
        f'solimp="0.9999 0.9999 0.001 0.5 2"/>'
        for p in loops
    )
    tendons = "".join(
        f'<spatial stiffness="{s.stiffness!r}" springlength="{s.length!r}"><site site="s{k}i"/><site site="s{k}j"/>'
        "</spatial>"
        for k, s in enumerate(case.model.springs)
    )
    return (
        '<mujoco><compiler angle="radian" autolimits="false"/>'
        f'{option}><flag contact="disable" refsafe="disable"/></option><size memory="200M"/>'
        f"<worldbody>{ground_hooks}{children(GROUND)}</worldbody>"
        f"<equality>{connects}</equality><tendon>{tendons}</tendon></mujoco>"
    )


def prepare(case: Case, settings: dict[str, Any]) -> tuple[Callable[[], Callable[[], Any]], Callable[[], Record]]:
    """``fresh`` gives a run that starts anew, whose making is not timed; ``record`` what it computes."""
    model = mujoco.MjModel.from_xml_string(_xml(case, settings))
    data = mujoco.MjData(model)
    count = len(case.model.solids)
    bodies = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, f"b{k}") for k in range(count)]
    dofs = [model.joint(f"j{k}").dofadr[0] for k in range(count)]
    parents, _ = spanning_tree(case.model)
    steps = settings["steps"]

    def reset() -> None:
        mujoco.mj_resetData(model, data)
        for body, (parent, _) in parents.items():
            base = 0.0 if parent == GROUND else case.model.solids[parent].velocity[2]
            data.qvel[dofs[body]] = case.model.solids[body].velocity[2] - base
        for body, torque in case.model.torques:
            data.xfrc_applied[bodies[body], 5] = torque
        mujoco.mj_forward(model, data)

    def fresh() -> Callable[[], Any]:
        reset()
        return lambda: mujoco.mj_step(model, data, steps)

    def state() -> tuple[np.ndarray, np.ndarray]:
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        poses, velocities, spatial = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros(6)
        for body, (parent, _) in parents.items():  # parents first, so angles add up with all their turns
            before = (0.0, 0.0) if parent == GROUND else (poses[parent, 2], case.model.solids[parent].pose[2])
            turn = data.qpos[dofs[body]] + case.model.solids[body].pose[2] + before[0] - before[1]
            poses[body] = *data.xipos[bodies[body]][:2], turn
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, bodies[body], spatial, 0)
            velocities[body] = spatial[3], spatial[4], spatial[2]
        return poses, velocities

    def record() -> Record:
        reset()
        record = [(0.0, *state())]
        done = 0
        for k in range(1, min(SAMPLES, steps) + 1):
            wanted = round(k * steps / min(SAMPLES, steps))
            mujoco.mj_step(model, data, wanted - done)
            done = wanted
            record.append((done * case.duration / steps, *state()))
        if data.warning.number.sum():  # an unstable run was put back to its start
            record[-1] = (0.0, *record[-1][1:])
        times, poses, velocities = (np.array(part) for part in zip(*record, strict=True))
        return Record(times, poses, velocities)

    return fresh, record
