"""Efforts: those that a given motion takes, and a mechanism moved by efforts instead of laws.

    M a + J^T lam = Q + P e        J: joints alone;  P: unit directions of the actuators;  lam, e of least norm

The drivers that were used to impose the motion carry nothing unless they are among the actuators. Source: Haug 1989,
ch. 6; Angeles, Fundamentals of Robotic Mechanical Systems, ch. 6 (inverse dynamics).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mbsd.arrays.curve_branches import tabulate_along
from mbsd.arrays.efforts_beside import efforts_beside
from mbsd.arrays.friction_along import with_friction
from mbsd.arrays.inertias import coupled, inertia_of, weight_of
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import approached_along, loads_along, pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.reactions import wrenches
from mbsd.arrays.starts import AnyModel, copied
from mbsd.arrays.states import own_states
from mbsd.base.codes import CONSTANT
from mbsd.base.errors import MobilityError, ModelError
from mbsd.base.names import Suggesting, no_such, shown
from mbsd.kinematics.limits.contacts import refuse_pushing
from mbsd.kinematics.pose.phases import take_decided
from mbsd.model.entries import Amount, add_force, amount_given
from mbsd.model.force import Force, ForceKind
from mbsd.model.forces.loads import ACTUATOR, TORQUE
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model, names_given
from mbsd.results.solution import Solution

UNBALANCED = 1e-6
"""Part of the largest load that actuators may leave."""


def unit_direction(packed: Packed, force: Force, q: np.ndarray, time: float) -> np.ndarray:
    """Return (3 nb,) the generalised force of one N (N m) of a force in pose q (3 nb,). Raises ModelError."""
    return _directions(packed, force, q[None], np.array([time]))[0]


def _directions(packed: Packed, force: Force, q: np.ndarray, times: np.ndarray) -> np.ndarray:
    """(T, 3 nb)"""
    k = packed.forces.index(force)
    alone = replace(packed, forces=[force], force_markers=packed.force_markers[k : k + 1])
    loads = pack_loads(alone)
    if len(loads.element) != 1 or loads.total != 1:
        raise ModelError(
            f"{packed.name}: force '{force.name}' ({force.kind.name}) has no single direction; an actuator or input is "
            "a driver, a torque, a force or an actuator"
        )
    element = loads.element.copy()
    element[0, 3:] = 0, 1
    loads = loads._replace(element=element, term=np.array([[CONSTANT, 0]]), number=np.array([[1.0, 0.0, 0.0]]))
    laws = compiled_laws(replace(alone, forces=[]), float(times[0]), float(times[-1]))
    return loads_along(alone, loads, laws, times, q, np.zeros_like(q))


def with_efforts(m: AnyModel, efforts: Mapping[str, Amount | None]) -> AnyModel:
    """See :meth:`mbsd.mechanism.Mechanism.with_efforts`."""
    out = copied(m)
    for name, effort in efforts.items():
        if name in m.drivers:
            driver = out.drivers.pop(name)
            if effort is not None:
                kind, params = _actuator_of(m, driver)
                _add_effort(out, kind, name, driver.i, driver.j, params, effort)
        elif name in m.forces:
            force = out.forces.pop(name)
            if effort is not None:
                if not force.kind.effort:
                    raise ModelError(
                        f"{m.name}: force '{name}' is a {force.kind.name}; only drivers, torques, forces and actuators "
                        "take an effort"
                    )
                params = {key: value for key, value in force.params.items() if key != force.kind.effort}
                _add_effort(out, force.kind, name, force.i, force.j, params, effort)
        else:
            raise ModelError(f"{m.name}: {no_such('driver or force', name, [*m.drivers, *m.forces])}")
    return out


def _add_effort(m: Model, kind: ForceKind, name: str, i, j, params: Mapping, effort: Amount) -> None:
    own, laws = amount_given(m, name, kind.effort, effort)
    add_force(m, kind, name, i, j, {**params, **own}, laws, same_body=True)


def _actuator_of(m: Model, driver: Joint) -> tuple[ForceKind, dict[str, bool]]:
    """The force that gives the effort of a driver."""
    kinds = {
        "angle": (TORQUE, {}),
        "along": (ACTUATOR, {"along_axis": True}),
        "distance": (ACTUATOR, {"along_axis": False}),
    }
    if len(driver.kind.constraints) != 1 or driver.kind.constraints[0] not in kinds:
        raise ModelError(f"{m.name}: driver '{driver.name}' ({driver.kind.name}) has no effort that a force could give")
    return kinds[driver.kind.constraints[0]]


@dataclass(frozen=True, eq=False)
class ActuatedMotion(Suggesting):
    """A motion with the efforts of other actuators than those that imposed it."""

    solution: Solution
    """The motion with the reactions under these efforts; drivers carry nothing."""
    efforts: dict[str, np.ndarray]
    """(T,) N or N m of each actuator: what is needed in place of its own law."""
    residual: float
    """Largest load left over, of the largest load."""


def inverse_dynamics(m: Model, motion: Solution, actuators: Sequence[str]) -> ActuatedMotion:
    """See :meth:`mbsd.mechanism.Mechanism.inverse_dynamics`."""
    actuators = names_given(f"{m.name}: inverse_dynamics: actuators", actuators)
    if not actuators or len(set(actuators)) < len(actuators):
        raise ModelError(f"{m.name}: inverse_dynamics needs the names of actuators, each once, got {actuators!r}")
    if not isinstance(motion, Solution):
        raise ModelError(f"{m.name}: the motion is {shown(motion)}; give what sweep() or simulate() returned")
    if motion.mechanism is not m:
        raise ModelError(f"{m.name}: the motion is one of '{motion.mechanism.name}', not of this mechanism")
    refuse_pushing(m, motion)
    return _past_change_points(m, motion, actuators) if motion.beside else _actuated(m, motion, actuators)


def _past_change_points(m: Model, motion: Solution, actuators: Sequence[str]) -> ActuatedMotion:
    """The same where the motion passes change points: efforts near these follow from poses beside."""
    times = motion.t if motion.law_times is None else motion.law_times
    known = [(beside, np.isin(times, beside.side.rows)) for beside in motion.beside]
    clear = ~np.any([rows for _, rows in known], axis=0)
    rest = _actuated(m, replace(motion.only(clear), beside=()), actuators)
    lam, wrench = np.full(motion.lam.shape, np.nan), np.full(motion.wrench.shape, np.nan)
    lam[clear], wrench[clear] = rest.solution.lam, rest.solution.wrench
    efforts = {name: np.full(len(times), np.nan) for name in actuators}
    for name, effort in rest.efforts.items():
        efforts[name][clear] = effort
    for beside, rows in known:
        if not len(beside.side.nodes):
            continue
        there = _actuated(m, replace(beside.motion, beside=()), actuators)
        at = np.searchsorted(beside.side.rows, times[rows])
        solved, scales = there.solution, (motion.packed.row_scale(), motion.packed.size)
        both = efforts_beside(beside.side, beside.factor, solved.lam, solved.wrench, *scales)
        lam[rows], wrench[rows] = (part[at] for part in both)
        values = np.stack([there.efforts[name] for name in actuators], axis=1)
        values_near = beside.side.efforts(beside.factor, values, np.ones(len(actuators)))
        for name, effort in zip(actuators, values_near.T, strict=True):
            efforts[name][rows] = effort[at]
    solution = replace(motion, lam=lam, wrench=wrench, work=None, route=rest.solution.route, efforts=efforts)
    return ActuatedMotion(solution, efforts, rest.residual)


def _actuated(m: Model, motion: Solution, actuators: Sequence[str]) -> ActuatedMotion:
    others: dict[str, Amount | None] = {name: None for name in m.drivers if name not in actuators}
    bare = with_efforts(m, others | dict.fromkeys(actuators, 0.0))
    packed = pack(bare)
    take_decided(packed, motion.packed)
    q, v, a = (part.reshape(len(motion.t), -1) for part in (motion.q, motion.v, motion.a))
    q, v, a = np.ascontiguousarray(q), np.ascontiguousarray(v), np.ascontiguousarray(a)
    count, rows = len(q), len(packed.ws.phi)
    laws = compiled_laws(packed, float(motion.t[0]), float(motion.t[-1]))
    loads = pack_loads(packed)
    approached, times = motion.approached, motion.t if motion.law_times is None else motion.law_times
    if approached is None:
        approached = approached_along(packed, loads, laws, times, q, v)
    applied = loads_along(packed, loads, laws, times, q, v, approached, _states(packed, motion))
    inertia, weight = inertia_of(packed), weight_of(packed)
    right = (weight + applied - inertia * a)[:, 3:]
    push = np.stack([_directions(packed, bare.forces[name], q, times)[:, 3:] for name in actuators], axis=1)
    phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
    tabulate_along(packed, packed.drives(times), q, v, phi, compact, gamma)
    jacobian = packed.spread(compact)
    (lam, effort, left), friction = with_friction(
        packed,
        loads,
        (times, q, v),
        compact,
        lambda friction: _solved(packed, jacobian, push, right + friction[:, 3:]),
    )
    applied += friction
    columns = packed.column_scale()
    terms = (weight[3:], applied[:, 3:], inertia[3:] * a[:, 3:])
    largest = np.max([np.abs(term * columns).reshape(-1, len(columns)).max(axis=0) for term in terms], axis=0)
    group = coupled(packed)[1:].repeat(3)  # bodies that nothing connects are not measured by each other's loads
    of_group = np.zeros(group.max(initial=0) + 1)
    np.maximum.at(of_group, group, largest)
    allowed = of_group[group]
    residual = (np.abs(left * columns) / np.where(allowed > 0.0, allowed, 1.0)).max(axis=1, initial=0.0)
    worst = int(np.argmax(residual))
    if residual[worst] > UNBALANCED:
        raise MobilityError(
            f"{m.name}: {', '.join(actuators)} cannot make this motion: at t = {motion.t[worst]:.6g} s "
            f"{residual[worst]:.2g} of the largest load is left over. Name an actuator for each of the "
            f"{motion.mobility.dof} degrees of freedom that something must move."
        )
    everything = np.zeros_like(motion.lam)
    everything[:, :rows] = lam
    reactions = np.zeros_like(motion.wrench)
    reactions[:, : len(packed.joints)] = wrenches(packed, compact, q, lam)
    efforts = dict(zip(actuators, effort.T, strict=True))
    route = f"efforts of {', '.join(actuators)}"
    solution = replace(motion, lam=everything, wrench=reactions, work=None, route=route, efforts=efforts)
    return ActuatedMotion(solution, efforts, float(residual[worst]))


def _states(packed: Packed, motion: Solution) -> np.ndarray | None:
    """(T, n) those of the forces that are left of a motion's."""
    if motion.states is None:
        return None
    known = motion.packed.forces
    parts = [motion.states[:, own_states(known, force.name)] for force in packed.forces if force.kind.states]
    return np.hstack(parts) if parts else None


def _solved(
    packed: Packed, jacobians: np.ndarray, push: np.ndarray, right: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """lam (T, m), e (T, k) and what is left over (T, n), of least norm in dimensionless multipliers."""
    rows, columns = packed.row_scale(), packed.column_scale()
    unit = np.abs(push * columns).max(axis=(0, 2), initial=1e-300)
    scale = np.concatenate([rows, 1.0 / unit])
    out, left = np.zeros((len(right), len(scale))), np.zeros_like(right)
    for k in range(len(right)):
        matrix = np.hstack([jacobians[k].T, -push[k].T])
        out[k] = scale * np.linalg.lstsq(matrix * columns[:, None] * scale, right[k] * columns, rcond=1e-9)[0]
        left[k] = right[k] - matrix @ out[k]
    return out[:, : len(rows)], out[:, len(rows) :], left
