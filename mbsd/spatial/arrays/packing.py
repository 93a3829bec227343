"""A mechanism in space as arrays (System), with the names to which rows and columns belong."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.base.arguments import law_of
from mbsd.compiling.callback import Callback
from mbsd.model.laws import Motion
from mbsd.spatial.arrays.calls import addresses_of, calls_of
from mbsd.spatial.arrays.tables import Tables
from mbsd.spatial.equations.evaluation import measure
from mbsd.spatial.equations.system import System, Workspace, workspace_for
from mbsd.spatial.model.body import Body
from mbsd.spatial.model.force import Force, Push
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rotation import euler_parameters
from mbsd.spatial.model.rows import Row, along, turn


@dataclass
class Packed:
    """Arrays and names of a mechanism."""

    name: str
    bodies: list[Body]
    """Ground first."""
    joints: list[Joint]
    """Joints, then drivers, in the order of their rows."""
    motions: list[Motion]
    """Laws of the drivers."""
    row_joint: np.ndarray
    """(h,) number of the joint or driver of each row."""
    row_unit: list[str]
    """Unit of each residual: m or rad."""
    driver_rows: int
    """First row of the drivers."""
    system: System
    ws: Workspace
    size: float
    """A length of the mechanism (m)."""
    forces: Sequence[Force] = field(default=())
    """Forces, whose rows stand behind the h rows of joints and drivers."""
    callbacks: Sequence[Callback] = field(default=())
    """Functions of the user in forces."""
    watched: Mapping[str, int] = field(default_factory=dict)
    """Numbers of the turns that are counted for events, by the names of joints."""

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without function addresses, which hold in this process alone."""
        return {key: value for key, value in vars(self).items() if key != "callbacks"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore arrays and names, and give functions addresses anew."""
        vars(self).update(state)
        addresses, self.callbacks = addresses_of(self.name, self.forces)
        self.system.call[:, 0] = addresses

    @property
    def body_names(self) -> list[str]:
        """Names of the bodies, ground first."""
        return [body.name for body in self.bodies]

    @property
    def drivers(self) -> list[Joint]:
        """The drivers."""
        return self.joints[len(self.joints) - len(self.motions) :]

    @property
    def driver_names(self) -> list[str]:
        """Names of the drivers."""
        return [driver.name for driver in self.drivers]

    @property
    def passive_joints(self) -> list[Joint]:
        """Joints without drivers."""
        return self.joints[: len(self.joints) - len(self.motions)]

    @property
    def freedoms(self) -> int:
        """Velocities of the moving bodies."""
        return 6 * (len(self.bodies) - 1)

    @cached_property
    def design(self) -> np.ndarray:
        """Coordinates (3 + 7 n,) of the design pose."""
        q = np.zeros(7 * len(self.bodies) - 4)
        for b, body in enumerate(self.bodies[1:], 1):
            q[7 * b - 4 : 7 * b - 1] = np.array(body.place) + body.rotation @ np.array(body.com)
            q[7 * b - 1 : 7 * b + 3] = euler_parameters(body.rotation @ body.principal[1])
        return q

    @cached_property
    def row_scale(self) -> np.ndarray:
        """(m,) factors that make residuals dimensionless."""
        return np.array([1.0 / self.size if unit == "m" else 1.0 for unit in self.row_unit])

    @cached_property
    def column_scale(self) -> np.ndarray:
        """(6 n,) sizes of a unit of each velocity."""
        return np.tile([self.size] * 3 + [1.0] * 3, len(self.bodies) - 1)

    def drives(self, times: np.ndarray) -> np.ndarray:
        """Return (T, drivers + 1, 3) values of the laws at times (T,) (s), the zero law first."""
        out = np.zeros((len(times), len(self.motions) + 1, 3))
        for k, (driver, motion) in enumerate(zip(self.drivers, self.motions, strict=True), 1):
            with law_of(f"{self.name}: driver '{driver.name}'"):
                out[:, k] = motion(times)
        return out

    def check_callbacks(self, accepted: bool) -> None:
        """Raise what functions of the user raised, in steps that were ``accepted`` only what no step could refuse."""
        for callback in self.callbacks:
            if accepted:
                callback.forget()
            callback.check()

    def settle_laws(self, start: float, end: float) -> None:
        """Make the laws ready for times ``start`` .. ``end`` (s)."""
        for k, driver in enumerate(self.drivers):
            assert driver.motion is not None
            with law_of(f"{self.name}: driver '{driver.name}'"):
                self.motions[k] = driver.motion.over(start, end)

    def measured(self, q: np.ndarray, drive: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Return Phi (h,) and J (h, 6 n) at q (3 + 7 n,) and laws (drivers + 1, 3), zero by default."""
        measure(self.system, q, np.zeros((len(self.motions) + 1, 3)) if drive is None else drive, self.ws)
        held = self.system.held
        return self.ws.phi[:held].copy(), self.spread(self.ws.jac)[:held]

    def spread(self, compact: np.ndarray) -> np.ndarray:
        """Return J (..., m, 6 n) of a compact one (..., m, 6 k), without ground."""
        rows, columns, entries = self._entries
        out = np.zeros((*compact.shape[:-1], self.freedoms))
        out[..., rows, columns] = compact[..., rows, entries]
        return out

    @cached_property
    def _entries(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rows of the compact J's entries on moving bodies, their columns in J, and those in the compact J."""
        rows, sides = np.nonzero(self.system.row_body > 0)
        six = np.arange(6)
        columns = 6 * (self.system.row_body[rows, sides] - 1)
        return np.repeat(rows, 6), (columns[:, None] + six).ravel(), (6 * sides[:, None] + six).ravel()

    def scaled(self, q: np.ndarray) -> np.ndarray:
        """Return the dimensionless J (m, 6 n) at q (3 + 7 n,)."""
        return self.measured(q)[1] * self.row_scale[:, None] * self.column_scale


def moved(q: np.ndarray, delta: np.ndarray) -> np.ndarray:
    """Return q (3 + 7 n,) moved by delta (6 n,): places, and small rotations in the world."""
    out = q.copy()
    step, pose = delta.reshape(-1, 6), out[3:].reshape(-1, 7)
    pose[:, :3] += step[:, :3]
    w, x, y, z = pose[:, 3:].T.copy()
    a, b, c = 0.5 * step[:, 3:].T
    turned = np.stack([w - a * x - b * y - c * z, x + a * w + b * z - c * y, y + b * w + c * x - a * z,
                       z + c * w + a * y - b * x])  # fmt: skip
    pose[:, 3:] = (turned / np.sqrt((turned * turned).sum(axis=0))).T
    return out


def pack(
    m: Model, extra: Sequence[tuple[Joint, Row]] = (), rows_of: Callable[[Joint], list[Row]] = lambda joint: joint.rows
) -> Packed:
    """Return the arrays of a mechanism; rows ``extra`` of joints come last and belong to no reaction.

    ``rows_of`` a joint may be fewer than its own, and without some of their terms.
    """
    bodies = list(m.bodies.values())
    joints = [*m.joints.values(), *m.drivers.values()]
    tables = Tables(bodies)
    row_joint, units, values, driven, wrench = [], [], [], [], []
    driver_rows, passive = 0, len(m.joints)
    rows = [(k, row, False) for k, joint in enumerate(joints) for row in rows_of(joint)]
    rows += [(joints.index(joint), row, True) for joint, row in extra]
    for k, row, added in rows:
        first, reacts = len(row_joint), k < passive and not added
        if joints[k].motion is not None:
            driven.append((first, k - passive + 1))
        sides = tables.add(row, first)
        second = bodies.index(joints[k].j.body)
        column = 6 * sides.index(second) if second in sides else 0
        row_joint += [k] * row.count
        units += [row.unit] * row.count
        values += [row.value] * row.count
        wrench += [(k if reacts else -1, column)] * row.count
        driver_rows += row.count * reacts
    held, forces = len(row_joint), [] if extra else list(m.forces.values())
    pushes = [push for force in forces for push in force.pushes]
    turning = [joint for joint in m.joints.values() if joint.kind.turns and m.events and not extra]
    pushes += [Push(turn(joint.i, joint.j)) for joint in turning]
    for k, push in enumerate(pushes):
        tables.add(push.row, held + k)
    values += [0.0] * len(pushes)
    wrench += [(-1, 0)] * len(pushes)
    arms = [tables.place(joint.j) for joint in joints[:passive]]
    addresses, callbacks = addresses_of(m.name, forces)
    calls = calls_of(addresses, forces, tables)
    system = System(
        mass=np.array([body.mass for body in bodies]),
        inertia=np.array([body.principal[0] for body in bodies]),
        gravity=np.array(m.gravity, float),
        **tables.arrays(held + len(pushes)),
        held=held,
        **calls,
        **_frictions_of(forces, held, joints, row_joint, wrench, bodies, arms),
        force=np.array(_laws_of(forces, held, len(m.drivers)), np.int64).reshape(-1, 2),
        push=np.array([(p.stiffness, p.free, p.damping, p.amount) for p in pushes], float).reshape(-1, 4),
        value=np.array(values, float),
        driven=np.array(driven, np.int64).reshape(-1, 2),
        wrench=np.array(wrench, np.int64).reshape(-1, 2),
        joint_arm=np.array(arms, np.int64),
    )
    motions = [driver.motion for driver in m.drivers.values() if driver.motion is not None]
    return Packed(
        name=m.name, bodies=bodies, joints=joints, motions=motions, row_joint=np.array(row_joint, np.int64),
        row_unit=units, driver_rows=driver_rows, system=system, ws=workspace_for(system), size=size_of(m),
        forces=forces, callbacks=callbacks,
        watched={joint.name: len(system.turn) - len(turning) + k for k, joint in enumerate(turning)},
    )  # fmt: skip


def _frictions_of(
    forces: Sequence[Force], held: int, joints: Sequence[Joint], row_joint: list[int], wrench: list[tuple[int, int]],
    bodies: list[Body], arms: list[int],
) -> dict[str, np.ndarray]:  # fmt: skip
    """Return the fields of a System for friction of joints."""
    table, numbers, row = [], [], held
    for force in forces:
        if force.kind.friction_of is not None and force.joint is not None:
            joint = joints.index(force.joint)
            own = [r for r, k in enumerate(row_joint) if k == joint]
            second = bodies.index(force.joint.j.body)
            table.append((row, own[0], own[-1] + 1, wrench[own[0]][1], second, arms[joint]))
            numbers.append(force.kind.friction_of(force))
        row += len(force.pushes)
    return {
        "friction": np.array(table, np.int64).reshape(-1, 6),
        "friction_number": np.array(numbers, float).reshape(-1, 8),
    }


def _laws_of(forces: Sequence[Force], first: int, drivers: int) -> list[tuple[int, int]]:
    """Return row, from ``first`` on, and law of each row of forces; laws of drivers come before."""
    table, law = [], drivers
    for force in forces:
        numbers = {name: law + k for k, name in enumerate(force.laws, 1)}
        law += len(force.laws)
        table += [(first + len(table) + k, numbers.get(push.law, 0)) for k, push in enumerate(force.pushes)]
    return table


def size_of(m: Model) -> float:
    """Return a length of a mechanism (m): the mean extent of its places on bodies."""
    extents = []
    markers = [marker for joint in [*m.joints.values(), *m.drivers.values()] for marker in (joint.i, joint.j)]
    for body in m.bodies.values():
        places = np.array([marker.place for marker in markers if marker.body is body])
        if len(places) > 1:
            extents.append(float(np.linalg.norm(places.max(axis=0) - places.min(axis=0))))
    lengths = [extent for extent in extents if extent > 0.0]
    if lengths:
        return float(np.mean(lengths))
    far = [float(np.linalg.norm(marker.place)) for marker in markers]
    return max([*far, 0.0]) or 1.0


def start_row(joint: Joint) -> Row:
    """Return the row that measures the turn or the slide of a joint."""
    return turn(joint.i, joint.j) if joint.kind.turns else along(joint.i, "z", joint.j)
