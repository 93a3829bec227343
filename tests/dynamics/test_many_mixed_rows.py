"""Rows of one chunk that differ in numbers of all kinds: every quantity is that of the single simulation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.measures import final, samples
from mbsd.numbers.names import number_named, with_values
from mbsd.studies.simulated import simulated
from tests.dynamics.test_many_numbers import press
from tools.hunt.outcome import AGREED, WRONG
from tools.hunt.solving.free_case import nudged
from tools.hunt.solving.mixed_rows import beside_single_ones, mixed_rows, quantity_names
from tools.models import assur_models, linkages
from tools.models.stops import barrier

MOVED = {
    "motor": {"amplitude": [0.6, 0.5, 0.4, 0.45], "rate": [9.0, 8.0, 10.0, 9.5], "phase": [0.2, 0.0, 0.1, -0.3]},
    "P": {"angle": [0.0, 0.3, -0.2, 1.0], "x": [0.1, 0.11, 0.09, 0.1]},
    "rod": {"length": [0.15, 0.151, 0.149, 0.15], "com.x": [0.075, 0.07, 0.08, 0.06]},
    "hand": {"mass": [0.1, 0.2, 0.15, 0.3]},
    "twist": {"amplitude": [0.4, -0.4, 0.2, 0.0]},
    "O": {"y": [0.0, 1e-3, -1e-3, 2e-3]},
}
TIMES = np.linspace(0.0, 0.4, 9)


@pytest.mark.parametrize("terminal", [False, True])
def test_every_quantity_of_rows_that_differ_in_all_is_that_of_a_single_simulation(terminal: bool) -> None:
    m = press()
    if terminal:  # rows end at times of their own
        m.event("far", lambda t, moment: moment.body("hand").theta - 0.9, terminal=True)
        m.start_near(hand=0)
    quantities = quantity_names(m.simulate(times=TIMES, tolerance=1e-10))
    measure = {name: samples(name, TIMES.tolist()) for name, q in quantities.items() if q.of_motions is not None}
    assert {"motor.value", "motor.power", "motor.effort", "P.theta", "P.ax", "B.torque", "kinetic"} <= {*measure}
    many = m.simulate_many(vary=MOVED, measure=measure, times=TIMES, tolerance=1e-10)
    assert terminal or many.alone == [None] * 4
    names = [f"{whole}.{key}" for whole, own in MOVED.items() for key in own]
    rows = np.array([column for own in MOVED.values() for column in own.values()]).T
    for k, row in enumerate(rows.tolist()):
        alone = with_values(m, [number_named(m, name) for name in names], row).simulate(times=TIMES, tolerance=1e-10)
        for name in measure:
            there = quantities[name].of_solution(alone)
            near = 1e-8 * max(1.0, float(np.abs(there).max()))
            np.testing.assert_allclose(many[name][k][: len(there)], there, rtol=0, atol=near, err_msg=f"{name} {k}")


@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 10**6), st.sampled_from([barrier, press, assur_models.four_bar, linkages.watt]))
def test_random_numbers_vary_at_once(seed: int, built) -> None:  # type: ignore[no-untyped-def]
    m, rng = built(), np.random.default_rng(seed)
    rows = mixed_rows(m, rng)
    assert rows is not None
    outcome = beside_single_ones("rows", rows, 0.2, 1e-9, nudged)
    assert outcome.state != WRONG, outcome.detail


def test_the_comparison_finds_a_row_that_has_the_numbers_of_another() -> None:
    m, rng = press(), np.random.default_rng(1)
    rows = mixed_rows(m, rng)
    assert rows is not None
    assert beside_single_ones("rows", rows, 0.2, 1e-9, nudged).state == AGREED
    together = rows.together
    rows.together = lambda *given: together(*given) if rows.values[0, 0] < 0 else _second_twice(together(*given))  # type: ignore[method-assign]
    assert beside_single_ones("rows", rows, 0.2, 1e-9, nudged).state == WRONG


def _second_twice(many):  # type: ignore[no-untyped-def]
    for column in many.columns.values():
        column[2] = column[1]
    return many


def chain(points_of: str = "first") -> Mechanism:
    """Two bars in a row, with a traced point on one of them."""
    m = Mechanism("chain")
    first, second = m.bar("first", 0.3, mass=1.0), m.bar("second", 0.4, mass=0.5)
    m.revolute("O", m.ground.origin, first.start)
    m.revolute("A", first.end, second.start)
    m.start_near(first=10.0, second=-40.0)
    m.trace("P", m.bodies[points_of].at(0.1, 0.02))
    return m


def test_a_traced_point_on_another_body_is_another_kind_of_row() -> None:
    mechanisms = [chain(name) for name in ("first", "second", "first", "second")]
    measured = simulated({"x": final("P.x"), "angle": final("P.theta")}, 0.3).of_all(mechanisms)
    for m, (numbers, reason) in zip(mechanisms, measured, strict=True):
        assert reason is None
        assert numbers is not None
        point = m.simulate(0.3).point("P")
        assert numbers["x"] == pytest.approx(point.x[-1], abs=1e-12)
        assert numbers["angle"] == pytest.approx(point.theta[-1], abs=1e-12)


@pytest.mark.parametrize("moving", [{"second": [2.0, -3.0]}, {"first": [1.0, 0.0], "second": [2.0, -3.0]}])
def test_velocities_need_no_start(moving: dict[str, list[float]]) -> None:
    m = chain()
    m.starts.clear()
    many = m.simulate_many(0.2, moving=moving, measure={"w": final("second.omega")})
    for k in range(2):
        m.velocities.clear()
        m.start_moving(**{name: omegas[k] for name, omegas in moving.items()})
        assert many["w"][k] == pytest.approx(m.simulate(0.2).body("second").omega[-1], rel=1e-9)


def test_one_odd_mass_among_many_rows_moves_its_own_start() -> None:
    """The speed that is not given is that of least kinetic energy, which depends on the masses."""
    count, odd = 60, 7
    masses = np.full(count, 0.5)
    masses[odd] = 5.0
    m = chain()
    many = m.simulate_many(
        0.1, vary={"second": {"mass": masses}}, moving={"second": [2.0]}, measure={"w": final("first.omega")}
    )
    for row in (0, odd, count - 1):
        m.change("second", mass=masses[row])
        m.start_moving(second=2.0)
        assert many["w"][row] == pytest.approx(m.simulate(0.1).body("first").omega[-1], rel=1e-9)


def test_masses_far_apart_in_one_row_leave_the_reactions_of_others_alone() -> None:
    """How often the equations of motion are solved belongs to a row."""
    m, masses = chain(), [1e-7, 0.5, 0.6, 1e-6]
    many = m.simulate_many(
        0.1, vary={"second": {"mass": masses, "com.x": [0.2, 0.21, 0.19, 0.2]}}, measure={"f": final("O.fy")}
    )
    for k, mass in enumerate(masses):
        m.change("second", mass=mass, com=((0.2, 0.21, 0.19, 0.2)[k], 0.0))
        try:
            alone = m.simulate(0.1).joint("O").fy[-1]
        except MechanismError:
            continue
        assert many["f"][k] == pytest.approx(alone, rel=1e-9)
