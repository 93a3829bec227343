"""Where the unknowns of a block are expected: u = u_0 + sum B_j (z_j - z_0j) + c tau^2 / 2."""

from __future__ import annotations

from mbsd.kinematics.groups.carrying.columns import BASE, VALUE
from mbsd.kinematics.groups.newton.fused import fused


@fused
def expected(numbers, seen, coordinate, since):
    """An unknown by its value, convective acceleration and columns ``numbers`` (C + 2,) at coordinates ``seen`` (C,).

    ``since``: time since then (s).
    """
    value = numbers[0] + 0.5 * numbers[1] * since * since
    for j in range(coordinate.shape[0] - 1):
        value += numbers[2 + j] * (coordinate[j, VALUE] - seen[j])
    return value


@fused
def expected_since(numbers, coordinate):
    """The same from the last accepted pose on."""
    since = coordinate[coordinate.shape[0] - 1, VALUE]
    value = numbers[0] + 0.5 * numbers[1] * since * since
    for j in range(coordinate.shape[0] - 1):
        value += numbers[2 + j] * (coordinate[j, VALUE] - coordinate[j, BASE])
    return value
