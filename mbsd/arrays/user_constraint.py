"""Derivatives of a user's function F(x, y, a) of the relative pose, for the constraint `user`.

    gradient   F_k  = Im F(z + i h e_k) / h,  h = 1e-30                    where F takes complex numbers, exact
               else the central difference of sixth order
    second     F_kl = central difference of sixth order of the gradient

Sources: Squire, Trapp, SIAM Rev. 40 (1998) 110 (complex step); Fornberg, Math. Comp. 51 (1988) 699 (the weights).
The complex step is taken only where it agrees with differences at some poses, as abs() and comparisons spoil it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from numba.core.dispatcher import Dispatcher

from mbsd.base.arguments import LARGEST
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.base.running import Kept
from mbsd.compiling.callback import Callback, WrongValue

COMPLEX_STEP = 1e-30
STEP = 4e-3
"""Step of differences, in sizes of the mechanism and rad; the error is about 1e-15 times the seventh derivative."""
AGREEMENT = 1e-6
REALS = (int, float, np.floating, np.integer)
TRIALS = ((0.31, -0.42, 0.53), (-0.27, 0.66, -1.1), (0.81, 0.13, 2.2))


def derivatives(function: Callable, what: str, size: float) -> Callback:
    """Return a callback for F, its gradient and second derivatives (ten numbers) of the relative pose.

    In place of the time it gets a usual length, ``size`` (m). Raises ModelError if it is no function, or if numba
    cannot compile it.
    """
    if not callable(function):
        raise ModelError(f"{what}: {shown(function)} is no function; give one of x, y and the angle")
    if isinstance(function, Dispatcher):
        by_complex = _BY_COMPLEX.get((function, size), lambda: _takes_complex(function, size))
        ten = _COMPILED.get((function, by_complex), lambda: _ten(function, by_complex, numba.njit))
    else:
        checked = _of_numbers(function)
        ten = _ten(checked, _takes_complex(checked, size), _as_it_is)
    return Callback(ten, (1, 1, 1), 10, what, timed=False)


_BY_COMPLEX: Kept[bool] = Kept()
_COMPILED: Kept[Callable] = Kept()


def _of_numbers(function: Callable) -> Callable:
    """Return the function with a check for a real or complex number.

    Sums of True and None would hide a wrong result.
    """

    def checked(x: Any, y: Any, a: Any) -> Any:
        value = function(x, y, a)
        if isinstance(value, np.ndarray) and value.ndim == 0:
            value = value[()]
        real = isinstance(value, REALS) and not isinstance(value, bool) and -LARGEST <= value <= LARGEST
        if not real and not (isinstance(x, complex) and isinstance(value, complex)) and value == value:
            raise WrongValue(f"gives {shown(value)}; it must give a number")
        return value

    return checked


def _as_it_is(function: Callable) -> Callable:
    return function


def _takes_complex(function: Callable, size: float) -> bool:
    """Return True if complex steps work and agree with differences wherever the function can be evaluated."""
    agreed = 0
    for trial in TRIALS:
        try:
            at = trial[0] * size, trial[1] * size, trial[2]
            plain = _gradient_by_differences(function, _as_it_is)(size, *at)
            stepped = _gradient_by_complex(function, _as_it_is)(size, *at)
            both = np.array([plain, stepped], float)
        except Exception:
            continue
        if not np.isfinite(both[0]).all():
            continue
        if not np.abs(both[1] - both[0]).max() <= AGREEMENT * max(1.0, float(np.abs(both[0]).max())):
            return False
        agreed += 1
    return agreed > 0


def _gradient_by_complex(f: Any, compile_: Callable) -> Any:
    h = COMPLEX_STEP

    def gradient(size, x, y, a):
        return (
            f(complex(x, h), complex(y), complex(a)).imag / h,
            f(complex(x), complex(y, h), complex(a)).imag / h,
            f(complex(x), complex(y), complex(a, h)).imag / h,
        )

    return compile_(gradient)


def _gradient_by_differences(f: Any, compile_: Callable) -> Any:
    h = STEP

    def gradient(size, x, y, a):
        d = STEP * size
        return (
            (
                45.0 * (f(x + d, y, a) - f(x - d, y, a))
                - 9.0 * (f(x + 2.0 * d, y, a) - f(x - 2.0 * d, y, a))
                + (f(x + 3.0 * d, y, a) - f(x - 3.0 * d, y, a))
            )
            / (60.0 * d),
            (
                45.0 * (f(x, y + d, a) - f(x, y - d, a))
                - 9.0 * (f(x, y + 2.0 * d, a) - f(x, y - 2.0 * d, a))
                + (f(x, y + 3.0 * d, a) - f(x, y - 3.0 * d, a))
            )
            / (60.0 * d),
            (
                45.0 * (f(x, y, a + h) - f(x, y, a - h))
                - 9.0 * (f(x, y, a + 2.0 * h) - f(x, y, a - 2.0 * h))
                + (f(x, y, a + 3.0 * h) - f(x, y, a - 3.0 * h))
            )
            / (60.0 * h),
        )

    return compile_(gradient)


def _ten(function: Any, by_complex: bool, compile_: Callable) -> Callable:
    gradient = (_gradient_by_complex if by_complex else _gradient_by_differences)(function, compile_)
    weights = (0.75, -0.15, 1.0 / 60.0)

    def ten(size, x, y, a):
        here = gradient(size, x, y, a)
        second = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        for k in range(3):
            for axis in range(3):
                h = STEP if axis == 2 else STEP * size
                step = (k + 1) * h
                weight = weights[k] / h
                dx = step if axis == 0 else 0.0
                dy = step if axis == 1 else 0.0
                da = step if axis == 2 else 0.0
                after = gradient(size, x + dx, y + dy, a + da)
                before = gradient(size, x - dx, y - dy, a - da)
                for other in range(3):
                    second[3 * axis + other] += weight * (after[other] - before[other])
        return (
            function(x, y, a),
            here[0],
            here[1],
            here[2],
            second[0],
            0.5 * (second[1] + second[3]),
            0.5 * (second[2] + second[6]),
            second[4],
            0.5 * (second[5] + second[7]),
            second[8],
        )

    return compile_(ten)
