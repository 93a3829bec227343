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
def test_its_exceptions_are_reported_with_force_and_time(wrap) -> None:
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
    with pytest.raises(ModelError, match="force 'push': there is no body 'b'"):
        m.user_force("push", _late, "b")
    assert not m.forces


def _linear(length, rate):
    return -90.0 * (length - 0.6) - 2.0 * rate


@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["python", "njit"])
def test_a_spring_by_a_linear_law_is_the_spring(wrap) -> None:
    own = _pair(None)
    del own.forces["tie"]
    own.spring_law("tie", own.bodies["a"].origin, own.bodies["b"].origin, wrap(_linear))
    here, there = own.simulate(0.5, steps=20, tolerance=1e-10), _pair().simulate(0.5, steps=20, tolerance=1e-10)
    np.testing.assert_allclose(here.q, there.q, atol=1e-9)
    np.testing.assert_allclose(here.joint("pin").reaction, there.joint("pin").reaction, atol=1e-6)
    here_force, there_force = here.force("tie"), there.force("tie")
    for what in ("wrenches", "points", "length", "rate", "effort", "power"):
        np.testing.assert_allclose(getattr(here_force, what), getattr(there_force, what), atol=1e-7, err_msg=what)
    np.testing.assert_array_equal(here_force.potential, 0.0)  # what a law holds is counted as work
    assert here.work is not None
    assert here.audit is not None
    assert np.ptp(here.audit) < 1e-8


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha"])
@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["python", "njit"])
def test_a_hardening_torsion_spring_keeps_its_own_energy(wrap, method: str) -> None:
    """Duffing: I w^2 / 2 + k a^2 / 2 + h a^4 / 4 stays; nothing is lost without damping."""
    m = Mechanism("wheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=0.5)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.torsion_spring_law(
        "spring", m.ground, wheel, wrap(lambda angle, rate: -8.0 * angle - 30.0 * angle**3 + 0.0 * rate)
    )
    m.start_near(wheel=math.degrees(0.8))
    sol = m.simulate(1.0, steps=100, method=method, **({"step": 1e-3} if method == "generalized_alpha" else {}))
    angle, omega = sol.body("wheel").theta, sol.body("wheel").omega
    energy = 0.25 * omega**2 + 4.0 * angle**2 + 7.5 * angle**4
    np.testing.assert_allclose(energy, energy[0], rtol=1e-3 if method == "generalized_alpha" else 1e-5)
    np.testing.assert_allclose(sol.force("spring").torque, -8.0 * angle - 30.0 * angle**3, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(sol.force("spring").angle, angle)


def test_an_equilibrium_a_linearisation_and_a_sweep_know_a_law() -> None:
    """A block of 2 kg on 100 x + 400 x^3, pressed in by x from its free length of 0.5 m."""
    m = Mechanism("mount", gravity=(0.0, -10.0))
    block = m.body("block", 2.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0, math.pi / 2), block.at(0, 0, math.pi / 2))
    m.spring_law("spring", m.ground.origin, block.origin, lambda s, r: 100 * (0.5 - s) + 400 * (0.5 - s) ** 3 - 3 * r)
    m.start_near(block=(0, 0.4, 0))
    rest = m.equilibrium()
    [x] = [root.real for root in np.roots([400.0, 0.0, 100.0, -20.0]) if abs(root.imag) < 1e-12]
    assert float(rest.body("block").y) == pytest.approx(0.5 - x, abs=1e-9)
    assert rest.stability == "stable"
    [mode] = m.linearise(rest).modes
    stiffness = 100.0 + 1200.0 * x**2
    assert abs(mode.eigenvalue) == pytest.approx(math.sqrt(stiffness / 2.0), rel=1e-6)
    assert mode.eigenvalue.real == pytest.approx(-3.0 / 4.0, rel=1e-6)
    m.drive_coordinate(
        "hand", m.ground.at(0, 0, math.pi / 2), block.at(0, 0, math.pi / 2), harmonic(0.1, 4.0, mean=0.5)
    )
    sol = m.sweep(1.0, steps=20)
    y, speed = sol.body("block").y, sol.body("block").vy
    expected = 100 * (0.5 - y) + 400 * (0.5 - y) ** 3 - 3 * speed
    np.testing.assert_allclose(sol.driver("hand").force, 2.0 * (sol.body("block").ay + 10.0) - expected, atol=1e-9)
    m.draw()
    m.change("spring", law=lambda length, rate: 0.0 * length)
    np.testing.assert_allclose(m.sweep(1.0, steps=20).force("spring").effort, 0.0)


@pytest.mark.parametrize("wrap", [lambda f: f, numba.njit], ids=["python", "njit"])
def test_errors_of_a_law_are_reported_with_its_spring_and_time(wrap, tmp_path) -> None:
    def pair(law) -> Mechanism:
        m = Mechanism("pair", gravity=None)
        m.spring_law("tie", m.ground.at(-1.0, 0), m.body("a", 1.0, inertia=1.0).origin, law)
        return m

    def late(length, rate):
        if length > 1.1:
            raise ValueError("too long")
        return 1.0 + 0.0 * rate

    with pytest.raises(ModelError, match=r"pair: force 'tie': at t = .* with \[1\.1.*ValueError: too long"):
        pair(wrap(late)).simulate(2.0)
    with pytest.raises(ModelError, match=r"pair: force 'tie'.*2"):
        pair(wrap(lambda length, rate: (1.0, 2.0 * length))).simulate(1.0)
    with pytest.raises(ModelError, match=r"pair: force 'tie'.*nan"):
        pair(wrap(lambda length, rate: (length - length) / (rate - rate + 1e-300) + math.nan)).simulate(1.0)
    with pytest.raises(ModelError, match="pair: force 'tie': law is the Python function"):
        pair(wrap(late)).save(tmp_path / "pair.json")
    with pytest.raises(ModelError, match=r"force 'tie' needs a function of the length and its rate, got 3\.0"):
        pair(3.0)
