"""The kernel that calls the functions of the user's forces; see mbsd/model/forces/user_force.py."""

from __future__ import annotations

from mbsd.compiling.callback import call
from mbsd.compiling.jit import lazy


@lazy(float)
def apply_user_forces(user, user_body, user_com, exchange, t, q, v, cos_sin, load):
    """Add the generalised forces of all functions to load (3 nb,); cos_sin (nb, 2) turns the bodies.

    The first four are those of Loads. Returns their power (W).
    """
    given = exchange[0]
    out = exchange[1]
    power = 0.0
    for k in range(user.shape[0]):
        first = user[k, 1]
        count = user[k, 2]
        for n in range(count):
            b = user_body[first + n]
            c = cos_sin[b, 0]
            s = cos_sin[b, 1]
            x = c * user_com[first + n, 0] - s * user_com[first + n, 1]
            y = s * user_com[first + n, 0] + c * user_com[first + n, 1]
            rate = 3 * (count + n)
            given[3 * n] = q[3 * b] - x
            given[3 * n + 1] = q[3 * b + 1] - y
            given[3 * n + 2] = q[3 * b + 2]
            given[rate] = v[3 * b] + v[3 * b + 2] * y
            given[rate + 1] = v[3 * b + 1] - v[3 * b + 2] * x
            given[rate + 2] = v[3 * b + 2]
        call(user[k, 0], t, given, out)  # pyright: ignore[reportCallIssue]
        for n in range(count):
            b = user_body[first + n]
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
