"""Small motions about an equilibrium or a steady motion in space.

    x = (d, theta, u, s)        place and rotation of each body from the base motion, its velocity and angular velocity
    d' = u,  theta' = s + w_0 x theta,  (u, s)' = da        by central differences of order 6

Along a steady motion, such as a bicycle that goes straight on, these deviations have constant coefficients though its
wheels turn, because its round bodies look the same after any turn. What the joints allow is the null space N of

    J_h d = 0,  J u + d(J v_0) d = 0        J_h: rows that hold places;  those that roll hold rates alone

and A = N^+ A_x N. About an equilibrium d and u have one null space Z, and motions that neither stiffness nor damping
resist are the free rigid ones: they are split off and have the eigenvalue 0 exactly, twice.

Modes are eigenvalues of A, and how every body moves:

    lambda = -zeta omega +- i omega sqrt(1 - zeta^2)        omega = |lambda|

A pair of conjugate eigenvalues is one mode, and a real one a mode of its own; a free rigid motion has frequency 0. A
mode moves every body by Re(amplitude shape e^(lambda t)), scaled so that the largest displacement of a frame, or turn
times the mechanism's size, is 1 and real. Source: Meirovitch, Fundamentals of Vibrations, ch. 7.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.analyses.modes import Mode
from mbsd.base.errors import MobilityError
from mbsd.base.names import Suggesting
from mbsd.dynamics.formulation import derivative
from mbsd.kinematics.pose.held_values import RANK_TOLERANCE
from mbsd.spatial.analyses.equilibrium import Equilibrium
from mbsd.spatial.arrays.packing import Packed, moved
from mbsd.spatial.dynamics.simulate import Run
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rotation import rotation_matrix

STEP = 2e-3
"""Deviation of differences, in sizes and rad."""
REAL = 1e-9
"""Part of an eigenvalue or shape below which its imaginary part is rounding."""
STENCIL = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}


@dataclass(frozen=True, eq=False)
class Linearisation(Suggesting):
    """x' = A x near a steady motion; x = N^+ of all deviations."""

    a: np.ndarray
    """(k, k)"""
    deviations: np.ndarray
    """(12 n, k) N: deviations of places and rotations of all bodies, then of velocities, by entries of x."""
    rigid: int
    """Motions that nothing resists, about an equilibrium; they come first, and so do their rates."""
    packed: Packed = field(repr=False)
    q: np.ndarray = field(repr=False)
    """(3 + 7 n,) the base pose."""

    @cached_property
    def eigenvalues(self) -> np.ndarray:
        """(k,) of A (1/s), by rising size."""
        free = 2 * self.rigid
        values = np.concatenate([np.zeros(free), np.linalg.eigvals(self.a[free:, free:])])
        return values[np.argsort(np.abs(values), kind="stable")]

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """All modes, by rising frequency."""
        return modes_of(self)


class _Accelerations:
    """Accelerations of a mechanism near a base motion."""

    def __init__(self, run: Run, q: np.ndarray, v: np.ndarray) -> None:
        self.run, self.q, self.v, self.packed = run, q, v, run.packed
        self.dyn, self.scratch, self.time = run.dynamics(), run.scratch(), float(run.grid[0])
        self.scale = self.packed.column_scale

    def evaluate(self, way: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Return accelerations (6 n,) in sizes and rad, in the world, at deviations of pose and velocity (6 n,)."""
        q = moved(self.q, way * self.scale)
        speed = (self.v[3:] + change * self.scale).reshape(-1, 6)
        turned = rotation_matrix(q[3:].reshape(-1, 7)[:, 3:])
        state = np.zeros((2, len(q)))
        state[0] = q
        state[1, 3 : 3 + speed.size] = np.hstack([speed[:, :3], np.einsum("bji,bj->bi", turned, speed[:, 3:])]).ravel()
        out = np.zeros_like(state)
        derivative(self.dyn, self.scratch, self.time, state, out, np.zeros(len(self.packed.ws.phi)))
        a = out[1, 3 : 3 + speed.size].reshape(-1, 6)
        return np.hstack([a[:, :3], np.einsum("bij,bj->bi", turned, a[:, 3:])]).ravel() / self.scale

    def rates(self, way: np.ndarray) -> np.ndarray:
        """Return J v_0 (h,), dimensionless, at a deviation of the pose."""
        q = moved(self.q, way * self.scale)
        return (self.packed.measured(q)[1] @ self.v[3:]) * self.packed.row_scale


def linearise(m: Model, at: Equilibrium | str) -> Linearisation:
    """Return the linearisation; see :meth:`mbsd.spatial.mechanism.Mechanism.linearise`."""
    time = at.time if isinstance(at, Equilibrium) else 0.0
    run = Run(m, np.array([time, time + 1.0]), 1e-9, "reference")
    q, v = (at.solution.q[0], np.zeros(run.packed.freedoms + 3)) if isinstance(at, Equilibrium) else run.start()
    run.packed.measured(q)
    near = _Accelerations(run, q, v)
    n = run.packed.freedoms
    rest = np.zeros(n)
    stiff = differences(lambda way: near.evaluate(way, rest), n)
    damped = differences(lambda change: near.evaluate(rest, change), n)
    jac = run.packed.scaled(q)
    rolling = run.packed.system.roll[:, :1] + [1, 2]
    places = np.setdiff1d(np.arange(len(jac)), rolling)
    if not v.any() and not rolling.size:
        return _about_rest(run.packed, q, stiff, damped, _null_space(jac))
    turned = np.zeros((n, n))
    for b, w in enumerate(v[3:].reshape(-1, 6)[:, 3:]):
        c = 6 * b + 3
        turned[c : c + 3, c : c + 3] = [[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]]
    whole = np.block([[turned, np.eye(n)], [stiff, damped]])
    bend = differences(near.rates, n)
    allowed = _null_space(np.block([[jac[places], np.zeros((len(places), n))], [bend, jac]]))
    _refuse_fixed(run.packed, allowed)
    return Linearisation(allowed.T @ whole @ allowed, allowed * np.tile(near.scale, 2)[:, None], 0, run.packed, q)


def _about_rest(
    packed: Packed, q: np.ndarray, stiff: np.ndarray, damped: np.ndarray, free: np.ndarray
) -> Linearisation:
    """Return the linearisation about an equilibrium, rigid motions first."""
    _refuse_fixed(packed, free)
    stiff, damped = free.T @ stiff @ free, free.T @ damped @ free
    both = np.vstack([stiff / max(np.abs(stiff).max(), 1e-300), damped / max(np.abs(damped).max(), 1e-300)])
    both[np.abs(both) < 1e-9] = 0.0
    _, singular, ways = np.linalg.svd(both)
    rank = int((singular > 1e-8 * max(singular.max(initial=0.0), 1e-300)).sum())
    rigid, own = ways[rank:].T, ways[:rank].T
    basis, count = np.hstack([rigid, own]), len(free.T) - rank
    k, c = basis.T @ stiff @ basis, basis.T @ damped @ basis
    k[:, :count] = c[:, :count] = 0.0
    f = len(k)
    a = np.block([[np.zeros((f, f)), np.eye(f)], [k, c]])
    order = np.concatenate([np.r_[:count], np.r_[f : f + count], np.r_[count:f], np.r_[f + count : 2 * f]]).astype(int)
    ways = free @ basis * packed.column_scale[:, None]
    none = np.zeros_like(ways)
    return Linearisation(a[np.ix_(order, order)], np.block([[ways, none], [none, ways]])[:, order], count, packed, q)


def differences(function: Callable[[np.ndarray], np.ndarray], n: int) -> np.ndarray:
    """Return the derivative (k, n) of a function (n,) -> (k,) at 0, by central differences of order 6."""
    columns = []
    for c in range(n):
        way = np.zeros(n)
        total: np.ndarray | float = 0.0
        for step, weight in STENCIL.items():
            way[c] = step * STEP
            ahead = function(way)
            way[c] = -step * STEP
            total = total + weight / STEP * (ahead - function(way))
        columns.append(total)
    return np.array(columns).T


def _null_space(matrix: np.ndarray) -> np.ndarray:
    _, singular, v = np.linalg.svd(matrix, full_matrices=True)
    return v[int((singular > RANK_TOLERANCE * max(1.0, singular.max(initial=0.0))).sum()) :].T


def _refuse_fixed(packed: Packed, free: np.ndarray) -> None:
    if not free.shape[1]:
        raise MobilityError(f"{packed.name}: nothing can move: joints and drivers fix all bodies. Release a driver")


def modes_of(linear: Linearisation) -> tuple[Mode, ...]:
    """Return all modes by rising frequency: free rigid motions, then one for each pair or real eigenvalue."""
    free, half = 2 * linear.rigid, len(linear.deviations) // 2
    values, vectors = np.linalg.eig(linear.a[free:, free:])
    pairs = [(0.0 + 0.0j, linear.deviations[:half, k]) for k in range(linear.rigid)]
    for value, vector in zip(values, vectors.T, strict=True):
        if value.imag < -REAL * abs(value):
            continue
        # rigid entries follow: x_r'' = A_r x, so x_r = A_r x / lambda^2
        whole = np.zeros(len(linear.a), complex)
        whole[free:] = vector
        if linear.rigid and value != 0.0:
            drift = linear.a[linear.rigid : free, free:] @ vector
            whole[: linear.rigid] = drift / value**2
        pairs.append((complex(value), linear.deviations[:half] @ whole))
    pairs.sort(key=lambda mode: abs(mode[0]))
    return tuple(Mode(value, _shape(linear, way), {}) for value, way in pairs)


def _shape(linear: Linearisation, way: np.ndarray) -> dict[str, np.ndarray]:
    """Return place and rotation vector (6,) of each body's frame in a deviation (6 n,) of centres of mass."""
    packed, shape = linear.packed, dict[str, Any]()
    for b, body in enumerate(packed.bodies[1:], 1):
        moved = np.array(way[6 * b - 6 : 6 * b])
        turned = rotation_matrix(linear.q[7 * b - 1 : 7 * b + 3])
        arm = turned @ (body.principal[1].T @ -np.array(body.com))
        moved[:3] += np.cross(moved[3:], arm)
        shape[body.name] = moved
    sized = np.array([part / np.repeat([1.0, 1.0 / packed.size], 3) for part in shape.values()]).ravel()
    largest = sized[int(np.argmax(np.abs(sized)))]
    out = {name: part / largest for name, part in shape.items()} if largest != 0.0 else shape
    return {name: part.real if np.abs(part.imag).max(initial=0.0) < REAL else part for name, part in out.items()}
