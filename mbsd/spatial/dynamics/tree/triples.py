"""Vectors as three numbers, which stay in registers, and parts of rows of arrays that hold them."""

from __future__ import annotations

from mbsd.compiling.jit import inlined


@inlined
def part_of(row, at):
    """Return row[at : at + 3]."""
    return row[at], row[at + 1], row[at + 2]


@inlined
def set_part(row, at, x, y, z):
    """Fill row[at : at + 3]."""
    row[at] = x
    row[at + 1] = y
    row[at + 2] = z


@inlined
def add_part(row, at, factor, a):
    """Add a vector, ``factor`` times, to row[at : at + 3]."""
    row[at] += factor * a[0]
    row[at + 1] += factor * a[1]
    row[at + 2] += factor * a[2]


@inlined
def times(row, at, a):
    """Return row[at : at + 3] . a."""
    return row[at] * a[0] + row[at + 1] * a[1] + row[at + 2] * a[2]


@inlined
def add(a, b):
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def plus(a, factor, b):
    """Return a + factor b."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@inlined
def scaled(a, factor):
    """Return factor a."""
    return a[0] * factor, a[1] * factor, a[2] * factor


@inlined
def cross(a, b):
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
