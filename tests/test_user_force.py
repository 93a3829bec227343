"""Forces that the user writes: closed forms, the same motion as built-in forces, and failures told by name."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, harmonic


def _spring(t, q, v):
    """Between the frames' origins of two bodies, 90 N/m, 2 N s/m, free length 0.6 m."""
    dx, dy = q[3] - q[0], q[4] - q[1]
    length = math.sqrt(dx * dx + dy * dy)
    ux, uy = dx / length, dy / length
    force = -90.0 * (length - 0.6) - 2.0 * (ux * (v[3] - v[0]) + uy * (v[4] - v[1]))
    return -force * ux, -force * uy, 0.0, force * ux, force * uy, 0.0


def _pair(function=None) -> Mechanism:
    """Two bodies with centres of mass off their frames, tied by a spring as a function or a built-in one."""
    m = Mechanism("pair")
    a, b = m.body("a", 1.0, (0.2, -0.1), 0.3), m.body("b", 2.0, (-0.1, 0.3), 0.4)
    m.revolute("pin", m.ground.at(0, 0), a.at(0.0, 0.5))
    if function is None:
        m.spring("tie", a.origin, b.origin, 90.0, damping=2.0, free_length=0.6)
    else:
        m.user_force("tie", function, a, b)
    m.start_near(a=(0.0, -0.5, 0.0), b=(0.5, -1.0, 30))
    m.start_moving(b=(0.3, 0.0, 1.0))
    return m


def _in_rows(t, q, v):
    return np.array(_spring(t, q, v)).reshape(2, 3)


@pytest.mark.parametrize("function", [_spring, _in_rows, numba.njit(_spring)], ids=["python", "rows", "njit"])
def test_a_spring_as_a_function_moves_like_a_spring(function) -> None:
    own, built_in = _pair(function).simulate(0.5, steps=20), _pair().simulate(0.5, steps=20)
    np.testing.assert_allclose(own.q, built_in.q, atol=1e-10)
    np.testing.assert_allclose(own.joint("pin").reaction, built_in.joint("pin").reaction, atol=1e-7)
    assert own.work is not None
    np.testing.assert_allclose(own.work, built_in.work, atol=1e-9)


def test_a_function_of_time_and_speed_has_its_closed_form() -> None:
    m = Mechanism("cart", gravity=None)
    cart = m.body("cart", 2.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.user_force("pull", lambda t, q, v: (4.0 * math.exp(-t) - 2.0 * v[0], 0.0, 0.0), cart)
    sol = m.simulate(2.0, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("cart").vx, 2.0 * sol.t * np.exp(-sol.t), atol=1e-9)


def test_a_sweep_feels_it() -> None:
    m = Mechanism("door", gravity=None)
    door = m.bar("door", 1.0, mass=1.0)
    m.revolute("hinge", m.ground.at(0, 0), door.start)
    m.user_force("closer", lambda t, q, v: (0.0, 0.0, -5.0 * q[2]), door)
    m.drive_angle("hand", door, harmonic(1.0, 1e-3))
    sol = m.sweep(1000.0, steps=20)
    np.testing.assert_allclose(sol.driver("hand").torque, 5.0 * sol.body("door").theta, atol=1e-5)


def _late(t, q, v):
    if t > 0.1:
        raise ValueError("too late")
    return 0.0, 0.0, 1.0


@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["python", "njit"])
def test_what_it_raises_is_told_with_force_and_time(wrap) -> None:
    m = Mechanism("pair")
    m.user_force("push", wrap(_late), m.body("a", 1.0, inertia=1.0))
    with pytest.raises(ModelError, match=r"pair: force 'push': at t = 0\.1.*ValueError: too late"):
        m.simulate(1.0)


def test_a_wrong_count_of_numbers_is_told() -> None:
    m = Mechanism("pair")
    m.user_force("push", lambda t, q, v: (1.0, 2.0), m.body("a", 1.0, inertia=1.0))
    with pytest.raises(ModelError, match=r"force 'push'.*2 numbers; 3 are wanted"):
        m.simulate(1.0)


def test_wrong_ones_are_refused_when_built() -> None:
    m = Mechanism("refused")
    a = m.body("a", 1.0, inertia=1.0)
    for bad, words in [((3.0, a), "needs a function"), ((_late,), "needs the bodies"), ((_late, a, a), "each once")]:
        with pytest.raises(ModelError, match=words):
            m.user_force("push", *bad)
    with pytest.raises(ModelError, match="needs a body"):
        m.user_force("push", _late, "a")  # pyright: ignore[reportArgumentType]
    assert not m.forces
