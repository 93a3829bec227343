"""Genevas in the compiled loop over simulations: the digits of single simulations, which end steps at their jumps."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from mbsd import Mechanism
from mbsd.measures import final, first, samples
from tests.dynamics.beside_single_runs import between
from tools.models.guided import free_geneva, heavy_pair_of_genevas, swinging_geneva

STEPS = 40


CASES: dict[str, Callable[[], Mechanism]] = {
    "turning": lambda: free_geneva(6),
    "swinging": swinging_geneva,
    "two": heavy_pair_of_genevas,
}
VARY = {"spring": {"stiffness": np.linspace(0.0, 0.03, 6), "damping": np.linspace(0.0, 2e-4, 6)}}
MEASURES = {
    "theta": samples("wheel.theta", np.linspace(0.0, 2.0, STEPS + 1).tolist()),
    "omega": samples("crank.omega", [1.0, 2.0]),
    "W": final("Wwheel.fx"),
    "work": final("work"),
}


@pytest.mark.parametrize("formulation", ["independent", "reference"])
@pytest.mark.parametrize("case", CASES)
def test_genevas_have_the_digits_of_single_simulations(case: str, formulation: str) -> None:
    build = CASES[case]
    measure = {**MEASURES, "W": final("Wwheel.fx" if case == "two" else "W.fx")}
    many = build().simulate_many(2.0, vary=VARY, measure=measure, steps=STEPS, formulation=formulation)
    assert many.alone == [None] * 6, many.way
    assert "anew" not in many.way
    for k in range(6):
        m = build()
        for name, values in VARY.items():
            m.change(name, **{key: float(column[k]) for key, column in values.items()})
        sol = m.simulate(2.0, steps=STEPS, formulation=formulation)
        assert np.array_equal(many["theta"][k], sol.body("wheel").theta)
        assert np.array_equal(many["omega"][k], sol.body("crank").omega[[STEPS // 2, STEPS]])
        assert many["work"][k] == (0.0 if sol.work is None else sol.work[-1])


def test_starts_vary_and_rows_end_early_by_the_steps_of_whole_ones() -> None:
    degrees = np.linspace(-170.0, 170.0, 12)
    m = free_geneva(5)
    early = {"far": first("wheel.theta", above=1.5), "late": first("crank.theta", below=-9.0, give="wheel.omega")}
    short, whole = (
        m.simulate_many(
            3.0, start={"crank": degrees}, moving={"crank": -9.0}, measure=measure, steps=300, formulation="independent"
        )
        for measure in (early, {**early, "end": final("crank.theta")})
    )
    assert short.alone == [None] * 12, short.way
    for name in early:
        assert np.array_equal(short[name], whole[name], equal_nan=True)
    assert np.isfinite(short["far"]).any()


def test_a_row_that_cannot_start_has_its_reason_beside_others() -> None:
    many = free_geneva(5).simulate_many(
        1.0, vary={"index": {"radius": [0.1 * math.sin(math.pi / 5), 0.07]}}, measure={"end": final("wheel.theta")},
        steps=4, formulation="independent",
    )  # fmt: skip
    assert many.good.tolist() == [True, False]
    assert "its radius must be" in str(many.reason[1])


@settings(max_examples=6, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(between(-179.0, 179.0), between(-15.0, 15.0), between(0.0, 0.05), between(0.0, 0.02))
def test_random_genevas_move_as_by_themselves(
    start: float, speed: float, stiffness: float, out_of_balance: float
) -> None:
    m = free_geneva(4 + int(abs(start)) % 5)
    m.change("spring", stiffness=stiffness)
    m.change("crank", com=(out_of_balance, 0.0))
    m.start_near(crank=start, wheel=180 / (4 + int(abs(start)) % 5))
    m.start_moving(crank=speed)
    damping = [0.0, 3e-4]
    many = m.simulate_many(
        1.0, vary={"spring": {"damping": damping}}, measure={"end": final("wheel.theta")}, steps=5,
        formulation="independent",
    )  # fmt: skip
    for k, value in enumerate(damping):
        m.change("spring", damping=value)
        sol = m.simulate(1.0, steps=5, formulation="independent")
        assert many.alone[k] is None or "other coordinates" in str(many.alone[k]), many.way
        assert many["end"][k] == sol.body("wheel").theta[-1]
