"""Where the unknowns of a block are expected: u = u_0 + sum B_j (z_j - z_0j) + c tau^2 / 2."""

from __future__ import annotations

from mbsd.kinematics.groups.carrying.columns import BASE, VALUE
from mbsd.kinematics.groups.newton.fused import fused


@fused
def expected(one, seen, coordinate, since):
    """An unknown by its value, convective acceleration and columns ``one`` (C + 2,) at coordinates ``seen`` (C,).

    ``since``: time since then (s).
    """
    value = one[0] + 0.5 * one[1] * since * since
    for j in range(coordinate.shape[0] - 1):
        value += one[2 + j] * (coordinate[j, VALUE] - seen[j])
    return value


@fused
def expected_since(one, coordinate):
    """The same from the last accepted pose on."""
    since = coordinate[coordinate.shape[0] - 1, VALUE]
    value = one[0] + 0.5 * one[1] * since * since
    for j in range(coordinate.shape[0] - 1):
        value += one[2 + j] * (coordinate[j, VALUE] - coordinate[j, BASE])
    return value
