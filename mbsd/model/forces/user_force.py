"""Force by a function of the user: of time, places and velocities of named bodies.

    (fx, fy, torque of each body in turn) = function(t, q, v)

q, v: x, y, theta and their rates of each body's frame in turn, 3 numbers a body (m, rad, m/s, rad/s; world axes).
The force acts at the frame's origin. Nothing feels the opposite unless the function gives it to another body.
A function compiled with numba.njit is compiled in; a Python function costs a few microseconds a call.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Body
from mbsd.model.entries import add_force
from mbsd.model.force import Force, ForceKind, register_force
from mbsd.model.laws.function import checked_pulses
from mbsd.model.mechanism import Model, own_body


def _wind_and_spring(t: Any, q: Any, v: Any) -> Any:
    return 2.0 * t - 3.0 * q[0] - 0.4 * v[0], 1.0 + q[1] * q[2], -0.7 * v[2] + q[0]


USER_FORCE = register_force(
    ForceKind(
        "user_force",
        example=lambda m, i, j: m.user_force("example", _wind_and_spring, j.body),
        outside=True,
        on_bodies=True,
        saved=False,
    )
)


@USER_FORCE.adds
def user_force(
    m: Model,
    name: str,
    function: Callable[..., Any],
    *bodies: Body | str,
    breaks: Sequence[float] = (),
    shortest: float | None = None,
) -> Force:
    """Add forces on bodies by a user function ``function(t, q, v)``, Python or compiled with numba.njit.

    q and v hold x, y, theta and their rates of the bodies' frames, three numbers a body in the order given; the
    function returns fx, fy (N, at the frame's origin) and torque (N m) of each body in that order.

    A simulation looks at it at 2583 times before, with the bodies as they start, so that steps end where it jumps
    or is short. ``breaks`` (s): where else it jumps. ``shortest`` (s): how long the shortest thing in it lasts, if
    that depends on the motion or is less than 1/2000 of the duration; no step is longer.
    """
    what = f"force '{name}'"
    if not callable(function):
        raise ModelError(f"{m.name}: {what} needs a function of t, q and v, got {shown(function)}")
    own = [own_body(m, body, what) for body in bodies]
    if not own or len(set(map(id, own))) < len(own):
        raise ModelError(f"{m.name}: {what} needs the bodies it acts on, each once")
    at, least = checked_pulses(f"{m.name}: {what}", breaks, shortest)
    params: dict[str, Any] = {"function": function, "bodies": [body.name for body in own]}
    params |= ({"breaks": at} if at else {}) | ({"shortest": least} if least else {})
    return add_force(m, USER_FORCE, name, m.ground.origin, own[0].origin, params, same_body=True)
