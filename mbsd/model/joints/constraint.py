"""User-defined constraint: a function of the relative pose of marker j against marker i is zero.

    Phi = function(x, y, a)        constraint `user`, 1 row

x, y: place of marker j in the axes of marker i (m), a: its angle against marker i (rad); with a marker of ground as i
this is the pose in the world. The value alone is enough; derivatives come by complex steps, or by differences where the
function does not take complex numbers. A function compiled with numba.njit is compiled in.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.model.body import Marker
from mbsd.model.entries import join
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.mechanism import Model


def _ellipse(x: Any, y: Any, a: Any) -> Any:
    """A point that runs on an ellipse which the body's own turning widens."""
    return x * x / (1.0 + 0.1 * a * a) + y * y / 4.0 - 1.0 + 0.3 * x * a


CONSTRAINT = register_joint(
    JointKind(
        "constraint",
        ("user",),
        example=lambda m, i, j: m.constraint("example", i, j, _ellipse),
        saved=False,
        touching="place",
    )
)


@CONSTRAINT.adds
def constraint(
    m: Model, name: str, i: Marker, j: Marker, function: Callable[[float, float, float], float], unit: str = "m"
) -> Joint:
    """``function(x, y, a)`` of the pose of marker j in the axes of marker i (m, rad) is zero.

    Python or numba.njit; its derivatives are found. ``unit`` is that of its value, "m" or "rad".
    """
    if not callable(function):
        raise ModelError(f"{m.name}: joint '{name}' needs a function of x, y and the angle, got {shown(function)}")
    if unit not in ("m", "rad"):
        raise ModelError(f"{m.name}: joint '{name}' has the unit {shown(unit)}; it must be 'm' or 'rad'")
    return join(m, CONSTRAINT, name, i, j, None, function=function, unit=unit)
