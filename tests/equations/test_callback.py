"""Functions of the user that kernels call: Python and compiled ones give the same, and nothing they raise is lost."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from mbsd import ModelError
from mbsd.compiling.callback import Callback, call
from mbsd.compiling.jit import kernel


@kernel
def _call_twice(address, t, x, out):
    call(address, t, x, out)
    first = out[0]
    call(address, t + 1.0, x, out)
    return first


def _python(t, place, speed):
    return t * place[0] + place[1] * speed, math.sin(place[2])


_compiled = numba.njit(_python)


@numba.cfunc("void(float64, CPointer(float64), CPointer(float64))")
def _as_c(t, x, out):
    out[0] = t * x[0] + x[1] * x[3]
    out[1] = math.sin(x[2])


@pytest.mark.parametrize("function", [_python, _compiled, _as_c], ids=["python", "njit", "cfunc"])
def test_all_kinds_of_functions_give_the_same(function) -> None:
    callback = Callback(function, (3, 1), 2, "swing: force 'wind'")
    x, out = np.array([2.0, 3.0, 0.4, 5.0]), np.zeros(2)
    first = _call_twice(callback.address, 0.5, x, out)
    assert first == 0.5 * 2.0 + 15.0
    np.testing.assert_array_equal(out, [1.5 * 2.0 + 15.0, math.sin(0.4)])
    callback.check()


def _raises(t, x):
    if t > 1.0:
        raise ValueError("too late")
    return x[0]


def _gives_nan(t, x):
    return math.nan if t > 1.0 else x[0]


@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["python", "njit"])
@pytest.mark.parametrize(
    ("function", "says"), [(_raises, "fails: ValueError: too late"), (_gives_nan, r"gives \[nan\]")]
)
def test_failures_come_out_with_name_time_and_inputs(wrap, function, says: str) -> None:
    callback = Callback(wrap(function), (2,), 1, "swing: force 'wind'")
    x, out = np.array([2.0, 3.0]), np.zeros(1)
    assert _call_twice(callback.address, 0.5, x, out) == 2.0
    assert math.isnan(out[0])
    with pytest.raises(
        ModelError, match=rf"swing: force 'wind': at t = 1.5 s with \[2. 3.\] the user's function {says}"
    ):
        callback.check()
    callback.check()  # told once


def test_an_interrupt_is_passed_on_as_it_is() -> None:
    def stop(t, x):
        raise KeyboardInterrupt

    callback = Callback(stop, (2,), 1, "swing")
    _call_twice(callback.address, 0.0, np.zeros(2), np.zeros(1))
    with pytest.raises(KeyboardInterrupt):
        callback.check()


def test_the_inputs_belong_to_the_user() -> None:
    kept = []

    def keep(t, x):
        kept.append(x)
        x[0] = 99.0
        return 0.0

    callback = Callback(keep, (2,), 1, "swing")
    x = np.array([1.0, 2.0])
    _call_twice(callback.address, 0.0, x, np.zeros(1))
    assert x[0] == 1.0
    assert kept[0] is not kept[1]


@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["python", "njit"])
def test_a_wrong_count_of_numbers_is_told(wrap) -> None:
    callback = Callback(wrap(lambda t, x: (1.0, 2.0, 3.0)), (2,), 2, "swing")
    _call_twice(callback.address, 0.0, np.zeros(2), np.zeros(2))
    with pytest.raises(ModelError, match=r"swing.*gives 3 numbers; 2 are wanted"):
        callback.check()


def test_a_function_that_numba_cannot_compile_is_told() -> None:
    if numba.config.DISABLE_JIT:  # pyright: ignore[reportAttributeAccessIssue, reportPrivateImportUsage]
        return  # it is plain Python then, and runs
    with pytest.raises(ModelError, match="swing: numba cannot compile the function"):
        Callback(numba.njit(lambda t, x: x.missing), (2,), 1, "swing")


def test_objects_that_are_no_function_are_refused() -> None:
    with pytest.raises(ModelError, match="swing: 3 is no function"):
        Callback(3, (2,), 1, "swing")  # pyright: ignore[reportArgumentType]
