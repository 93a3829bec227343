"""Laws whose given derivatives are not those of their values are refused by every analysis alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, Motion, constant_rate, function
from mbsd.kinematics import steps
from tools.models import linkages

WRONG = {
    "sign of f''": function(math.sin, math.cos, math.sin),
    "f' by 1 %": function(math.sin, lambda t: 1.01 * math.cos(t), lambda t: -1.01 * math.sin(t)),
    "f'' by 1 %": function(math.sin, math.cos, lambda t: -1.01 * math.sin(t)),
    "f'' by 0.01 %": function(math.sin, math.cos, lambda t: -1.0001 * math.sin(t)),
    "f' by 2": function(math.sin, lambda t: 2 * math.cos(t), lambda t: -2 * math.sin(t)),
    "numba": function(numba.njit(lambda t: math.sin(t)), numba.njit(lambda t: math.sin(t)), numba.njit(lambda t: 0.0)),
}


@dataclass(frozen=True, eq=False)
class Doubled(Motion):
    """A law of the user's own whose rate is twice the right one."""

    def __call__(self, times):
        return np.stack([np.sin(times), 2 * np.cos(times), -2 * np.sin(times)], axis=1)


WRONG["a Motion of one's own"] = Doubled()

ANALYSES = {
    "sweep": lambda m: m.sweep(2.0, 2000),
    "simulate": lambda m: m.simulate(2.0, 10),
    "batch": lambda m: m.batch(lengths={"coupler": [3.0, 3.1]}, duration=2.0, steps=20),
    "equilibrium": lambda m: m.equilibrium(),
    "efforts": lambda m: m.inverse_dynamics(m.sweep(2.0, 20), ["motor"]),
}


def four_bar(law: Motion) -> Mechanism:
    m = linkages.four_bar(3.0, 1.0, 3.0, 2.5, (60, 90), masses=(1.0, 1.0, None), law=law, gravity=(0.0, -9.81))
    m.set_mass("rocker", 1.0, (1.25, 0.0), 0.1)
    return m


@pytest.mark.parametrize("analysis", ANALYSES.values(), ids=ANALYSES)
@pytest.mark.parametrize("law", WRONG.values(), ids=WRONG)
def test_every_analysis_refuses_it(law: Motion, analysis) -> None:
    with pytest.raises(ModelError, match=r"four_bar: driver 'motor': function: d?df is not the derivative of d?f"):
        analysis(four_bar(law))


def test_right_derivatives_are_compared_once_for_each_law_and_span() -> None:
    calls = []
    m = four_bar(function(math.sin, math.cos, lambda t: calls.append(t) or -math.sin(t)))
    first = m.sweep(2.0, 20)
    checked = len(calls)
    calls.clear()
    again = m.sweep(2.0, 20)
    assert len(calls) < checked - 4000
    np.testing.assert_array_equal(again.a, first.a)
    calls.clear()
    m.sweep(2.5, 20)
    assert len(calls) >= checked


def test_a_function_that_has_changed_is_compared_again() -> None:
    of_rate = [1.0]
    m = four_bar(function(math.sin, lambda t: of_rate[0] * math.cos(t), lambda t: -of_rate[0] * math.sin(t)))
    m.sweep(2.0, 20)
    of_rate[0] = 1.01
    with pytest.raises(ModelError, match="df is not the derivative of f"):
        m.sweep(2.0, 20)


def test_a_changed_law_is_compared_again() -> None:
    m = four_bar(function(math.sin, math.cos, lambda t: -math.sin(t)))
    m.sweep(2.0, 20)
    m.change("motor", law=WRONG["sign of f''"])
    with pytest.raises(ModelError, match="ddf is not the derivative of df"):
        m.sweep(2.0, 20)


def test_a_distance_and_a_coordinate_are_compared_too() -> None:
    wrong = function(lambda t: 1 + 0.1 * math.sin(t), lambda t: 0.1 * math.cos(t), lambda t: 0.1 * math.sin(t))
    for add in (
        lambda m, b: m.drive_coordinate("drive", m.ground.at(0, 0), b.at(0, 0), wrong),
        lambda m, b: m.drive_distance("drive", m.ground.at(0, 0), b.at(0, 0), wrong),
    ):
        m = Mechanism("slide")
        block = m.body("block", mass=1.0, inertia=0.1)
        m.prismatic("rail", m.ground.at(0, 0), block.at(0, 0))
        m.start_near(block=(1.0, 0.0, 0.0))
        add(m, block)
        with pytest.raises(ModelError, match="ddf is not the derivative of df"):
            m.sweep(2.0, 20)


def test_a_motion_whose_steps_are_doubted_without_end_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steps, "MOST_DIVISIONS", 5)
    m = Mechanism("nearly a parallelogram")
    crank, coupler, rocker = m.bar("crank", 1.0), m.bar("coupler", 3.0 + 1e-9), m.bar("rocker", 1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(3, 0), rocker.start)
    m.drive_angle("drive", crank, constant_rate(1.0, 0.5))
    m.start_near(crank=29.0, coupler=0.0, rocker=29.0)
    with pytest.raises(
        ModelError, match=r"given up at t = .* s: \d+ steps were put between the 3 .* driver 'drive' goes"
    ):
        m.sweep(20.0, 2)


def _rise(begin: float, length: float, kind: str, off: float) -> tuple[Callable[[float], float], ...]:
    """A rise by 2 rad between dwells, as an author writes it: f, f', f''."""

    def part(t: float) -> float:
        return min(max((t - begin) / length, 0.0), 1.0)

    if kind == "cycloidal":
        turn = 2 * math.pi
        laws = (
            lambda u: u - math.sin(turn * u) / turn,
            lambda u: 1 - math.cos(turn * u),
            lambda u: turn * math.sin(turn * u),
        )
    else:
        laws = (
            lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5,
            lambda u: 30 * (u**2 - 2 * u**3 + u**4),
            lambda u: 60 * u - 180 * u**2 + 120 * u**3,
        )
    f, df, ddf = laws
    return (
        lambda t: off + 2 * f(part(t)),
        lambda t: 2 / length * df(part(t)),
        lambda t: 2 / length**2 * ddf(part(t)),
    )


@pytest.mark.parametrize("kind", ["cycloidal", "3-4-5"])
@pytest.mark.parametrize(("begin", "length"), [(3.3, 0.1), (2.0, 1.0), (0.2, 0.01), (9.2, 0.5)])
@pytest.mark.parametrize("off", [0.0, -450.0])
def test_a_rise_between_dwells_is_taken_as_it_is(kind: str, begin: float, length: float, off: float) -> None:
    """Where its terms cancel, beside the rise and in the dwells, its acceleration is rounding."""
    laws = _rise(begin, length, kind, off)
    m = Mechanism("index", gravity=None)
    table = m.body("table", 1.0, inertia=1.0)
    m.revolute("axle", m.ground.origin, table.origin)
    m.drive_angle("drive", table, function(*laws))
    times = np.sort(np.append(np.linspace(0.0, 10.0, 7), begin + length * np.linspace(0.05, 0.95, 13)))
    sol = m.sweep(times=times)
    view = sol.body("table")
    for got, law, size in zip(
        (view.theta, view.omega, view.alpha), laws, (1.0, 4 / length, 12 / length**2), strict=True
    ):
        np.testing.assert_allclose(got, [law(t) for t in times], rtol=1e-12, atol=1e-9 * size)


@pytest.mark.parametrize("length", [0.005, 0.05])
@pytest.mark.parametrize("wrong", [(True, False), (False, True), (True, True)])
def test_derivatives_that_err_on_a_short_stretch_are_refused(length: float, wrong: tuple[bool, bool]) -> None:
    def there(t: float, errs: bool) -> float:
        return 1.01 if errs and 1.0 < t < 1.0 + length else 1.0

    law = function(math.sin, lambda t: there(t, wrong[0]) * math.cos(t), lambda t: -there(t, wrong[1]) * math.sin(t))
    with pytest.raises(ModelError, match=r"d?df is not the derivative of d?f: at t = 1"):
        four_bar(law).sweep(2.0, 50)


def test_a_dwell_alone_stands_still() -> None:
    m = Mechanism("index", gravity=None)
    table = m.body("table", 1.0, inertia=1.0)
    m.revolute("axle", m.ground.origin, table.origin)
    m.drive_angle("drive", table, function(*_rise(0.2, 0.05, "cycloidal", 0.0)))
    sol = m.sweep(times=np.linspace(0.4, 1.0, 5))
    assert np.ptp(sol.body("table").theta) == 0.0
    assert not sol.v.any()
