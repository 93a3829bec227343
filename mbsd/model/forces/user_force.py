"""Force by a function of the user: of time, places and velocities of named bodies.

    (fx, fy, torque of each body in turn) = function(t, q, v)

q, v: x, y, theta and their rates of each body's frame in turn, 3 numbers a body (m, rad, m/s, rad/s; world axes).
The force acts at the frame's origin. Nothing feels the opposite unless the function gives it to another body.
A function compiled with numba.njit is compiled in; a Python function costs a few microseconds a call.
"""

from __future__ import annotations

from typing import Any

from mbsd.model.forces.kind import ForceKind, register


def _wind_and_spring(t: Any, q: Any, v: Any) -> Any:
    return 2.0 * t - 3.0 * q[0] - 0.4 * v[0], 1.0 + q[1] * q[2], -0.7 * v[2] + q[0]


USER_FORCE = register(
    ForceKind(
        "user_force",
        example=lambda m, i, j: m.user_force("example", _wind_and_spring, j.body),
        outside=True,
        saved=False,
    )
)
