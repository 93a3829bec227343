"""Kernels with one name: a caller gets that of the class for which it is compiled, where it is copied in, too."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined, kernel


class Twice(NamedTuple):
    """Doubles."""

    factor: np.ndarray


class Squared(NamedTuple):
    """Squares."""

    exponent: np.ndarray


@inlined
def _twice(first, x):
    return first.factor[0] * x


@kernel
def _squared(first, x):
    return x ** first.exponent[0]


grow = alternatives({Twice: _twice, Squared: _squared})


@inlined
def grown(first, x):
    """Grows in a function that its caller copies."""
    return grow(first, x) if x > 0.0 else x


@kernel
def both(first, x):
    """Calls the kernel at first and at second hand."""
    return grow(first, x) + grown(first, x) + grown(first, -x)


TWICE, SQUARED = Twice(np.array([2.0])), Squared(np.array([2.0]))


def test_each_class_gets_its_own() -> None:
    assert both(TWICE, 3.0) == 6.0 + 6.0 - 3.0
    assert both(SQUARED, 3.0) == 9.0 + 9.0 - 3.0
    assert grow(TWICE, 5.0) == 10.0  # and where nothing is compiled


def test_a_class_without_a_kernel_is_named() -> None:
    class Other(NamedTuple):
        values: np.ndarray

    with pytest.raises(TypeError, match="no kernel for Other, only for Twice, Squared"):
        both(Other(np.zeros(1)), 1.0)
