"""Inverse dynamics along a known motion.

    J^T lam = Q - M a                  Q: gravity
    reaction on body b = -J_b^T lam, given at the joint's second marker: fx, fy, torque
    effort of a driver = -lam of its row;  power = effort f'

M is constant and diagonal because q holds centres of mass. Source: Haug 1989, ch. 6.
"""

from __future__ import annotations

from mbsd.assembly import evaluate_gamma, residual_and_jacobian
from mbsd.elimination import factorise, solve_transposed
from mbsd.jit import kernel


@kernel
def inverse_dynamics(
    system, seq, fac, ws, first_row, second_marker, drives, q, v, loads, lam, wrench, phi, gamma, jacobians
):
    """Multipliers and reactions at every time.

    q, v (T, 3 nb); loads (T, 3 nb): Q - M a; filled: lam, phi, gamma (T, m), jacobians (T, m, n) and
    wrench (T, joints, 3): fx, fy, torque on the second body at ``second_marker``.
    """
    for k in range(q.shape[0]):
        residual_and_jacobian(system, q[k], drives[k], ws)
        factorise(seq, ws.jac, fac)
        solve_transposed(seq, fac, loads[k], lam[k])
        joint_wrenches(system, ws, first_row, second_marker, lam[k], wrench[k])
        evaluate_gamma(system, v[k], drives[k], ws)
        for r in range(ws.phi.shape[0]):
            phi[k, r], gamma[k, r] = ws.phi[r], ws.right[r]
            for c in range(3, q.shape[1]):
                jacobians[k, r, c - 3] = ws.jac[r, c]


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
