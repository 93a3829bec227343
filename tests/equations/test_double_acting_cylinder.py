"""Double-acting cylinders: closed ports, wide ports, indicated work, books of energy, and bad arguments."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate

BORE, STROKE, ROD, SUPPLY, EXHAUST, AIR = 0.1, 0.2, 0.02, 8e5, 1.2e5, 101325.0
AREA = math.pi / 4 * BORE**2
BEHIND = AREA - math.pi / 4 * ROD**2
TURN = 2 * math.pi


def engine(valve: Any = 0.0, turned: float = 0.0, **given: Any) -> Mechanism:
    """A piston that swings over its stroke in a second, and a valve that moves as ``valve`` says."""
    m = Mechanism("engine", gravity=(0, 0))
    piston, slide = m.body("piston", 2.0), m.body("valve", 0.2, (0.03, 0.01))
    c, s = math.cos(turned), math.sin(turned)
    m.prismatic("guide", m.ground.at(0, 0, turned), piston.at(0.02, 0, 0.3))
    m.prismatic("seat", m.ground.at(-0.1 * s, 0.1 * c, turned), slide.at(0.01, -0.02, 0.7))
    own = {"supply": SUPPLY, "exhaust": EXHAUST, "width": 0.05, "lap": 0.004, "port": 0.02, "rod": ROD} | given
    ends = m.ground.at(0, 0, turned), piston.at(0.02, 0, 0.3)
    m.double_acting_cylinder("steam", *ends, bore=BORE, stroke=STROKE, valve="seat", **own)
    m.drive_coordinate("push", *ends, lambda t: STROKE / 2 * (1 - np.cos(TURN * t)))
    law = valve if callable(valve) or not isinstance(valve, float) else constant_rate(0.0, valve)
    m.drive_coordinate("gear", m.ground.at(-0.1 * s, 0.1 * c, turned), slide.at(0.01, -0.02, 0.7), law)
    return m


@pytest.mark.parametrize("turned", [0.0, 2.1])
def test_behind_closed_ports_the_gas_is_polytropic(turned: float) -> None:
    m = engine(0.0, turned, exhaust_lap=0.003, pressure_a=6e5, pressure_b=2e5)
    steam: Any = m.sweep(1.0, steps=50).force("steam")
    for pressure, volume in (steam.pressure_a, steam.volume_a), (steam.pressure_b, steam.volume_b):
        assert np.allclose(pressure * volume**1.3, pressure[0] * volume[0] ** 1.3, rtol=1e-7)
    assert np.allclose(steam.volume_a, AREA * (0.05 * STROKE + steam.value), rtol=1e-12)
    wanted = steam.pressure_a * AREA - steam.pressure_b * BEHIND - AIR * (AREA - BEHIND)
    assert np.allclose(steam.effort, wanted, rtol=1e-12)
    assert abs(steam.work[0]) < 0.5  # what it takes it gives back


def test_wide_ports_lead_the_pressures_of_supply_and_exhaust() -> None:
    """The valve opens both ports at the ends of the stroke: the diagram becomes a rectangle."""
    steam: Any = engine(lambda t: 0.015 * np.sin(TURN * t), lap=0.0, width=20.0).sweep(2.0, steps=4000).force("steam")
    last = slice(2000, None)
    wide = np.abs(steam.valve[last]) > 2e-3
    out = np.sin(TURN * np.arange(2001) / 2000) > 0
    assert np.allclose(steam.pressure_a[last][wide & out], SUPPLY, rtol=2e-3)
    assert np.allclose(steam.pressure_a[last][wide & ~out], EXHAUST, rtol=2e-3)
    assert np.allclose(steam.pressure_b[last][wide & out], EXHAUST, rtol=2e-3)
    work = -np.trapezoid(steam.effort[last], -steam.value[last])
    assert work == pytest.approx((SUPPLY - EXHAUST) * (AREA + BEHIND) * STROKE, rel=5e-3)


def test_cut_off_makes_the_work_of_the_ideal_diagram() -> None:
    """Wide ports, and an eccentric 36 degrees ahead: supply, expansion, exhaust, compression; Ripper, ch. 10."""
    amplitude, lap, ahead = 0.015, 0.006, math.radians(36)
    m = engine(lambda t: amplitude * np.sin(TURN * t + ahead), lap=lap, exhaust_lap=0.001, width=40.0)
    steam = m.sweep(2.0, steps=8000).force("steam")
    volume = lambda angle: AREA * STROKE * (0.05 + (1 - math.cos(angle)) / 2)  # noqa: E731
    cut, let = math.pi - math.asin(lap / amplitude) - ahead, math.pi + math.asin(0.001 / amplitude) - ahead
    close, admit = 2 * math.pi - math.asin(0.001 / amplitude) - ahead, 2 * math.pi + math.asin(lap / amplitude) - ahead

    def expansion(pressure: float, first: float, last: float) -> float:
        v, w = volume(first), volume(last)
        return pressure * v / 0.3 * (1 - (v / w) ** 0.3)

    wanted = SUPPLY * (volume(cut) - volume(admit)) + expansion(SUPPLY, cut, let)
    wanted += EXHAUST * (volume(close) - volume(let)) + expansion(EXHAUST, close, admit)
    pressure, held = steam.pressure_a[4000:], steam.volume_a[4000:]
    assert (0.5 * (pressure[1:] + pressure[:-1]) * np.diff(held)).sum() == pytest.approx(wanted, rel=5e-3)


def test_valve_events_come_in_their_order() -> None:
    amplitude, lap, inner = 0.015, 0.006, 0.002
    m = engine(lambda t: amplitude * np.sin(TURN * t), lap=lap, exhaust_lap=inner)
    events = m.sweep(1.0, steps=2000).force("steam").valve_events
    first = math.asin(lap / amplitude) / TURN
    late = math.asin(inner / amplitude) / TURN
    wanted = [
        (late, "release B"), (first, "admission A"), (0.5 - first, "cut-off A"), (0.5 - late, "compression B"),
        (0.5 + late, "release A"), (0.5 + first, "admission B"), (1.0 - first, "cut-off B"),
        (1.0 - late, "compression A"),
    ]  # fmt: skip
    assert [name for _, name in events] == [name for _, name in wanted]
    assert np.allclose([at for at, _ in events], [at for at, _ in wanted], atol=1e-6)


def test_the_power_of_the_motor_is_that_of_the_gas() -> None:
    m = engine(lambda t: 0.015 * np.sin(TURN * t))
    sol = m.sweep(1.0, steps=4000)
    steam = sol.force("steam")
    area = steam.work[0] + steam.work[1]
    assert np.trapezoid(steam.power, sol.t) == pytest.approx(area, rel=1e-5)
    inner = engine(lambda t: -0.015 * np.sin(TURN * t), inside=True).sweep(1.0, steps=4000)
    assert np.allclose(inner.force("steam").pressure_a, steam.pressure_a, rtol=1e-5)


def test_a_free_piston_runs_and_is_saved(tmp_path: Path) -> None:
    m = engine(0.01, pressure_a=3e5)
    del m.drivers["push"]
    m.spring("buffer", m.ground.at(1.0, 0), m.bodies["piston"].origin, 4e5, damping=4e3, free_length=0.9)
    m.start_near(piston=(0.08, 0, 0))
    m.save(tmp_path / "m.json")
    sol, again = m.simulate(0.02, steps=20), Mechanism.load(tmp_path / "m.json").simulate(0.02, steps=20)
    assert (sol.body("piston").x == again.body("piston").x).all()
    assert sol.force("steam").pressure_a[-1] > 7e5  # the supply fills chamber a
    assert sol.force("steam").pressure_b[-1] < 1.5e5


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"rod": 0.2}, "inside of the bore"),
        ({"exhaust": 9e5}, "make the supply's the higher"),
        ({"exponent": 1.0}, "above 1"),
        ({"width": -1.0}, "must be positive"),
        ({"lap": float("nan")}, "finite"),
    ],
)
def test_bad_cylinders_are_refused(given: Any, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        engine(0.0, **given)


def test_a_valve_that_is_none_and_a_piston_beyond_its_end_are_refused() -> None:
    m = engine(0.0)
    with pytest.raises(ModelError, match="give a prismatic joint whose first marker is on 'piston'"):
        m.double_acting_cylinder(
            "other", m.bodies["piston"].origin, m.ground.origin, BORE, STROKE, "seat", SUPPLY, width=0.01
        )
    m.change("push", law=constant_rate(0.3, 0.0))
    with pytest.raises(ModelError, match=r"m along its cylinder, of which 0 \.\. 0\.2 m are its stroke"):
        m.sweep(1.0, steps=20)


@pytest.fixture(scope="module")
def valved() -> Mechanism:
    return engine(lambda t: 0.015 * np.sin(TURN * t + 0.6), lap=0.006, width=2.0)


def test_its_pressures_do_not_depend_on_how_many_outputs_there_are(valved: Mechanism) -> None:
    few: Any = valved.sweep(times=[0.0, 0.5, 1.0]).force("steam")
    many: Any = valved.sweep(times=np.linspace(0.0, 1.0, 401)).force("steam")
    assert np.allclose(few.pressure_a, many.pressure_a[::200], rtol=1e-6)
    assert np.allclose(few.effort, many.effort[::200], rtol=0.0, atol=1e-6 * np.abs(many.effort).max())


@pytest.mark.parametrize("number", ["supply", "bore"])
def test_derivatives_of_efforts_take_its_pressures_along(valved: Mechanism, number: str) -> None:
    """Pressures hang on all numbers, and efforts on them, also where outputs are few."""
    times = np.linspace(0.0, 1.0, 6)
    own = valved.sensitivities("push.effort", f"steam.{number}", times=times)["push.effort"][:, 0]
    efforts, step = [], 1e-3 * {"supply": SUPPLY, "bore": BORE}[number]
    for side in (1.0, -1.0):
        valved.change("steam", **{number: {"supply": SUPPLY, "bore": BORE}[number] + side * step})
        efforts.append(valved.sweep(times=times).driver("push").effort)
    valved.change("steam", **{number: {"supply": SUPPLY, "bore": BORE}[number]})
    known = (efforts[0] - efforts[1]) / (2.0 * step)
    assert np.allclose(own, known, rtol=0.0, atol=1e-4 * np.abs(known).max())
