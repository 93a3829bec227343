"""Gears with backlash: beside independent equations, rest under torque both ways, centres that part, a tight mesh."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbsd import Mechanism, ModelError, constant_rate, harmonic

R_I, R_J = 0.06, 0.03
ALPHA = math.radians(20.0)
BACKLASH, STIFFNESS = 0.1e-3, 1e8
I_I, I_J = 2e-3, 1e-3


def pair(internal: bool = False, distance: float | None = None, **mesh: Any) -> Mechanism:
    """Gear or ring a and gear b, on pins of ground along a slanting line."""
    m = Mechanism("gears", gravity=None)
    a, b = m.body("a", mass=1.0, inertia=I_I), m.body("b", mass=1.0, inertia=I_J)
    first = 3 * R_J if internal else R_I
    away = (first - R_J if internal else first + R_J) if distance is None else distance
    m.revolute("A", m.ground.at(0, 0), a.origin)
    m.revolute("B", m.ground.at(away * math.cos(0.5), away * math.sin(0.5)), b.origin)
    sizes = {} if "teeth" in mesh else {"radius_i": first, "radius_j": R_J}
    given = {"stiffness": STIFFNESS, "backlash": BACKLASH, "internal": internal} | sizes | mesh
    m.gear_mesh("mesh", a.origin, b.origin, **given)
    m.start_near(a=20, b=33)
    return m


def reference(times: np.ndarray, torque_i: Callable, torque_j: Callable, v_0: tuple[float, float], loss: float):
    """(T, 4) turned angles and rates of an external pair by scipy, in pieces from contact to contact of a flank."""
    b_i, b_j, half = R_I * math.cos(ALPHA), R_J * math.cos(ALPHA), 0.5 * BACKLASH * math.cos(ALPHA)

    def depth(y, flank: float) -> float:
        return flank * (b_i * y[0] + b_j * y[1]) - half

    def rates(t: float, y: np.ndarray, flank: float, approach: float) -> list[float]:
        push = 0.0
        if flank:
            p, rate = depth(y, flank), flank * (b_i * y[2] + b_j * y[3])
            push = STIFFNESS * p * max(1.0 + loss * rate / approach, 0.0)
        return [y[2], y[3], (torque_i(t) - flank * push * b_i) / I_I, (torque_j(t) - flank * push * b_j) / I_J]

    def event(flank: float, direction: float):
        def meets(t: float, y: np.ndarray, *_given: float) -> float:
            return depth(y, flank)

        meets.terminal, meets.direction = True, direction  # pyright: ignore[reportFunctionMemberAccess]
        return meets

    t, y, flank, approach, out = 0.0, np.array([0.0, 0.0, *v_0]), 0.0, 1.0, np.zeros((len(times), 4))
    while t < times[-1]:
        events = [event(flank, -1.0)] if flank else [event(1.0, 1.0), event(-1.0, 1.0)]
        part = solve_ivp(
            rates, (t, times[-1]), y, "DOP853", dense_output=True, events=events, rtol=1e-12, atol=1e-14,
            args=(flank, approach), first_step=1e-8,
        )  # fmt: skip
        reached = float(part.t[-1])
        inside = (times >= t) & (times <= reached)
        out[inside] = part.sol(times[inside]).T
        t, y = reached, part.y[:, -1]
        if t < times[-1]:
            flank = 0.0 if flank else (1.0 if len(part.t_events[0]) else -1.0)
            approach = max(flank * (b_i * y[2] + b_j * y[3]), 1e-3)
    return out


@pytest.mark.parametrize("restitution", [None, 0.7])
def test_rattling_gears_beside_equations_of_their_own(restitution: float | None) -> None:
    """A motor torque that swings, a constant load: both flanks are hit several times."""
    loss = 0.0 if restitution is None else 1.6 * (1.0 - restitution) / restitution
    m = pair(start=None, restitution=restitution)
    m.torque("motor", m.bodies["a"], harmonic(6.0, 400.0))
    m.torque("load", m.bodies["b"], 0.4)
    m.start_moving(a=1.0, b=0.5)
    sol = m.simulate(0.03, steps=600, tolerance=1e-12)
    expected = reference(sol.t, lambda t: 6.0 * math.sin(400.0 * t), lambda t: 0.4, (1.0, 0.5), loss)
    pushed = sol.force("mesh").fx
    assert (pushed > 1.0).any()
    assert (pushed < -1.0).any()
    for name, column in (("a", 0), ("b", 1)):
        turned = sol.body(name).theta - sol.body(name).theta[0]
        assert np.abs(turned - expected[:, column]).max() < 1e-8
        assert np.abs(sol.body(name).omega - expected[:, 2 + column]).max() < 1e-4


def at_rest(m: Mechanism, torque: float) -> tuple[float, Any]:
    """How far gear b turns (rad) under a torque (N m) with gear a held, and the equilibrium."""
    m.drive_angle("hold", m.bodies["a"], lambda t: math.radians(20.0) + 0.0 * t)
    m.torque("load", m.bodies["b"], torque)
    rest = m.equilibrium()
    return float(rest.body("b").theta) - math.radians(33.0), rest


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("torque", [3.0, -3.0])
def test_torque_at_rest_goes_through_one_flank(internal: bool, torque: float) -> None:
    turned, rest = at_rest(pair(internal), torque)
    base = R_J * math.cos(ALPHA)
    push = abs(torque) / base
    play, yielded = 0.5 * BACKLASH / R_J, push / STIFFNESS / base
    assert turned == pytest.approx(math.copysign(play + yielded, torque), rel=1e-6)
    mesh = rest.force("mesh")
    assert math.hypot(mesh.fx, mesh.fy) == pytest.approx(push, rel=1e-6)
    assert rest.stability == "stable"
    line = np.array([math.cos(0.5), math.sin(0.5)])
    apart = float(np.array([mesh.fx, mesh.fy]) @ line)
    assert apart == pytest.approx((-1.0 if internal else 1.0) * push * math.sin(ALPHA), rel=1e-6)
    held = rest.driver("hold").effort
    ratio = 3.0 if internal else -R_I / R_J
    assert held == pytest.approx(-ratio * torque, rel=1e-6)
    assert abs(mesh.torque) < 1e-9 * push, "it acts at the pitch point"


@pytest.mark.parametrize("more", [0.0, 0.4e-3, -0.05e-3])
def test_centres_that_part_widen_the_play_as_textbooks_say(more: float) -> None:
    """Thicknesses of teeth on the operating pitch circles: s' = r' (s / r + 2 (inv alpha - inv alpha'))."""
    teeth, module = (40, 20), 3e-3
    distance = R_I + R_J + more
    play = [at_rest(pair(distance=distance, teeth=teeth, module=module), torque)[0] for torque in (1e-3, -1e-3)]
    operating = math.acos((R_I + R_J) * math.cos(ALPHA) / distance)
    involutes = math.tan(ALPHA) - ALPHA - math.tan(operating) + operating
    stretched = distance / (R_I + R_J)
    thick = [stretched * r * ((0.5 * math.pi * module - 0.5 * BACKLASH) / r + 2.0 * involutes) for r in (R_I, R_J)]
    backlash = stretched * math.pi * module - sum(thick)
    yielded = 2.0 * 1e-3 / STIFFNESS / (R_J * math.cos(ALPHA)) ** 2
    assert play[0] - play[1] == pytest.approx(backlash / (stretched * R_J) + yielded, rel=1e-4)


def test_a_mesh_without_room_presses_on_both_flanks() -> None:
    turned, rest = at_rest(pair(distance=R_I + R_J - 0.3e-3), 0.5)
    operating = math.acos((R_I + R_J) * math.cos(ALPHA) / (R_I + R_J - 0.3e-3))
    both = (R_I + R_J) * math.cos(ALPHA)
    tight = -both * (math.tan(operating) - operating - math.tan(ALPHA) + ALPHA) - 0.5 * BACKLASH * math.cos(ALPHA)
    assert tight > 0.0
    base = R_J * math.cos(ALPHA)
    assert turned == pytest.approx(0.5 / (2.0 * STIFFNESS * base**2), rel=1e-4)
    apart = rest.force("mesh").fx * math.cos(0.5) + rest.force("mesh").fy * math.sin(0.5)
    assert apart == pytest.approx(2.0 * STIFFNESS * tight * math.sin(operating), rel=1e-3)


def test_they_start_as_gears_without_play_or_as_they_are_said_to() -> None:
    m = pair()
    m.start_moving(a=10.0)
    assert m.simulate(1e-4).body("b").omega[0] == pytest.approx(-20.0, abs=1e-9)
    loose = pair(start=None)
    loose.start_moving(a=10.0)
    assert loose.simulate(1e-4).body("b").omega[0] == pytest.approx(0.0, abs=1e-9)
    near = pair(start=0.4 * BACKLASH)
    near.start_moving(a=0.0)
    near.torque("load", near.bodies["b"], 1.0)
    way = near.simulate(0.01, steps=4000)
    first = float(way.t[np.argmax(way.force("mesh").magnitude > 0.0)])
    assert first == pytest.approx(math.sqrt(2.0 * 0.1 * BACKLASH / R_J * I_J), abs=5e-6)


def test_a_mechanism_goes_on_from_its_rest_with_the_same_flank_pressed() -> None:
    m = pair()
    m.torsion_spring("spring", m.ground, m.bodies["a"], 50.0, free_angle=math.radians(20.0))
    m.torque("load", m.bodies["b"], 3.0)
    m.equilibrium().start(m)
    sol = m.simulate(0.02)
    assert np.ptp(sol.body("b").theta) < 1e-8
    assert sol.force("mesh").magnitude.min() > 100.0
    frequencies = sorted(mode.frequency for mode in m.modes() if mode.frequency)
    b_i, b_j = R_I * math.cos(ALPHA), R_J * math.cos(ALPHA)
    stiff = STIFFNESS * np.outer([b_i, b_j], [b_i, b_j]) + np.diag([50.0, 0.0])
    squares = np.linalg.eigvals(np.diag([1.0 / I_I, 1.0 / I_J]) @ stiff)
    expected = np.sort(np.sqrt(squares.real)) / (2.0 * math.pi)
    assert frequencies == pytest.approx(expected.tolist(), rel=1e-3)


def test_many_turns_of_driven_gears_and_both_driven() -> None:
    m = pair(restitution=0.5)
    m.drive_angle("motor", m.bodies["a"], constant_rate(50.0))
    m.torque("brake", m.bodies["b"], 0.1)
    sol = m.simulate(2.0)
    base = R_J * math.cos(ALPHA)
    lag = 0.5 * BACKLASH / R_J + 0.1 / base / STIFFNESS / base
    assert sol.body("b").theta[-1] - sol.body("b").theta[0] == pytest.approx(-200.0 + lag, abs=1e-6)
    both = pair()
    both.drive_angle("a", both.bodies["a"], constant_rate(5.0))
    both.drive_angle("b", both.bodies["b"], constant_rate(-9.9))
    swept = both.sweep(0.1)
    rolled = (R_I * 5.0 - R_J * 9.9) * math.cos(ALPHA) * swept.t
    push = STIFFNESS * np.maximum(rolled - 0.5 * BACKLASH * math.cos(ALPHA), 0.0)
    assert push.max() > 0.0
    np.testing.assert_allclose(swept.force("mesh").magnitude, push, atol=1e-6 * push.max())
    np.testing.assert_allclose(swept.driver("b").torque, push * base, atol=1e-6 * push.max())


def test_check_finds_gears_that_do_not_reach_each_other() -> None:
    assert not pair().check()
    assert not pair(internal=True).check()
    assert not pair(distance=0.0905, teeth=(40, 20), module=3e-3).check()
    [finding] = pair(teeth=(40, 20), module=3.0).check()
    assert "its centres are 0.09 m apart at the start, and radii of 60 m and 30 m say 90 m" in str(finding)
    [finding] = pair(distance=0.15).check()
    assert "so no teeth mesh" in str(finding)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stiffness": 0.0}, "stiffness is 0; it must be positive"),
        ({"backlash": -1e-4}, "backlash"),
        ({"backlash": 0.05}, "below the smaller radius"),
        ({"teeth": (40, 20), "module": 3e-3, "backlash": 5e-3}, "below the thickness of a tooth"),
        ({"pressure_angle": 20.0}, "it must be above 0 and below pi/4"),
        ({"pressure_angle": 0.0}, "it must be above 0 and below pi/4"),
        ({"start": 0.1e-3}, "beyond half of the backlash"),
        ({"start": 0.01e-3, "phase": (0.0, 0.0)}, "has start= and phase="),
        ({"radius_j": 0.1, "internal": True}, "the first gear is the ring"),
        ({"restitution": 0.0}, "infinite"),
        ({"exponent": 0.0}, "exponent is 0; it must be 1 or more"),
    ],
)
def test_bad_numbers_are_refused_by_name(given: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        pair(**given)
