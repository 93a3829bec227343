"""Bushing: stiffness and damping of six directions between two frames.

s = K x + C x'        x: place of j in the axes of i (m) and rotation vector from i to j (rad), below half a turn
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError
from mbsd.spatial.model.body import Direction, Fixing, Place
from mbsd.spatial.model.entries import add_force, axes_given, force_markers
from mbsd.spatial.model.force import Call, Force, ForceKind, no_rows, register_force
from mbsd.spatial.model.mechanism import Model

BUSHING = register_force(
    ForceKind(
        "bushing",
        no_rows,
        call=lambda f: Call("bushing", (f.i, f.j), [*np.ravel(f.params["stiffness"]), *np.ravel(f.params["damping"])]),
        example=lambda m, i, j: m.bushing(
            "example", i, j, at=(0.1, 0.2, 0.3), axis=(1, 2, -1), stiffness=(30, 40, 50, 3, 4, 5), damping=[0.1] * 6
        ),
    )
)


@BUSHING.adds
def bushing(
    m: Model, name: str, first: Fixing, second: Fixing, stiffness: Sequence[float] | np.ndarray,
    damping: Sequence[float] | np.ndarray = (0.0,) * 6, at: Place | None = None, axis: Direction | None = None,
    across: Direction | None = None,
) -> Force:  # fmt: skip
    """A rubber bush at ``at`` (m) with z along ``axis``, at rest in the design pose; or between two markers.

    ``stiffness`` and ``damping`` are six numbers, along x, y, z (N/m, N s/m) and about them (N m/rad, N m s/rad), or
    symmetric matrices (6, 6). The second body may turn against the first by less than half a turn.
    """
    what = f"{m.name}: force '{name}'"
    params = {"stiffness": _matrix(f"{what}: stiffness", stiffness), "damping": _matrix(f"{what}: damping", damping)}
    i, j = force_markers(m, what, first, second, at, axes_given(what, axis, across))
    return add_force(m, BUSHING, name, i, j, params)


def _matrix(what: str, given: object) -> list[list[float]]:
    """Return a matrix (6, 6) of six numbers or itself. Raises ModelError, also where it would feed energy in."""
    values = number_array(what, given)
    matrix = np.diag(values) if values.shape == (6,) else values
    if matrix.shape != (6, 6) or not np.allclose(matrix, matrix.T, rtol=1e-9, atol=0.0):
        raise ModelError(f"{what} has shape {values.shape}; give six numbers or a symmetric matrix (6, 6)")
    least = float(np.linalg.eigvalsh(matrix)[0])
    if least < -1e-9 * float(np.abs(matrix).max()):
        raise ModelError(f"{what} has the eigenvalue {least:.6g}; none can be negative")
    return matrix.tolist()
