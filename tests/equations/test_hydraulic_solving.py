"""Pressures of a hydraulic cylinder are the same by every way of solving: integrators, sweeps, copies, machine code."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import pack
from mbsd.arrays.states import columns_of, ones_of, widened, with_states
from mbsd.equations.loads import tabulate_loads
from tests.equations.test_hydraulic_cylinder import AIR, BULK, FLOW, A, B, boom, oil_of, press, view_of


def test_both_formulations_and_both_kinds_of_integrators_give_one_motion() -> None:
    def moving() -> Mechanism:
        return boom(valve=lambda t: 0.3 * math.sin(4.0 * t), leak=1e-12)

    ways: list[dict[str, Any]] = [
        {"formulation": "reference"}, {"formulation": "independent"}, {"method": "radau"}, {"method": "scipy-lsoda"},
    ]  # fmt: skip
    solutions = [moving().simulate(0.5, steps=20, tolerance=1e-9, **way) for way in ways]
    assert [sol.stats.independent for sol in solutions] == [False, True, False, False]
    for sol in solutions[1:]:
        assert sol.q == pytest.approx(solutions[0].q, abs=1e-6)
        assert sol.states == pytest.approx(solutions[0].states, rel=1e-5, abs=2e3)


def test_a_stiff_cylinder_is_a_matter_for_radau_and_no_trap_for_the_others() -> None:
    stiff = {"valve": 1.0, "dead_a": 1e-7, "dead_b": 1e-7, "place": 0.6, "transition": 1e3}
    explicit = press(**stiff).simulate(0.5, steps=20)
    implicit = press(**stiff).simulate(0.5, steps=20, method="radau")
    assert implicit.stats.steps < explicit.stats.steps / 5
    assert implicit.body("carriage").x == pytest.approx(explicit.body("carriage").x, abs=1e-7)


def test_a_simulation_goes_on_at_other_times_and_from_its_own_end() -> None:
    m = boom(valve=lambda t: 0.3 * math.sin(4.0 * t))
    whole = m.simulate(0.6, steps=60, tolerance=1e-10)
    between = m.simulate(0.6, steps=3, tolerance=1e-10).at(whole.t[1:-1])
    assert between.q == pytest.approx(whole.q[1:-1], abs=1e-8)
    assert whole.states is not None
    assert between.states == pytest.approx(whole.states[1:-1], rel=1e-6, abs=100.0)


def test_a_driven_cylinder_has_the_pressures_of_the_simulated_one_and_asks_its_driver_for_the_rest() -> None:
    def driven() -> Mechanism:
        m = press(valve=lambda t: 0.5 * math.sin(20.0 * t))
        m.drive_coordinate("push", m.ground.origin, m.bodies["carriage"].origin, constant_rate(0.05, 1.0))
        return m

    simulated = driven().simulate(0.5, steps=250, method="radau", tolerance=1e-10)
    swept = driven().sweep(0.5, steps=250)
    assert swept.states == pytest.approx(simulated.states, rel=1e-5, abs=10.0)
    assert swept.driver("push").force == pytest.approx(simulated.driver("push").force, rel=1e-5, abs=1.0)
    assert swept.driver("push").force == pytest.approx(-np.array(view_of(swept).effort), abs=1e-6)
    efforts = (m := driven()).inverse_dynamics(m.sweep(0.5, steps=250), ["push"]).efforts["push"]
    assert efforts == pytest.approx(swept.driver("push").force, rel=1e-9, abs=1e-6)


def test_a_valve_that_jumps_is_on_one_side_or_the_other() -> None:
    m = press(valve=lambda t: 0.3 if t < 0.2 else -0.3)
    sol = m.simulate(0.4, steps=8, event_rows=True)
    view = view_of(sol)
    assert view.valve[view.valve > 0].size + view.valve[view.valve < 0].size == len(sol.t)
    assert sol.states is not None
    assert len(sol.states) == len(sol.t)


def test_an_event_may_look_at_a_pressure() -> None:
    m = press(valve=1.0, place=1.5)
    m.event("blocked", lambda t, moment: moment.state("ram", "pressure_b") - 30e6, direction=1, terminal=True)
    sol = m.simulate(1.0)
    assert sol.t[-1] < 1.0
    assert view_of(sol).pressure_b[-1] == pytest.approx(30e6, rel=1e-6)
    m.event("wrong", lambda t, moment: moment.state("ram", "presure_a"))
    with pytest.raises(ModelError, match="pressure_a"):
        m.simulate(0.1)


def test_a_copy_by_pickle_and_a_file_give_the_same_bits(tmp_path: Any) -> None:
    m = press(valve=0.4, leak=1e-12)
    path = tmp_path / "press.json"
    m.save(path)
    known = m.simulate(0.2, steps=20)
    for other in (pickle.loads(pickle.dumps(m)), Mechanism.load(path)):
        assert np.array_equal(other.simulate(0.2, steps=20).states, known.states)
    again = pickle.loads(pickle.dumps(known.states))
    assert np.array_equal(again, known.states)


@given(
    opening=st.sampled_from([-1.5, -1.0, -0.3, -1e-3, 0.0, 1e-3, 0.5, 1.0, 1.5]), place=st.floats(0.61, 1.59),
    rate=st.floats(-2.0, 2.0),
    pressure_a=st.floats(0.0, 4e7), pressure_b=st.floats(0.0, 4e7), air=st.sampled_from([0.0, 0.005, 0.1]),
    leak=st.sampled_from([0.0, 1e-11]),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_the_compiled_law_is_that_of_the_arrays(
    opening: float, place: float, rate: float, pressure_a: float, pressure_b: float, air: float, leak: float
) -> None:
    m = press(valve=lambda t: opening, air=air, leak=leak)
    packed = with_states(pack(m))
    loads, laws = pack_loads(packed), compiled_laws(packed, 0.0, 1.0)
    q, v = np.array([[0.0, 0, 0, place, 0, 0]]), np.array([[0.0, 0, 0, rate, 0, 0]])
    states = np.array([[pressure_a, pressure_b]])
    out, power = np.zeros((1, 3 * len(packed.body_names))), np.zeros(1)
    wide_q, wide_v = widened(packed, q), widened(packed, v, states)
    tabulate_loads(packed.system, loads, laws, np.zeros(1), wide_q, wide_v, packed.ws, out, power)
    oil = oil_of(m)
    known = oil.rates(np.array([opening]), np.array([place]), np.array([rate]), states[:, 0], states[:, 1])
    tabulated = out[0, columns_of(packed)] * ones_of(packed)
    scale = BULK / 1e-4 * (FLOW + A * abs(rate))
    assert tabulated == pytest.approx(np.concatenate(known), rel=1e-9, abs=1e-9 * scale)
    push = pressure_a * A - pressure_b * B - AIR * (A - B)
    assert out[0, 3] == pytest.approx(push, rel=1e-12, abs=1e-6)
    assert power[0] == pytest.approx(push * rate, rel=1e-9, abs=1e-6)


def test_a_model_without_states_is_packed_as_ever() -> None:
    m = press()
    del m.forces["ram"]
    packed = pack(m)
    assert with_states(packed) is packed
    assert m.simulate(0.1).states is None
