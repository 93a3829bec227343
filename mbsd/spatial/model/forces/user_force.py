"""Force by a function of the user: of time, places and velocities of frames.

    (force and moment at each frame in turn) = function(t, q, v)

q (7 f,): place (m) and Euler parameters (w, x, y, z) of each frame; v (6 f,): velocity (m/s) and angular velocity
(rad/s) of each, in the world. It returns 6 numbers a frame (N, N m; world axes). Nothing feels the opposite unless the
function gives it to another frame. A function compiled with numba.njit is compiled in.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.spatial.model.body import Fixing, Marker
from mbsd.spatial.model.entries import add_force, own_marker
from mbsd.spatial.model.force import Call, Force, ForceKind, no_rows, register_force
from mbsd.spatial.model.mechanism import Model, own_body


def _wind_and_spring(t: Any, q: Any, v: Any) -> Any:
    return 2.0 * t - 3.0 * q[0] - 0.4 * v[0], 1.0 + q[1] * q[2], -0.7 * v[2], 0.2 * q[4], -0.1 * v[4], 0.3 * v[5] * t


USER_FORCE = register_force(
    ForceKind(
        "user_force",
        no_rows,
        call=lambda f: Call(f.params["function"], f.params["frames"]),
        example=lambda m, i, j: m.user_force("example", _wind_and_spring, j),
    )
)


@USER_FORCE.adds
def user_force(m: Model, name: str, function: Callable[..., Any], *frames: Fixing) -> Force:
    """Add forces on frames, bodies or markers, by ``function(t, q, v)``, Python or compiled with numba.njit.

    q has place and Euler parameters of each frame, 7 numbers, v velocity and angular velocity, 6 numbers; the function
    returns force (N) and moment (N m) at each frame in turn, 6 numbers a frame. All in the axes of the world.
    """
    what = f"{m.name}: force '{name}'"
    if not callable(function):
        raise ModelError(f"{what} needs a function of t, q and v, got {shown(function)}")
    if not frames:
        raise ModelError(f"{what} needs the frames it acts on: bodies or markers after its function")
    own = tuple(
        own_marker(m, what, frame) if isinstance(frame, Marker) else own_body(m, frame, what).origin for frame in frames
    )
    return add_force(m, USER_FORCE, name, m.ground.origin, own[-1], {"function": function, "frames": own})
