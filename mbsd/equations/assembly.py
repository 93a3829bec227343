"""Compiled evaluation of all constraints: residual, Jacobian, velocity and acceleration terms.

Phi(q, t) = 0,   J v = nu,   J a = gamma
"""

from __future__ import annotations

import numpy as np

from mbsd.compiling.jit import apart, inlined, kernel
from mbsd.equations.constraints import (
    along_gamma,
    along_rows,
    angle_gamma,
    angle_rows,
    distance_gamma,
    distance_rows,
    point_gamma,
    point_rows,
    slot_gamma,
    slot_rows,
)
from mbsd.equations.relative.equation import relative_gamma, relative_rows
from mbsd.equations.system import move, place


@inlined
def _begin_position(system, q, drive, ws):
    """Evaluate all positions but slots, ways along them, and distances."""
    place(system, q, ws)
    point_rows(system, ws)
    angle_rows(system, q, drive, ws)
    if system.special.shape[0] > 0:
        relative_rows(system, q, drive, ws)


@inlined
def _begin_gamma(system, v, drive, ws, gamma):
    """Evaluate all of gamma but slots, ways along them, distances and drivers."""
    move(system, v, ws)
    point_gamma(system, ws, gamma)
    angle_gamma(system, gamma)
    if system.special.shape[0] > 0:
        relative_gamma(system, v, ws, gamma)


@inlined
def _add_drivers(system, drive, gamma):
    for k in range(system.driven.shape[0]):
        gamma[system.driven[k, 0]] += drive[system.driven[k, 1], 2]


@inlined
def evaluate_position(system, q, drive, ws):
    """Fill ws.phi and ws.jac at q (3 nb,). ``drive`` is (motions, 3): f, f', f'' now; row 0 is zero."""
    _begin_position(system, q, drive, ws)
    slot_rows(system, ws)
    along_rows(system, drive, ws)
    distance_rows(system, drive, ws)


@inlined
def evaluate_nu(system, drive, nu):
    """Fill nu (m,): f' in driven rows, else zero."""
    for r in range(nu.shape[0]):
        nu[r] = 0.0
    for k in range(system.driven.shape[0]):
        nu[system.driven[k, 0]] = drive[system.driven[k, 1], 1]


@inlined
def evaluate_gamma(system, v, drive, ws, gamma):
    """Fill gamma (m,) at velocities v (3 nb,), after evaluate_position at the same pose."""
    _begin_gamma(system, v, drive, ws, gamma)
    slot_gamma(system, v, ws, gamma)
    along_gamma(system, v, ws, gamma)
    distance_gamma(system, ws, gamma)
    _add_drivers(system, drive, gamma)


@apart
def position(system, q, drive, ws):
    """Call evaluate_position, for kernels that do not contain it."""
    evaluate_position(system, q, drive, ws)


@inlined
def _keep_rows(ws, k, phi, jacobians):
    for r in range(ws.phi.shape[0]):
        phi[k, r] = ws.phi[r]
        for c in range(6):
            jacobians[k, r, c] = ws.jac[r, c]


@kernel
def tabulate_all(system, drives, q, v, ws, phi, jacobians, gamma):
    """Tabulate as ``tabulate`` for all mechanisms."""
    for k in range(q.shape[0]):
        evaluate_position(system, q[k], drives[k], ws)
        if phi.shape[0] > 0:
            evaluate_gamma(system, v[k], drives[k], ws, gamma[k])
            _keep_rows(ws, k, phi, jacobians)


@kernel
def tabulate_some(system, drives, q, v, ws, phi, jacobians, gamma):
    """Tabulate without slots, ways along them and distances: this compiles in half the time."""
    for k in range(q.shape[0]):
        _begin_position(system, q[k], drives[k], ws)
        if phi.shape[0] > 0:
            _begin_gamma(system, v[k], drives[k], ws, gamma[k])
            _add_drivers(system, drives[k], gamma[k])
            _keep_rows(ws, k, phi, jacobians)


def tabulate(system, drives, q, v, ws, phi, jacobians, gamma):
    """Fill phi, gamma (T, m) and compact J (T, m, 6) along q, v (T, 3 nb); none if phi is empty.

    Called from Python.
    """
    more = len(system.slot) + len(system.along) + len(system.distance)
    (tabulate_all if more else tabulate_some)(system, drives, q, v, ws, phi, jacobians, gamma)


_NO_ROWS, _NO_JACOBIANS = np.zeros((0, 0)), np.zeros((0, 0, 0))


def residual_and_jacobian(system, q, drive, ws):
    """Fill ws.phi and ws.jac at q (3 nb,), from Python; the machine code of ``tabulate`` serves."""
    tabulate(system, drive[None], q[None], q[None], ws, _NO_ROWS, _NO_JACOBIANS, _NO_ROWS)
