"""Inverse dynamics along a known motion, and how well that motion fulfils its equations.

    J^T lam = Q - M a                  Q: gravity
    reaction on body b = -J_b^T lam, given at the joint's second marker: fx, fy, torque
    effort of a driver = -lam of its row;  power = effort f'

M is constant and diagonal because q holds centres of mass. Source: Haug 1989, ch. 6.
"""

from __future__ import annotations

from mbsd.assembly import evaluate_gamma, evaluate_nu, residual_and_jacobian
from mbsd.elimination import factorise, solve_transposed
from mbsd.jit import kernel


@kernel
def inverse_dynamics(system, seq, fac, ws, first_row, second_marker, drives, q, v, a, lam, wrench, checks, jacobians):
    """Multipliers and reactions at every time.

    q, v, a (T, 3 nb); lam (T, m); wrench (T, joints, 3): fx, fy, torque on the second body at ``second_marker``;
    checks (T, 4): largest |Phi|, |J v - nu|, |J a - gamma| and |d(T + V)/dt - power of the drivers|;
    jacobians (T, m, n) for the singularity margin.
    """
    n3 = q.shape[1]
    rhs = ws.rate
    for k in range(q.shape[0]):
        residual_and_jacobian(system, q[k], drives[k], ws)
        evaluate_nu(system, drives[k], ws)
        evaluate_gamma(system, v[k], drives[k], ws)
        factorise(seq, ws.jac, fac)
        power = 0.0
        for b in range(system.mass.shape[0]):
            for c in range(3):
                load = system.mass[b] * system.gravity[c] if c < 2 else 0.0
                inertia = system.mass[b] if c < 2 else system.inertia[b]
                rhs[3 * b + c] = load - inertia * a[k, 3 * b + c]
                power -= rhs[3 * b + c] * v[k, 3 * b + c]
        solve_transposed(seq, fac, rhs, lam[k])
        for r in range(ws.phi.shape[0]):
            rate, bend = -ws.nu[r], -ws.gamma[r]
            for c in range(3, n3):
                jacobians[k, r, c - 3] = ws.jac[r, c]
                rate += ws.jac[r, c] * v[k, c]
                bend += ws.jac[r, c] * a[k, c]
            checks[k, 0] = max(checks[k, 0], abs(ws.phi[r]))
            checks[k, 1] = max(checks[k, 1], abs(rate))
            checks[k, 2] = max(checks[k, 2], abs(bend))
            power += lam[k, r] * ws.nu[r]
        checks[k, 3] = abs(power)
        joint_wrenches(system, ws, first_row, second_marker, lam[k], wrench[k])


@kernel
def joint_wrenches(system, ws, first_row, second_marker, lam, wrench):
    """-J_b^T lam of each joint on its second body b, moved from the centre of mass to the second marker."""
    for joint in range(second_marker.shape[0]):
        marker = second_marker[joint]
        column = 3 * system.marker_body[marker]
        fx, fy, torque = 0.0, 0.0, 0.0
        for r in range(first_row[joint], first_row[joint + 1]):
            fx -= ws.jac[r, column] * lam[r]
            fy -= ws.jac[r, column + 1] * lam[r]
            torque -= ws.jac[r, column + 2] * lam[r]
        wrench[joint, 0], wrench[joint, 1] = fx, fy
        wrench[joint, 2] = torque - (ws.arm[marker, 0] * fy - ws.arm[marker, 1] * fx)
