"""Linearisation on the constraints about a pose or a moving state.

    z'' = f(z, z', u)        z: independent coordinates; q(z) on the constraints, J v = nu, v_z = z'
    dx' = A dx + B du        x = (z - z0, z' - z0', s - s0),   y: q = q0 + C dx to first order

A from central differences of fourth order of the compiled accelerations: the pose is put back onto the constraints
with z held, the velocities follow from z'. s: states of forces, such as pressures, with s' = f(z, z', s). B from the
masses along the constraints, M_z = B_q^T M B_q with dq = B_q dz. Laws of time are frozen at the time of linearisation;
drivers that are inputs are replaced by actuators with their effort. Source: Haug 1989, ch. 6.5 and 7; Negrut, Ortiz
2006, J. Comput. Nonlinear Dynam. 1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mbsd.analyses.efforts import unit_direction
from mbsd.analyses.modes import Mode, modes_of
from mbsd.analyses.statics import DIFFERENCES, OFFSETS, Independent, independent_coordinates, pose_step, tangent
from mbsd.arrays.inertias import coupled
from mbsd.arrays.loads import SHARP
from mbsd.arrays.states import columns_of, ones_of, without_states
from mbsd.base.errors import MobilityError, ModelError, SingularPoseError
from mbsd.base.names import Suggesting, no_such
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.kinematics.limits.contacts import refuse_closed
from mbsd.model.mechanism import Model
from mbsd.results.friction import friction_view

POSE_STEP = 5e-4
"""Step of differences of the pose, in sizes and rad."""
SPEED_STEP = 1e-5
"""Step of differences of the velocities, in sizes/s and rad/s: small against the speeds where dry friction turns."""
ROUNDING = 1e-10
"""Entries of A below this part of the largest of their block are rounding."""
MASSLESS = 1e-10
"""Least eigenvalue of the mass matrix, each coordinate scaled to one, that counts as a mass."""


@dataclass(frozen=True, eq=False)
class Linearisation(Suggesting):
    """dx' = A dx + B du about a state of a mechanism."""

    model: Model
    """The mechanism that starts at this state."""
    time: float
    a: np.ndarray
    """(2 f + s, 2 f + s)"""
    b: np.ndarray
    """(2 f + s, inputs)"""
    c: np.ndarray
    """(3 nb, f) change of all coordinates (centres of mass, angles; ground first) by the independent ones."""
    mass: np.ndarray
    """(f, f) M_z against the independent coordinates (kg, kg m, kg m^2)."""
    coordinates: tuple[str, ...]
    """Independent coordinates: ``rod.theta``; x and y are those of the centre of mass."""
    inputs: tuple[str, ...]
    q: np.ndarray
    """(3 nb,) the pose: centres of mass (m) and angles (rad)."""
    com: np.ndarray
    """(nb, 2) in the authors' frames (m)."""
    size: float
    """Size of the mechanism (m): makes turns comparable with displacements."""
    states: tuple[str, ...] = ()
    """States of forces, which are the last s of x: ``boom.pressure_a`` (Pa)."""

    @property
    def stiffness(self) -> np.ndarray:
        """(f, f) K of M_z z'' + D z' + K z = 0; states of forces do not change meanwhile."""
        f = len(self.coordinates)
        return -self.mass @ self.a[f : 2 * f, :f]

    @property
    def damping(self) -> np.ndarray:
        """(f, f) D of M_z z'' + D z' + K z = 0."""
        f = len(self.coordinates)
        return -self.mass @ self.a[f : 2 * f, f : 2 * f]

    @cached_property
    def eigenvalues(self) -> np.ndarray:
        """(2 f + s,) complex (1/s), slowest first."""
        values = np.linalg.eigvals(self.a)
        return values[np.lexsort((values.imag, values.real.round(12), np.abs(values).round(9)))]

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Modes by rising frequency."""
        return modes_of(self)

    @property
    def frequencies(self) -> np.ndarray:
        """(modes,) natural frequencies (Hz)."""
        return np.array([mode.frequency for mode in self.modes])

    @property
    def stability(self) -> str:
        """``unstable`` if a disturbance grows, ``stable`` if all die out, else ``neutral``."""
        rates = np.array([mode.eigenvalue.real for mode in self.modes])
        sizes = np.array([abs(mode.eigenvalue) for mode in self.modes])
        zero = 1e-9 * float(sizes.max(initial=0.0))
        if (rates > zero).any():
            return "unstable"
        return "stable" if (rates < -zero).all() else "neutral"

    def __repr__(self) -> str:
        return (
            f"<Linearisation {self.model.name}: {len(self.coordinates)} coordinates "
            f"({', '.join(self.coordinates)}), {self.stability}>"
        )

    def __str__(self) -> str:
        return "\n".join([repr(self), *(f"  {mode}" for mode in self.modes)])


def _drop_rounding(slopes: np.ndarray, group: np.ndarray, fall: float) -> None:
    """Set entries of slopes (f, 2 f) to zero that are rounding within a group (f,), or between groups.

    Where there are several groups, one that nothing pulls at has rounding of the weight, ``fall`` (1/s^2), alone.
    """
    f = len(group)
    least = fall if (group != group[0]).any() else 0.0
    slopes[:, :f][group[:, None] != group] = slopes[:, f:][group[:, None] != group] = 0.0
    for number in np.unique(group):
        at = np.flatnonzero(group == number)
        pull = max(float(np.abs(slopes[np.ix_(at, at)]).max()), least)
        for first, usual in ((0, pull), (f, math.sqrt(pull))):
            block = slopes[np.ix_(at, first + at)]
            block[np.abs(block) < ROUNDING * max(usual, float(np.abs(block).max()))] = 0.0
            slopes[np.ix_(at, first + at)] = block


def _check_masses(model: str, names: tuple[str, ...], mass: np.ndarray) -> None:
    """Raise MobilityError for a motion (f, f) that moves no mass: it has no equation of motion."""
    size = np.sqrt(np.maximum(np.diag(mass), 0.0))
    if not (size > 0).all():
        loose = [name for name, mass_moved in zip(names, size, strict=True) if not mass_moved > 0]
        raise MobilityError(
            f"{model}: nothing that has a mass moves with {', '.join(loose)}; give bodies mass and inertia"
        )
    value, vector = np.linalg.eigh(mass / np.outer(size, size))
    if value[0] < MASSLESS:
        loose = [name for name, share in zip(names, np.abs(vector[:, 0]), strict=True) if share > 0.1]
        raise MobilityError(
            f"{model}: {', '.join(loose)} can move so that nothing with a mass does; give bodies mass and inertia"
        )


def linearise(m: Model, time: float, inputs: Sequence[str]) -> Linearisation:
    """About the start of ``m``, its ``start_near`` and ``start_moving``, at ``time`` (s).

    ``inputs`` are forces of ``m``. Raises MobilityError if nothing can move, SingularPoseError at a singular pose.
    """
    ready = prepare_dynamics(m, time, time)
    refuse_closed(m, ready.packed, ready.initial.q)
    _check_sticking(ready)
    flow = _Flow(ready, time)
    f = len(flow.independent.names)
    if not f:
        raise MobilityError(f"{m.name}: nothing can move: joints and drivers leave no freedom to linearise")
    if f > ready.mobility.dof - len(m.drivers):
        raise SingularPoseError(
            f"{m.name}: the pose at t = {time:.6g} s is singular (a toggle or change point): the links can go on in "
            "more ways than one, and no linear motion describes them. Linearise a little before or after it."
        )
    basis = flow.independent.basis
    mass = basis.T @ (ready.dynamics.inertia[3 : 3 + len(basis), None] * basis)
    _check_masses(ready.packed.name, flow.independent.names, mass)
    count = 2 * f + len(flow.ones)
    state = np.zeros((count, count))
    state[:f, f : 2 * f] = np.eye(f)
    state[f:, :f], state[f:, f : 2 * f], state[f:, 2 * f :] = (flow.slopes(part) for part in range(3))
    state[2 * f :] *= flow.ones[:, None]
    state[:, 2 * f :] /= flow.ones
    fall = float(np.hypot(*ready.packed.system.gravity)) / ready.packed.size
    _drop_rounding(state[f : 2 * f, : 2 * f], coupled(ready.packed)[1 + flow.independent.indices // 3], fall)
    push = np.array([basis.T @ _direction(ready, name, time)[: len(basis)] for name in inputs]).reshape(len(inputs), f)
    b = np.zeros((count, len(inputs)))
    b[f : 2 * f] = np.linalg.solve(mass, push.T)
    return Linearisation(
        model=m,
        time=time,
        a=state,
        b=b,
        c=np.vstack([np.zeros((3, f)), basis]),
        mass=mass,
        coordinates=flow.independent.names,
        inputs=tuple(inputs),
        q=ready.initial.q[: 3 + len(basis)],
        com=flow.plain.com,
        size=ready.packed.size,
        states=tuple(
            f"{force.name}.{name}"
            for force in ready.packed.forces
            if force.kind.states
            for name in force.kind.states.names
        ),
    )


def _check_sticking(ready: PreparedDynamics) -> None:
    """Friction of a joint at rest jumps with the sign of its rate: there is no linear motion about it."""
    packed = ready.packed
    at = ready.initial.q.reshape(1, -1, 3), ready.initial.v.reshape(1, -1, 3)
    for force in packed.forces:
        if force.params.get("sticks"):
            rate = float(friction_view(packed, force.name, *at, np.zeros((1, len(packed.ws.phi)))).rate[0])
            if abs(rate) <= SHARP * packed.size:
                raise ModelError(
                    f"{packed.name}: joint '{force.params['joint']}' is at rest in this state, where '{force.name}' "
                    "lets it stick: there is no linear motion about it. Give the friction a slip_speed in place of "
                    "sticks, or start it moving."
                )


def _direction(ready: PreparedDynamics, name: str, time: float) -> np.ndarray:
    packed, m = ready.packed, ready.packed.name
    names = [force.name for force in packed.forces]
    if name not in names:
        raise ModelError(f"{m}: {no_such('driver or force', name, names)}")
    return unit_direction(packed, packed.forces[names.index(name)], ready.initial.q, time)[3:]


class _Flow:
    """z'' and s' as functions of z, z' and s about a state."""

    def __init__(self, ready: PreparedDynamics, time: float) -> None:
        self.ready, self.time = ready, time
        self.packed = ready.packed
        self.state = np.stack([ready.initial.q, ready.initial.v])
        self.lam = np.zeros(len(self.packed.ws.phi))
        self.scratch = scratch_for(ready.dynamics, self.packed.ws, len(self.packed.motions), 1)
        self._derive(self.state)
        self.plain = without_states(self.packed)
        self.columns, self.ones = columns_of(self.packed), ones_of(self.packed)
        self.count = self.plain.coordinates
        basis = tangent(self.plain, self.packed.jacobian()[:, : self.count])
        self.independent: Independent = independent_coordinates(self.plain, basis)
        self.dependent = np.setdiff1d(np.arange(self.count), self.independent.indices)
        self.scale = self.plain.column_scale()

    def _derive(self, state: np.ndarray) -> np.ndarray:
        out = np.zeros_like(state)
        derivative(self.ready.dynamics, self.scratch, self.time, state, out, self.lam)
        self.packed.specials.check()
        return out

    def slopes(self, part: int) -> np.ndarray:
        """(f + s, f or s) dz''/dz and ds'/dz (part 0), by z' (part 1) or by s (part 2)."""
        columns = []
        sizes = np.full(len(self.columns), self.packed.size) if part == 2 else self.scale[self.independent.indices]
        pose = pose_step(self.plain, self.state[0][: 3 + self.count], POSE_STEP)
        for k, size in enumerate(sizes):
            h = (pose, SPEED_STEP, SPEED_STEP)[part] * size
            moved = [self._rates(k, part, h * offset) for offset in OFFSETS]
            columns.append(DIFFERENCES @ np.array(moved) / h)
        return np.array(columns).T.reshape(len(self.independent.indices) + len(self.columns), -1)

    def _rates(self, k: int, part: int, h: float) -> np.ndarray:
        """(f + s,) z'' and s' with independent coordinate, its velocity or state k changed by h."""
        q, v = self.state[0].copy(), self.state[1].copy()
        z = 3 + self.independent.indices
        wanted = v[z].copy()
        if part == 0:
            q[3 : 3 + self.count] += h * self.independent.basis[:, k]
            q = self._closed(q)
        elif part == 1:
            wanted[k] += h
        else:
            v[self.columns[k]] += h
        v[z] = wanted
        v = self._consistent(q, v)
        changes = self._derive(np.stack([q, v]))[1]
        return np.concatenate([changes[z], changes[self.columns]])

    def _jacobian(self, q: np.ndarray) -> np.ndarray:
        self._derive(np.stack([q, self.state[1]]))
        return self.packed.jacobian()[:, : self.count] * self.packed.row_scale()[:, None] * self.scale

    def _closed(self, q: np.ndarray) -> np.ndarray:
        """Put back onto the constraints with the independent coordinates held."""
        if not len(self.lam):
            return q
        for _ in range(20):
            jac = self._jacobian(q)[:, self.dependent]
            step = np.linalg.lstsq(jac, -self.packed.ws.phi * self.packed.row_scale(), rcond=1e-9)[0]
            q[3 + self.dependent] += step * self.scale[self.dependent]
            if np.abs(step).max(initial=0.0) < 1e-12:
                return q
        return q

    def _consistent(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Velocities with the independent ones held and J v = nu."""
        if not len(self.lam):
            return v
        jac = self._jacobian(q)
        nu = np.zeros(len(self.lam))
        nu[self.packed.driver_rows :] = self.packed.drives(np.array([self.time]))[0, 1:, 1]
        z = self.independent.indices
        right = nu * self.packed.row_scale() - jac[:, z] @ (v[3 + z] / self.scale[z])
        v[3 + self.dependent] = (
            np.linalg.lstsq(jac[:, self.dependent], right, rcond=1e-9)[0] * self.scale[self.dependent]
        )
        return v
