"""Named tuples come to kernels by the address of their fields, from Python, from kernels and from numba's functions."""

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from mbsd.compiling.jit import COMPILED, apart, inlined, internal, kernel, lazy, shared

pytestmark = pytest.mark.skipif(not COMPILED, reason="without the compiler nothing is handed over")


class Inner(NamedTuple):
    """Arrays of several layouts."""

    rows: Any
    """(a, b)"""
    columns: Any
    """(a, b), not contiguous"""
    places: Any
    """(a,) int"""


class Outer(NamedTuple):
    """A named tuple in a named tuple, and numbers."""

    inner: Inner
    factor: float
    number: int
    is_negative: bool


class Pair(NamedTuple):
    """Fields of one type."""

    first: Any
    second: Any


@internal
def _sum(inner):
    total = 0.0
    for i in range(inner.rows.shape[0]):
        for j in range(inner.rows.shape[1]):
            total += inner.rows[i, j] + 10.0 * inner.columns[i, j] * inner.places[i]
    return total + 1e3 * inner.columns.strides[0]


@apart
def _signed(outer):
    total = outer.factor * _sum(outer.inner) + outer.number
    return -total if outer.is_negative else total


@lazy(float)
def _later(outer, pair):
    return _signed(outer) + pair.first[0] + 2.0 * pair.second[0]


@inlined
def _doubled(outer):
    return Outer(outer.inner, 2.0 * outer.factor, outer.number, not outer.is_negative)


@shared
def add(outer, pair):
    """Fill pair.first; returns what all fields give."""
    own = outer
    total = 0.0
    for k in range(3):
        if k == 1:
            own = _doubled(outer)
        total += _later(own, pair)
    pair.first[0] += 1.0
    return total


@kernel
def add_swapped(outer, pair):
    """``add`` as kernels call it, with a named tuple that was made here."""
    return add(outer, Pair(pair.second, pair.first))


@numba.njit
def outside(outer, pair):
    """The same as numba's own functions call it."""
    return add(outer, Pair(pair.second, pair.first))


def example() -> tuple[Outer, Pair]:
    rows = np.arange(6.0).reshape(2, 3)
    inner = Inner(rows, np.arange(12.0).reshape(2, 6)[:, ::2], np.array([2, 3]))
    return Outer(inner, 0.5, 7, False), Pair(np.array([3.0]), np.array([4.0]))


def expected(first: float, second: float) -> float:
    inner = example()[0].inner
    whole = float((inner.rows + 10.0 * inner.columns * inner.places[:, None]).sum()) + 1e3 * inner.columns.strides[0]
    return (0.5 * whole + 7) - 2 * (whole + 7) + 3 * (first + 2.0 * second)


def test_fields_come_as_they_are_from_python_from_kernels_and_from_numba() -> None:
    """Numbers are exact: all of them are whole or halves."""
    outer, pair = example()
    assert add(outer, pair) == expected(3.0, 4.0)
    assert pair.first[0] == 4.0
    assert add_swapped(outer, pair) == expected(4.0, 4.0)
    assert pair.second[0] == 5.0
    assert outside(outer, pair) == expected(5.0, 4.0)


def test_a_kernel_that_returns_one_is_refused() -> None:
    """The frame in which its fields stand is gone by then."""

    @kernel
    def returned(pair):
        return Pair(pair.second, pair.first)

    with pytest.raises(Exception, match="a kernel returns a Pair"):
        returned(example()[1])


def test_the_python_face_of_a_shared_kernel_compiles_at_its_first_call() -> None:
    """Kernels call what has no wrapper for Python; the second call finds the first one's code."""

    @shared
    def halved(x):
        return 0.5 * x

    halved.compile((numba.float64,))
    assert halved(3.0) == 1.5
    assert halved(5.0) == 2.5
    assert len(halved.overloads) == 1
