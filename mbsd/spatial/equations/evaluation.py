"""Phi, J, nu and gamma of all rows, and the loads and wrenches that multipliers answer and give.

Of a row with a law f(t):

    Phi = sum - value - f,  nu = f',  gamma = f'' - (second derivative of the sum at constant rates)
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, inlined, internal, kernel
from mbsd.spatial.equations.along import bend_alongs, measure_alongs
from mbsd.spatial.equations.distance import bend_distances, measure_distances
from mbsd.spatial.equations.dot import bend_dots, measure_dots
from mbsd.spatial.equations.forces import apply_forces
from mbsd.spatial.equations.point import bend_points, measure_points
from mbsd.spatial.equations.roll import bend_rolls, measure_rolls
from mbsd.spatial.equations.turn import bend_turns, measure_turns
from mbsd.spatial.equations.vectors import carry_vectors, rotate_bodies, turn_vectors


@internal
def evaluate_position(system, q, drive, ws):
    """Fill ws.phi (m,) and ws.jac (m, 6 k) at coordinates q (3 + 7 n,) and laws drive (drivers + 1, 3)."""
    rotate_bodies(system, q, ws)
    evaluate_rows(system, q, drive, ws)


@internal
def evaluate_rows(system, q, drive, ws):
    """Fill ws.phi and ws.jac as evaluate_position does, where rotations are known."""
    carry_vectors(system, q, ws)
    for r in range(ws.phi.shape[0]):
        ws.phi[r] = -system.value[r]
        for c in range(ws.jac.shape[1]):
            ws.jac[r, c] = 0.0
    for n in range(system.driven.shape[0]):
        ws.phi[system.driven[n, 0]] -= drive[system.driven[n, 1], 0]
    measure_points(system, ws)
    measure_dots(system, ws)
    measure_alongs(system, ws)
    if system.distance.shape[0] > 0:
        measure_distances(system, ws)
    if system.turn.shape[0] > 0:
        measure_turns(system, ws)
    if system.roll.shape[0] > 0:
        measure_rolls(system, ws)


@inlined
def evaluate_nu(system, drive, out):
    """Fill out (m,) with the rates of the laws."""
    for r in range(out.shape[0]):
        out[r] = 0.0
    for n in range(system.driven.shape[0]):
        out[system.driven[n, 0]] = drive[system.driven[n, 1], 1]


@internal
def evaluate_gamma(system, v, drive, ws, out):
    """Fill out (m,) with gamma at velocities v (3 + 6 n,) and the place last evaluated, and ws.turn_rate."""
    turn_vectors(system, v, ws)
    for r in range(out.shape[0]):
        out[r] = 0.0
    for n in range(system.driven.shape[0]):
        out[system.driven[n, 0]] = drive[system.driven[n, 1], 2]
    bend_points(system, ws, out)
    bend_dots(system, ws, out)
    bend_alongs(system, ws, out)
    if system.distance.shape[0] > 0:
        bend_distances(system, ws, out)
    if system.turn.shape[0] > 0:
        bend_turns(system, ws, out)
    if system.roll.shape[0] > 0:
        bend_rolls(system, ws, out)


@apart
def find_loads(system, v, a, ws, load):
    """Fill load (3 + 6 n,) with weight less inertia: m (g - r''), -(I w' + w x I w), in the world.

    v and a (3 + 6 n,) are velocities and accelerations; rotations are those last evaluated.
    """
    for b in range(1, system.mass.shape[0]):
        c = 6 * b - 3
        for k in range(3):
            load[c + k] = system.mass[b] * (system.gravity[k] - a[c + k])
            load[c + 3 + k] = 0.0
        m = ws.rotation[b]
        moment = system.inertia[b]
        p = m[0, 0] * v[c + 3] + m[1, 0] * v[c + 4] + m[2, 0] * v[c + 5]
        q = m[0, 1] * v[c + 3] + m[1, 1] * v[c + 4] + m[2, 1] * v[c + 5]
        r = m[0, 2] * v[c + 3] + m[1, 2] * v[c + 4] + m[2, 2] * v[c + 5]
        x = m[0, 0] * a[c + 3] + m[1, 0] * a[c + 4] + m[2, 0] * a[c + 5]
        y = m[0, 1] * a[c + 3] + m[1, 1] * a[c + 4] + m[2, 1] * a[c + 5]
        z = m[0, 2] * a[c + 3] + m[1, 2] * a[c + 4] + m[2, 2] * a[c + 5]
        x = moment[0] * x + (moment[2] - moment[1]) * q * r
        y = moment[1] * y + (moment[0] - moment[2]) * r * p
        z = moment[2] * z + (moment[1] - moment[0]) * p * q
        for k in range(3):
            load[c + 3 + k] = -(m[k, 0] * x + m[k, 1] * y + m[k, 2] * z)


@apart
def find_wrenches(system, ws, lam, out):
    """Fill out (joints, 6): force and moment at its place, in the world, of each joint on its second body."""
    for n in range(out.shape[0]):
        for k in range(6):
            out[n, k] = 0.0
    for r in range(lam.shape[0]):
        joint = system.wrench[r, 0]
        if joint >= 0:
            c = system.wrench[r, 1]
            for k in range(6):
                out[joint, k] -= lam[r] * ws.jac[r, c + k]
    for n in range(out.shape[0]):
        s = ws.arm[system.joint_arm[n]]
        f = out[n]
        f[3] -= s[1] * f[2] - s[2] * f[1]
        f[4] -= s[2] * f[0] - s[0] * f[2]
        f[5] -= s[0] * f[1] - s[1] * f[0]


@kernel
def tabulate(system, drives, q, v, turns, ws, phi, jac, gamma):
    """Fill phi (T, m), jac (T, m, 6 k) and gamma (T, m) along q, v and counted turns (T, ...)."""
    for k in range(q.shape[0]):
        for n in range(ws.guess.shape[0]):
            ws.guess[n] = turns[k, n]
        evaluate_position(system, q[k], drives[k], ws)
        evaluate_gamma(system, v[k], drives[k], ws, gamma[k])
        for r in range(phi.shape[1]):
            phi[k, r] = ws.phi[r]
            for c in range(jac.shape[2]):
                jac[k, r, c] = ws.jac[r, c]


@kernel
def tabulate_loads(system, laws, times, drives, q, v, a, turns, ws, load, lam):
    """Fill load (T, 3 + 6 n) with weight, forces and less inertia, and lam (T, m) of the rows of forces."""
    for k in range(q.shape[0]):
        for n in range(ws.guess.shape[0]):
            ws.guess[n] = turns[k, n]
        evaluate_position(system, q[k], drives[k], ws)
        find_loads(system, v[k], a[k], ws, load[k])
        if system.force.shape[0] + system.call.shape[0] > 0:
            apply_forces(system, laws, times[k], q[k], v[k], ws, load[k], lam[k])


@kernel
def wrenches_along(system, drives, q, ws, lam, out):
    """Fill out (T, joints, 6) with the wrenches of multipliers lam (T, m) along q (T, 3 + 7 n)."""
    for k in range(q.shape[0]):
        evaluate_position(system, q[k], drives[k], ws)
        find_wrenches(system, ws, lam[k], out[k])


@kernel
def measure(system, q, drive, ws):
    """Fill ws.phi and ws.jac, for callers in Python."""
    evaluate_position(system, q, drive, ws)
