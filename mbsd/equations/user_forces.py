"""The kernel that calls the functions of the user's forces; see mbsd/model/forces/user_force.py."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.compiling.jit import apart


@apart
def apply_user_forces(loads, t, q, v, cos_sin, load):
    """Add the generalised forces of all functions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    Returns their power (W).
    """
    given = loads.exchange[0]
    out = loads.exchange[1]
    power = 0.0
    for k in range(loads.user.shape[0]):
        first = loads.user[k, 1]
        count = loads.user[k, 2]
        for n in range(count):
            b = loads.user_body[first + n]
            c = cos_sin[b, 0]
            s = cos_sin[b, 1]
            x = c * loads.user_com[first + n, 0] - s * loads.user_com[first + n, 1]
            y = s * loads.user_com[first + n, 0] + c * loads.user_com[first + n, 1]
            rate = 3 * (count + n)
            given[3 * n] = q[3 * b] - x
            given[3 * n + 1] = q[3 * b + 1] - y
            given[3 * n + 2] = q[3 * b + 2]
            given[rate] = v[3 * b] + v[3 * b + 2] * y
            given[rate + 1] = v[3 * b + 1] - v[3 * b + 2] * x
            given[rate + 2] = v[3 * b + 2]
        call(loads.user[k, 0], t, given, out)  # pyright: ignore[reportCallIssue]
        for n in range(count):
            b = loads.user_body[first + n]
            rate = 3 * (count + n)
            fx = out[3 * n]
            fy = out[3 * n + 1]
            load[3 * b] += fx
            load[3 * b + 1] += fy
            # the frame's origin against the centre of mass
            x = given[3 * n] - q[3 * b]
            y = given[3 * n + 1] - q[3 * b + 1]
            load[3 * b + 2] += out[3 * n + 2] + x * fy - y * fx
            power += fx * given[rate] + fy * given[rate + 1] + out[3 * n + 2] * given[rate + 2]
    return power
