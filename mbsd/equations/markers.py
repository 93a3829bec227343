"""Where the markers are and how they move: one kernel for all of them.

    arm      s = R(theta) s_local
    position p = r + s
    axis     u = R(theta) u_local
    velocity p' = r' + omega s_perp,              s_perp = (-s_y, s_x) = ds/dtheta
    convective acceleration c = -omega^2 s        (p'' = r'' + alpha s_perp + c)

Source: Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, 1989, ch. 2.4 and 3.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.equations.system import PLACE


@inlined
def place(system, q, ws):
    """Fill arm, position and axis of the markers from q (3 nb,); those of ground never change."""
    for b in range(1, system.mass.shape[0]):
        theta = q[3 * b + 2]
        ws.cos_sin[b, 0] = math.cos(theta)
        ws.cos_sin[b, 1] = math.sin(theta)
    for coded in system.moving:
        k = coded & PLACE
        b = system.marker_body[k] & PLACE
        c = ws.cos_sin[b, 0]
        s = ws.cos_sin[b, 1]
        x = system.marker_arm[k, 0]
        y = system.marker_arm[k, 1]
        arm_x = c * x - s * y
        arm_y = s * x + c * y
        ws.arm[k, 0] = arm_x
        ws.arm[k, 1] = arm_y
        ws.position[k, 0] = q[3 * b] + arm_x
        ws.position[k, 1] = q[3 * b + 1] + arm_y
    for coded in system.directed:
        k = coded & PLACE
        b = system.marker_body[k] & PLACE
        c = ws.cos_sin[b, 0]
        s = ws.cos_sin[b, 1]
        x = system.marker_axis[k, 0]
        y = system.marker_axis[k, 1]
        ws.axis[k, 0] = c * x - s * y
        ws.axis[k, 1] = s * x + c * y


@inlined
def move(system, v, ws):
    """Fill velocity and convective acceleration of the markers from v (3 nb,), after place."""
    for coded in system.moving:
        k = coded & PLACE
        b = 3 * (system.marker_body[k] & PLACE)
        omega = v[b + 2]
        ws.velocity[k, 0] = v[b] - omega * ws.arm[k, 1]
        ws.velocity[k, 1] = v[b + 1] + omega * ws.arm[k, 0]
        ws.convective[k, 0] = -omega * omega * ws.arm[k, 0]
        ws.convective[k, 1] = -omega * omega * ws.arm[k, 1]
