"""Constraints F(x, y, a) = f(t) of two markers' relative pose: gears, rolling, curves, cams, users'.

d     = p_j - p_i;   u = unit axis of marker i;   n = u_perp
x     = u . d,   y = n . d,   a = theta_j - theta_i + offset
J_x   = [-u, y - u . s_perp_i] on body i;    [u, u . s_perp_j] on body j
J_y   = [-n, -x - n . s_perp_i] on body i;   [n, n . s_perp_j] on body j
J_a   = [0, -1] on body i;                   [0, 1] on body j
gamma_x = -( u . (c_j - c_i) + 2 omega_i n . d' - omega_i^2 x ),   so that J_x a - gamma_x = x''
gamma_y = -( n . (c_j - c_i) - 2 omega_i u . d' - omega_i^2 y )

Phi   = F(x, y, a) - f(t)                                                      1 row
J     = F_x J_x + F_y J_y + F_a J_a
gamma = F_x gamma_x + F_y gamma_y - z'^T F_zz z' + f''
        z = (x, y, a),  x' = u . d' + omega_i y,  y' = n . d' - omega_i x,  a' = omega_j - omega_i

Source: chain rule; the relative coordinates are those of the files along.py, slot.py and angle.py.
"""

from __future__ import annotations

from mbsd.compiling.jit import lazy
from mbsd.equations.relative.equation import FA, FAA, FX, FXA, FXX, FXY, FY, FYA, FYY, TURN, A, F, X, Y, evaluate


@lazy(None)
def rows(system, q, drive, ws):
    """Residual and Jacobian. A row that is left out is zero."""
    for k in range(system.special.shape[0]):
        i = system.special[k, MARKER_I]
        j = system.special[k, MARKER_J]
        r = system.special[k, ROW]
        if system.special[k, ACTIVE] == 0:
            ws.phi[r] = 0.0
            for c in range(6):
                ws.jac[r, c] = 0.0
            continue
        at = system.special[k, AT]
        turned = q[3 * system.marker_body[i] + 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        x = ux * dx + uy * dy
        y = ux * dy - uy * dx
        relative = ws.relative[k]
        relative[X] = x
        relative[Y] = y
        relative[A] = q[3 * system.marker_body[j] + 2] - turned + system.numbers[at]
        relative[TURN] = q[3 * system.special[k, ARM] + 2] - turned
        out = ws.equation[k]
        evaluate(system.address[k], system.numbers[at:], relative, out)
        ws.phi[r] = out[F] - drive[system.special[k, MOTION], 0]
        gx = out[FX] * ux - out[FY] * uy
        gy = out[FX] * uy + out[FY] * ux
        ws.jac[r, 0] = -gx
        ws.jac[r, 1] = -gy
        ws.jac[r, 2] = out[FX] * y - out[FY] * x + gx * ws.arm[i, 1] - gy * ws.arm[i, 0] - out[FA]
        ws.jac[r, 3] = gx
        ws.jac[r, 4] = gy
        ws.jac[r, 5] = -gx * ws.arm[j, 1] + gy * ws.arm[j, 0] + out[FA]


@lazy(None)
def gamma_rows(system, v, ws, gamma):
    """Acceleration right-hand side without f'', after rows at the same pose."""
    for k in range(system.special.shape[0]):
        i = system.special[k, MARKER_I]
        j = system.special[k, MARKER_J]
        out = ws.equation[k]
        omega = v[3 * system.marker_body[i] + 2]
        ux = ws.axis[i, 0]
        uy = ws.axis[i, 1]
        dx = ws.position[j, 0] - ws.position[i, 0]
        dy = ws.position[j, 1] - ws.position[i, 1]
        x = ux * dx + uy * dy
        y = ux * dy - uy * dx
        vx = ws.velocity[j, 0] - ws.velocity[i, 0]
        vy = ws.velocity[j, 1] - ws.velocity[i, 1]
        along = ux * vx + uy * vy
        across = ux * vy - uy * vx
        cx = ws.convective[j, 0] - ws.convective[i, 0]
        cy = ws.convective[j, 1] - ws.convective[i, 1]
        gamma_x = -(ux * cx + uy * cy + 2.0 * omega * across - omega * omega * x)
        gamma_y = -(ux * cy - uy * cx - 2.0 * omega * along - omega * omega * y)
        x_rate = along + omega * y
        y_rate = across - omega * x
        a_rate = v[3 * system.marker_body[j] + 2] - omega
        bend = (
            out[FXX] * x_rate * x_rate
            + out[FYY] * y_rate * y_rate
            + out[FAA] * a_rate * a_rate
            + 2.0 * (out[FXY] * x_rate * y_rate + out[FXA] * x_rate * a_rate + out[FYA] * y_rate * a_rate)
        )
        gamma[system.special[k, ROW]] = out[FX] * gamma_x + out[FY] * gamma_y - bend


MARKER_I, MARKER_J, ROW, MOTION, AT, ARM, ACTIVE = range(7)
"""Columns of the table: markers, row, motion, first number, body of the arm, 0 while the row is left out."""
