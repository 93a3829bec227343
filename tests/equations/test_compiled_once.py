"""A kernel is compiled once for its types: numbers that callers write out, and flags, make no copies of it."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd.compiling.jit import COMPILED, apart, internal, kernel, lazy, shared


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


@shared
def doubled(x):
    """Twice the first number."""
    return 2.0 * x[0]


@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
def test_calls_find_a_kernel_at_once_however_many_types_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    arrays = [np.full(2, 3.0), np.full((2, 2), 3.0)[:, 0], np.full(2, 3)]
    assert [doubled(x) for x in arrays] == [6.0] * 3
    asked: list[object] = []
    ask = type(doubled)._compile_for_args
    monkeypatch.setattr(type(doubled), "_compile_for_args", lambda *given: asked.append(given) or ask(*given))
    assert [doubled(x) for x in arrays] == [6.0] * 3
    assert not asked
