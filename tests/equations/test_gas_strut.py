"""Gas struts: published numbers of a tailgate's, the closed form, energy, damping of both ways, stops at both ends."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate, harmonic

F1, RATIO, LENGTH, STROKE = 400.0, 1.35, 0.5, 0.2
"""N, F2 / F1, m: of a tailgate's."""


def bench(rate: float | None = None, mass: float = 20.0, place: float = LENGTH, **more) -> Mechanism:
    """A carriage on a strut from the origin, moved at ``rate`` (m/s) or free."""
    m = Mechanism("strut", gravity=None)
    carriage = m.body("carriage", mass, inertia=1.0)
    m.prismatic("rail", m.ground.origin, carriage.origin)
    m.gas_strut("strut", m.ground.origin, carriage.origin, F1, RATIO, LENGTH, STROKE, **more)
    if rate is not None:
        m.drive_coordinate("drive", m.ground.origin, carriage.origin, constant_rate(rate, place))
    m.start_near(carriage=(place, 0.0, 0.0))
    return m


@pytest.mark.parametrize("exponent", [1.0, 1.3])
def test_force_over_way_is_the_closed_form(exponent: float) -> None:
    sol = bench(-0.1, exponent=exponent).sweep(2.0, steps=20)
    pushed = LENGTH - sol.body("carriage").x
    volume = 1.0 - pushed / STROKE * (1.0 - 1.0 / RATIO)
    view = sol.force("strut")
    assert view.effort == pytest.approx(F1 * volume**-exponent, rel=1e-12)
    assert view.length == pytest.approx(LENGTH - pushed)
    assert view.effort is not None
    assert view.effort[-1] / view.effort[0] == pytest.approx(RATIO**exponent, rel=1e-9)


def test_damping_differs_in_and_out_and_rises_at_the_end() -> None:
    damped = {"compression_damping": 50.0, "extension_damping": 900.0, "end_damping": 4000.0, "end_way": 0.03}
    slow = bench(-0.1).sweep(1.9, steps=19).force("strut").effort
    inwards = bench(-0.1, **damped).sweep(1.9, steps=19).force("strut").effort
    outwards = bench(0.1, place=LENGTH - 0.19, **damped).sweep(1.9, steps=19).force("strut").effort
    assert slow is not None
    assert inwards is not None
    assert outwards is not None
    assert inwards - slow == pytest.approx(5.0)
    lost = slow[::-1] - outwards
    assert lost[:16] == pytest.approx(90.0)
    assert lost[-1] == pytest.approx(400.0)


def test_a_free_mass_swings_between_its_stops_without_loss() -> None:
    m = bench(place=LENGTH - 0.1, stop_stiffness=1e5, stop_damping=0.0)
    m.start_moving(carriage=(-3.0, 0.0, 0.0))
    sol = m.simulate(0.5, steps=500, tolerance=1e-9)
    x = sol.body("carriage").x
    assert x.max() > LENGTH
    assert x.min() < LENGTH - STROKE
    assert np.ptp(sol.energy.total) < 1e-6 * sol.energy.total.max()


def test_a_tailgate_opens_by_itself_and_rests_on_its_strut() -> None:
    m = Mechanism("tailgate")
    gate = m.body("gate", 25.0, com=(0.5, 0.0), inertia=3.0)
    m.revolute("hinge", m.ground.origin, gate.origin)
    closed, opened = math.radians(-80.0), math.radians(15.0)
    foot, eye = (0.05, -0.55), (0.25, -0.02)

    def length(angle: float) -> float:
        c, s = math.cos(angle), math.sin(angle)
        return math.hypot(c * eye[0] - s * eye[1] - foot[0], s * eye[0] + c * eye[1] - foot[1])

    m.gas_strut(
        "strut", m.ground.at(*foot), gate.at(*eye), 900.0, 1.3, length(opened), length(opened) - length(closed) + 0.01,
        extension_damping=2500.0, end_damping=6000.0, end_way=0.04, compression_damping=200.0, stop_damping=3.0,
    )  # fmt: skip
    m.start_near(gate=math.degrees(closed + 0.4))
    sol = m.simulate(15.0, steps=150)
    assert sol.body("gate").theta[-1] == pytest.approx(opened, abs=0.01)
    assert abs(sol.body("gate").omega[-1]) < 1e-3
    assert sol.audit is not None
    assert np.abs(sol.audit - sol.audit[0]).max() < 1e-4


def test_in_a_driven_turn_the_damping_takes_what_the_driver_gives() -> None:
    m = bench(friction=30.0, slip_speed=1e-4)
    m.drive_coordinate("drive", m.ground.origin, m.bodies["carriage"].origin, harmonic(0.09, 1.0, 0.0, LENGTH - 0.1))
    m.start_near(carriage=(LENGTH - 0.1, 0, 0))
    sol = m.sweep(steps=2000)
    assert np.trapezoid(sol.driver("drive").power, sol.t) == pytest.approx(4 * 0.09 * 30.0, rel=1e-3)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"ratio": 1.0}, "ratio is 1; it must be above 1"),
        ({"stroke": 0.6}, "a strut is longer than its stroke"),
        ({"force": 0.0}, "force is 0; it must be positive"),
        ({"exponent": 0.9}, "exponent is 0.9; it must be 1 or more"),
    ],
)
def test_invalid_requests_are_refused(more: dict, words: str) -> None:
    m = Mechanism("strut")
    body = m.body("body", 1.0, inertia=1.0)
    numbers = {"force": F1, "ratio": RATIO, "length": LENGTH, "stroke": STROKE} | more
    with pytest.raises(ModelError, match=words):
        m.gas_strut("strut", m.ground.origin, body.origin, **numbers)
