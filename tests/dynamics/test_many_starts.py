"""Starts of many simulations: found for all rows of a chunk at once, and the same in any chunk."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.base.errors import MechanismError, SimulationError
from mbsd.compiling.jit import kernel
from mbsd.dynamics.events.refusals import taking_turns
from mbsd.dynamics.events.sticking.deciding import solve_least
from mbsd.measures import final
from mbsd.model.event import Happening
from mbsd.studies.simulated import simulated
from tests.dynamics.many_models import STEPS, door, pendulum
from tools.models.guided import EIGHT, coaster
from tools.models.stops import barrier


def test_starts_do_not_follow_from_which_rows_go_together() -> None:
    rng, count = np.random.default_rng(5), 90
    a, b, omega = rng.uniform(-180, 180, count), rng.uniform(-90, 90, count), rng.uniform(-3, 3, count)
    asked = {"measure": {"x": final("P.x")}, "steps": 5}
    whole = pendulum().simulate_many(0.5, start={"a": a, "b": b}, moving={"b": omega}, threads=1, **asked)
    for threads in (3, 7):
        again = pendulum().simulate_many(0.5, start={"a": a, "b": b}, moving={"b": omega}, threads=threads, **asked)
        assert np.array_equal(whole["x"], again["x"])
    assert whole.alone == [None] * count


@pytest.mark.parametrize("what", ["start", "moving"])
def test_a_body_that_a_driver_places_cannot_be_started(what: str) -> None:
    m = door()
    m.drive_angle("motor", m.bodies["door"], constant_rate(1.0))
    with pytest.raises(ModelError, match="driver 'motor' says where 'door' is"):
        m.simulate_many(1.0, measure={"x": final("door.theta")}, **{what: {"door": [10.0, 20.0]}})


@pytest.mark.parametrize("model", [door, barrier])
def test_a_start_that_says_nothing_of_its_turn_is_the_reason_of_its_row(model: Callable[[], Mechanism]) -> None:
    """A spring that is turned by so much pulls so hard that its motion would take hours; rows beside it keep theirs."""
    m = model()
    body = list(m.bodies)[1]
    asked = {"measure": {"x": final(f"{body}.theta")}, "steps": 5}
    for far in (1e30, -2e9):
        for first, last in ((0, 1), (1, 0)):
            starts = [20.0, 20.0]
            starts[first] = far
            many = m.simulate_many(0.2, start={body: starts}, **asked)
            assert many.good.tolist() == [bool(first), bool(last)]
            assert f"start of '{body}' is {far:g} degrees" in str(many.reason[first])
            alone = model()
            alone.start_near(**{body: 20.0})
            np.testing.assert_allclose(many["x"][last], alone.simulate(0.2, steps=5).body(body).theta[-1], atol=1e-9)
    with pytest.raises(ModelError, match="1e\\+09 at most: subtract whole turns"):
        m.start_near(**{body: 1e30})
    m.start_near(**{body: 1e9})


def test_starts_and_velocities_are_those_of_single_simulations() -> None:
    rng, count = np.random.default_rng(2), 12
    a, b, omega = rng.uniform(-180, 180, count), rng.uniform(-90, 90, count), rng.uniform(-3, 3, count)
    for moving in ({"b": omega}, {"a": omega, "b": -omega}, None):
        many = pendulum().simulate_many(
            0.8, start={"a": a, "b": b}, moving=moving, measure={"x": final("P.x"), "fy": final("A.fy")}, steps=STEPS
        )
        assert many.alone == [None] * count
        for k in range(count):
            m = pendulum()
            m.start_near(a=a[k], b=b[k])
            if moving is not None:
                m.start_moving(**{name: float(values[k]) for name, values in moving.items()})
            sol = m.simulate(0.8, steps=STEPS)
            np.testing.assert_allclose(many["x"][k], sol.point("P").x[-1], atol=1e-9)
            np.testing.assert_allclose(many["fy"][k], sol.joint("A").fy[-1], atol=1e-7)


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


def test_starts_on_other_branches_and_reactions() -> None:
    starts = [(*EIGHT[10], 0.0), (*EIGHT[40], 0.0)]
    many = coaster().simulate_many(1.0, start={"bead": starts}, measure={"x": final("bead.x")}, steps=STEPS)
    assert many.alone == [None, None], many.way
    for k, start in enumerate(starts):
        m = coaster()
        m.start_near(bead=start)
        np.testing.assert_allclose(many["x"][k], m.simulate(1.0, steps=STEPS).body("bead").x[-1], atol=1e-9)
    vary = {"tie": {"stiffness": [20.0, 40.0]}}
    many = coaster().simulate_many(0.2, vary=vary, measure={"f": final("track.fx")}, steps=4)
    assert many.way == "2 one by one (reactions where points are on curves that cross themselves)"


def test_contacts_that_carry_in_turns_are_named() -> None:
    feet = [("left", "opens"), ("right", "closes"), ("left", "closes"), ("right", "opens")]
    changes = [Happening(0.5 + 1e-9 * k, *feet[k % 4]) for k in range(150)]
    with pytest.raises(SimulationError, match=r"walker: near t = 0.5 s 'left' and 'right' carry in turns"):
        raise taking_turns("walker", changes, 1.0) or AssertionError
    slow = [replace(happening, time=0.5 + 1e-3 * k) for k, happening in enumerate(changes)]
    assert taking_turns("walker", slow, 1.0) is None
    assert taking_turns("walker", changes[:50], 1.0) is None
    assert taking_turns("walker", [replace(happening, what="impact") for happening in changes], 1.0) is None


@kernel
def least(table, n):
    """``solve_least`` for tests."""
    solve_least(table, n)


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 7), st.integers(1, 7), st.integers(0, 2**32 - 1))
def test_the_shortest_solution_is_that_of_numpy(n: int, rank: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.normal(size=(n, rank)) @ random.normal(size=(rank, n))
    right = random.normal(size=n)
    table = np.zeros((n, 2 * n + 2))
    table[:, :n], table[:, n : 2 * n], table[:, 2 * n] = matrix, np.eye(n), right
    least(table, n)
    expected = np.linalg.lstsq(matrix, right, rcond=1e-10)[0]
    np.testing.assert_allclose(table[:, 2 * n + 1], expected, atol=1e-6 * max(1.0, np.abs(expected).max()))
