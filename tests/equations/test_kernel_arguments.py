"""Arrays come to kernels whole, though few words are handed over, and numba's own functions take part as is said."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd.compiling.jit import COMPILED, apart, kernel, lazy

pytestmark = pytest.mark.skipif(not COMPILED, reason="without the compiler nothing is handed over")
ROOT = Path(__file__).parents[2]


@apart
def _weighed(x):
    """Return a sum of the numbers, the shape, the strides and the sizes of an array (a, b)."""
    total = 0.0
    for i in range(x.shape[0]):
        for j in range(x.shape[1]):
            total += (3 * i + 7 * j + 1) * x[i, j]
    return total + 1e3 * x.size + 1e5 * x.itemsize + x.strides[0] + 1e-3 * x.strides[1]


@lazy(float)
def _first(row):
    """The same of one row."""
    return row[0] + 10.0 * row[row.shape[0] - 1] + 1e3 * row.strides[0] + 1e6 * row.size


@kernel
def _both(x):
    total = _weighed(x)
    for k in range(x.shape[0]):
        total += _first(x[k])
    return total


@numba.njit
def _outside(x):
    return _both(x)


LAYOUTS = {
    "rows": lambda x: x,
    "columns": np.asfortranarray,
    "every other": lambda x: np.repeat(x, 2, axis=1)[:, ::2],
    "backwards": lambda x: x[::-1, ::-1],
    "part": lambda x: np.pad(x, 2)[2:-2, 2:-2],
}


@given(
    shape=st.tuples(st.integers(2, 4), st.integers(2, 5)),
    kind=st.sampled_from([np.float64, np.int64, np.uint32, np.bool_]),
    layout=st.sampled_from(sorted(LAYOUTS)),
)
def test_an_array_comes_with_its_shape_strides_and_sizes(shape: tuple[int, int], kind: type, layout: str) -> None:
    """Handed on to kernels that stand apart, and to those that are compiled later, from Python and from numba."""
    x = LAYOUTS[layout]((np.arange(shape[0] * shape[1]).reshape(shape) % 7).astype(kind))
    i, j = np.indices(x.shape)
    expected = float(((3 * i + 7 * j + 1) * x).sum()) + 1e3 * x.size + 1e5 * x.itemsize
    expected += x.strides[0] + 1e-3 * x.strides[1]
    for row in x:
        expected += float(row[0]) + 10.0 * float(row[-1]) + 1e3 * row.strides[0] + 1e6 * row.size
    assert _both(x) == pytest.approx(expected, rel=1e-12)
    assert _outside(x) == _both(x)


REFUSED = """
import numba, numpy as np
from mbsd.compiling.jit import kernel

@numba.njit
def theirs(x):
    return x[0] + x[1]

@numba.njit
def of_a_number(x):
    return 2.0 * x

@kernel
def good(x):
    return of_a_number(x[1])

@kernel
def bad(x):
    return theirs(x)

print(good(np.array([3.0, 4.0])))
bad(np.array([3.0, 4.0]))
"""


def test_a_kernel_that_hands_an_array_to_numbas_own_function_is_refused(tmp_path: Path) -> None:
    """A number it may hand over."""
    (tmp_path / "script.py").write_text(REFUSED)
    ran = subprocess.run(
        [sys.executable, tmp_path / "script.py"],
        env={"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": str(tmp_path / "kept")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.stdout == "8.0\n"
    assert "a kernel hands an array over to" in ran.stderr
    assert "theirs" in ran.stderr
    assert "compile it as a kernel" in ran.stderr
