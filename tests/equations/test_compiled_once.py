"""A kernel is compiled once for its types: numbers that callers write out, and flags, make no copies of it."""

from __future__ import annotations

import pytest

from mbsd.compiling.jit import COMPILED, apart, internal, kernel, lazy


@internal
def added(x, count):
    """A number of times one."""
    return x + count


@apart
def scaled(x, count, back):
    """Times a number, or through it."""
    return x / count if back else x * added(0.0, count)


@lazy(float)
def later(x, count):
    """Less a number."""
    return x - count


@kernel
def several(x, count):
    """All of them, with numbers written out and not."""
    out = scaled(x, 2, False) + scaled(x, 4, True) + scaled(x, count, x > 1.0)
    return out + added(x, 3) + added(x, count) + later(x, 1) + later(x, count)


@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
def test_numbers_written_out_make_no_copies() -> None:
    assert several(8.0, 2) == 16.0 + 2.0 + 4.0 + 11.0 + 10.0 + 7.0 + 6.0
    assert len(scaled.signatures) == 1
    assert len(added.signatures) <= 1  # none where the callers are read from the cache
    assert len(later.kernel.signatures) == 1
