"""The period of a mechanism: what its drivers, gears, belts and indexed wheels together need to be back."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable

import numpy as np
import pytest

from mbsd import Mechanism, ModelWarning, constant_rate, harmonic, polynomial, table
from tools.models import four_bars

SPEED = 2 * math.pi


def _shaft(m: Mechanism, name: str, x: float) -> None:
    m.revolute(f"pin {name}", m.ground.at(x, 0), m.body(name, mass=1.0, inertia=1e-3).origin)


def _gears(first: float, second: float) -> Mechanism:
    m = Mechanism("gears")
    _shaft(m, "first", 0.0)
    _shaft(m, "second", first + second)
    m.gear_pair("mesh", m.bodies["first"].origin, m.bodies["second"].origin, radius_i=first, radius_j=second)
    m.drive_angle("motor", m.bodies["first"], constant_rate(SPEED))
    return m


def _teeth(*teeth: int) -> Mechanism:
    """A train of gears on fixed pins."""
    m, x = Mechanism("train"), 0.0
    for k, count in enumerate(teeth):
        x += 0.001 * (count + teeth[k - 1]) if k else 0.0
        _shaft(m, f"g{k}", x)
        if k:
            i, j = m.bodies[f"g{k - 1}"].origin, m.bodies[f"g{k}"].origin
            m.gear_pair(f"mesh {k}", i, j, teeth=(teeth[k - 1], count), module=0.002)
    m.drive_angle("motor", m.bodies["g0"], constant_rate(SPEED))
    return m


def _geneva(slots: int) -> Mechanism:
    m = Mechanism("geneva")
    _shaft(m, "crank", 0.0)
    _shaft(m, "wheel", 0.1)
    crank, wheel = m.bodies["crank"], m.bodies["wheel"]
    m.geneva("index", crank.origin, wheel.origin, slots=slots, radius=0.1 * math.sin(math.pi / slots))
    m.drive_angle("motor", crank, constant_rate(SPEED))
    m.start_near(crank=180, wheel=180 / slots)
    return m


def _belt() -> Mechanism:
    m = Mechanism("belt")
    _shaft(m, "first", 0.0)
    _shaft(m, "second", 0.3)
    m.belt("belt", m.bodies["first"].origin, m.bodies["second"].origin, teeth=(20, 32), pitch=0.005)
    m.drive_angle("motor", m.bodies["first"], constant_rate(SPEED))
    return m


def _geared_five_bar() -> Mechanism:
    """Two cranks geared 3 : 1 and two rods: all is back after three turns of the fast one."""
    m = _gears(0.02, 0.06)
    a, b = m.bar("a", 0.1), m.bar("b", 0.1)
    m.revolute("P", m.bodies["first"].at(0.02, 0), a.start)
    m.revolute("Q", m.bodies["second"].at(0.03, 0), b.start)
    m.revolute("R", a.end, b.end)
    m.start_near(first=0, second=0, a=45, b=135)
    return m


def _planetary() -> Mechanism:
    """Arm driven, sun held: a planet of 20 teeth on a sun of 30 turns 1 + 30/20 = 5/2 times an arm's turn."""
    m = Mechanism("planetary")
    _shaft(m, "arm", 0.0)
    arm, planet = m.bodies["arm"], m.body("planet", mass=0.1, inertia=1e-4)
    m.revolute("pin planet", arm.at(0.05, 0), planet.origin)
    m.gear_pair("mesh", m.ground.origin, planet.origin, radius_i=0.03, radius_j=0.02)
    m.drive_angle("motor", arm, constant_rate(SPEED))
    return m


def _two_drivers(first: float, second: float) -> Mechanism:
    m = Mechanism("arms")
    upper, lower = m.bar("upper", 0.2), m.bar("lower", 0.1)
    m.revolute("A", m.ground.at(0, 0), upper.start)
    m.revolute("B", upper.end, lower.start)
    m.drive_angle("shoulder", upper, harmonic(0.5, first, 0.3))
    m.drive_angle("elbow", lower, harmonic(0.5, second, 1.1))
    return m


FOUND: dict[str, tuple[Callable[[], Mechanism], float]] = {
    "four-bar": (lambda: four_bars.model((0.12, 0.04, 0.12, 0.09), SPEED), 1.0),
    "equal gears": (lambda: _gears(0.03, 0.03), 1.0),
    "gears 2 : 1": (lambda: _gears(0.02, 0.04), 2.0),
    "gears 1 : 2": (lambda: _gears(0.04, 0.02), 1.0),
    "gears by teeth": (lambda: _teeth(17, 40), 40.0),
    "a train of gears": (lambda: _teeth(20, 30, 45), 9.0),
    "Geneva of 4": (lambda: _geneva(4), 4.0),
    "Geneva of 6": (lambda: _geneva(6), 6.0),
    "belt": (_belt, 8.0),
    "geared five-bar": (_geared_five_bar, 3.0),
    "planetary": (_planetary, 2.0),
    "drivers 2 : 3": (lambda: _two_drivers(2 * SPEED, 3 * SPEED), 1.0),
    "drivers 1 : 1.5": (lambda: _two_drivers(SPEED, 1.5 * SPEED), 2.0),
}


@pytest.mark.parametrize(("build", "seconds"), FOUND.values(), ids=FOUND)
def test_every_body_is_back_after_the_period_and_not_before(build: Callable[[], Mechanism], seconds: float) -> None:
    m = build()
    assert m.period() == pytest.approx(seconds, rel=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("error", ModelWarning)
        solution = build().sweep(steps=400)
    assert solution.period == pytest.approx(seconds, rel=1e-12)
    assert len(solution.t) == 401
    poses = [[getattr(solution.body(b), k) for k in ("x", "y", "theta")] for b in m.bodies if b != "ground"]
    x, y, theta = np.array(poses).transpose(1, 0, 2)
    apart = np.hypot(np.exp(1j * theta).real - np.cos(theta[:, :1]), np.sin(theta) - np.sin(theta[:, :1]))
    gap = np.max([np.abs(x - x[:, :1]), np.abs(y - y[:, :1]), apart], axis=0).max(axis=0)
    assert gap[-1] < 1e-9
    assert gap[4:-4].min() > 1e-5  # at no output in between are all bodies where they were


NONE: dict[str, tuple[Callable[[], Mechanism], str]] = {
    "gears of irrational ratio": (
        lambda: _gears(0.02, 0.02 * math.sqrt(2)),
        "its bodies are not back within 100 times",
    ),
    "gears of many teeth": (lambda: _teeth(100, 101), "its bodies are not back within 100 times 1 s"),
    "incommensurate drivers": (lambda: _two_drivers(1.0, math.sqrt(2)), "laws of its drivers have no common period"),
}


@pytest.mark.parametrize(("build", "words"), NONE.values(), ids=NONE)
def test_a_motion_that_does_not_repeat_is_told(build: Callable[[], Mechanism], words: str) -> None:
    assert build().period() is None
    with pytest.warns(ModelWarning, match=words):
        solution = build().sweep(steps=12)
    assert solution.period is None


def test_a_disc_that_rolls_away_does_not_come_back() -> None:
    m = Mechanism("wheel")
    disc = m.body("disc", mass=1.0, inertia=1e-3)
    m.rolling_disc("road", m.ground.origin, disc.origin, 0.1)
    m.drive_angle("motor", disc, constant_rate(-SPEED))
    m.start_near(disc=(0.0, 0.1, 0.0))
    assert m.period() is None
    with pytest.warns(ModelWarning, match=r"wheel: .* does not repeat, and 1 s of it are swept; say sweep\(duration="):
        assert m.sweep(steps=12).t[-1] == pytest.approx(1.0)


def test_a_slider_at_constant_speed_and_a_motion_of_once_have_no_period() -> None:
    for law in (constant_rate(0.1), polynomial(0.0, 0.0, 1.0)):
        m = Mechanism("slider")
        slider = m.body("slider", mass=1.0)
        m.prismatic("guide", m.ground.origin, slider.origin)
        m.drive_coordinate("push", m.ground.origin, slider.origin, law)
        assert m.period() is None


def test_a_driver_that_holds_repeats_with_the_others() -> None:
    m = Mechanism("arms")
    upper, lower = m.bar("upper", 0.2), m.bar("lower", 0.1)
    m.revolute("A", m.ground.at(0, 0), upper.start)
    m.revolute("B", upper.end, lower.start)
    m.drive_angle("shoulder", upper, table([0.0, 0.4, 0.8, 1.2, 1.6, 2.0], [0.0, 0.3, 0.1, -0.3, -0.2, 0.0], True))
    m.drive_angle("elbow", lower, constant_rate(0.0, 0.4))
    assert m.period() == pytest.approx(2.0)


def test_a_stated_duration_is_kept() -> None:
    solution = _gears(0.02, 0.04).sweep(duration=1.0, steps=10)
    assert solution.t[-1] == 1.0
    assert solution.period is None
