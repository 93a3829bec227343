"""User-defined constraint: a function of the relative pose of marker j against marker i is zero.

    Phi = function(x, y, a)        constraint `user`, 1 row

x, y: place of marker j in the axes of marker i (m), a: its angle against marker i (rad); with a marker of ground as i
this is the pose in the world. The value alone is enough; derivatives come by complex steps, or by differences where the
function does not take complex numbers. A function compiled with numba.njit is compiled in.
"""

from __future__ import annotations

from typing import Any

from mbsd.model.joints.kind import JointKind, register


def _ellipse(x: Any, y: Any, a: Any) -> Any:
    """A point that runs on an ellipse which the body's own turning widens."""
    return x * x / (1.0 + 0.1 * a * a) + y * y / 4.0 - 1.0 + 0.3 * x * a


CONSTRAINT = register(
    JointKind(
        "constraint",
        ("user",),
        example=lambda m, i, j: m.constraint("example", i, j, _ellipse),
        saved=False,
    )
)
