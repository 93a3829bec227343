"""Constraints that the user writes: the same motion as built-in joints, whatever the function is made of."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.arrays.user_constraint import derivatives
from mbsd.compiling.callback import Callback


def _rod(x, y, a):
    return x * x + y * y - 0.25


def _rod_without_complex(x, y, a):
    return abs(math.hypot(x, y)) - 0.5


def _crank(function=None) -> Mechanism:
    """Slider-crank whose rod of 0.5 m is a function, or a distance joint."""
    m = Mechanism("crank", gravity=None)
    crank, slider = m.bar("crank", 0.1, 1.0), m.body("slider", 2.0)
    m.revolute("O", m.ground.origin, crank.start)
    m.prismatic("guide", m.ground.origin, slider.origin)
    if function is None:
        m.distance("rod", crank.end, slider.origin, 0.5)
    else:
        m.constraint("rod", crank.end, slider.origin, function)
    m.drive_angle("motor", crank, constant_rate(2.0))
    m.start_near(crank=0, slider=(0.6, 0, 0))
    return m


@pytest.mark.parametrize(
    "function",
    [_rod, _rod_without_complex, numba.njit(_rod), numba.njit(_rod_without_complex)],
    ids=["complex", "differences", "njit complex", "njit differences"],
)
def test_a_rod_as_a_function_moves_like_a_rod(function) -> None:
    own, built_in = _crank(function).sweep(steps=90), _crank().sweep(steps=90)
    for field in ("x", "vx", "ax"):
        np.testing.assert_allclose(
            getattr(own.body("slider"), field), getattr(built_in.body("slider"), field), atol=2e-9
        )
    np.testing.assert_allclose(own.joint("rod").reaction, built_in.joint("rod").reaction, atol=2e-8)
    np.testing.assert_allclose(own.driver("motor").torque, built_in.driver("motor").torque, atol=2e-9)
    free = _crank(function)
    free.drivers.clear()
    free.start_moving(slider=(0.3, 0, 0))
    free.start_near(crank=40, slider=(0.57, 0, 0))
    assert np.ptp(free.simulate(duration=1.0, steps=50, tolerance=1e-10).energy.total) < 1e-8


def test_second_derivatives_are_exact_to_rounding() -> None:
    def f(x, y, a):
        return np.exp(0.3 * x) * np.sin(y + a) + x * y * a

    callback = derivatives(f, "test", 1.0)
    x, y, a = 0.4, -0.7, 1.3
    out = callback.function(1.0, x, y, a)
    e, s, c = math.exp(0.3 * x), math.sin(y + a), math.cos(y + a)
    expected = [e * s + x * y * a, 0.3 * e * s + y * a, e * c + x * a, e * c + x * y]
    expected += [0.09 * e * s, 0.3 * e * c + a, 0.3 * e * c + y, -e * s, -e * s + x, -e * s]
    np.testing.assert_allclose(out, expected, atol=1e-12)


def test_errors_in_the_function_are_told() -> None:
    def broken(x, y, a):
        if x < 0.55:
            raise ZeroDivisionError("no such place")
        return _rod(x, y, a)

    with pytest.raises(ModelError, match=r"crank: joint 'rod': at .* fails: ZeroDivisionError: no such place"):
        _crank(lambda x, y, a: broken(float(np.real(x)), y, a)).sweep(steps=90)
    with pytest.raises(ModelError, match="crank: joint 'rod' needs a function"):
        _crank(3.0)
    m = _crank()
    with pytest.raises(ModelError, match="unit 'mm'"):
        m.constraint("other", m.ground.origin, m.bodies["slider"].origin, _rod, unit="mm")


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")  # pyright: ignore[reportAttributeAccessIssue, reportPrivateImportUsage]
def test_a_compiled_function_is_compiled_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """For all mechanisms and sizes, the next simulations among them; so are forces and laws of springs."""
    made: list[object] = []
    compile_ = Callback._compile
    monkeypatch.setattr(Callback, "_compile", lambda self: (made.append(self.function), compile_(self))[1])
    circle = numba.njit(lambda x, y, a: x * x + y * y - 1.0)
    push = numba.njit(lambda t, q, v: (-v[0], 0.0, 0.0))
    law = numba.njit(lambda length, rate: -3.0 * (length - 0.5))
    ends = []
    for arm in (0.1, 0.1, 0.2):
        m = Mechanism("wheel")
        rim = m.body("rim", 1.0, inertia=0.1)
        m.constraint("circle", m.ground.origin, rim.at(arm, 0), circle)
        m.user_force("drag", push, rim)
        m.spring_law("spring", m.ground.at(0.2, 0), rim.origin, law)
        m.start_near(rim=(1 - arm, 0, 0))
        ends.append(m.simulate(0.3, steps=3).body("rim").y[-1])
    assert len(made) == 3
    assert ends[0] == ends[1] != ends[2]
