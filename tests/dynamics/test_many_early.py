"""Simulations that end where everything asked of them is known have the numbers of those that go on to their end."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.compiling.jit import COMPILED
from mbsd.dynamics.batch import loop
from mbsd.dynamics.batch.loop import MOST_PASSED
from mbsd.measures import Measure, final, first, integral, samples
from tests.dynamics.many_models import door, pendulum
from tools.models.stops import barrier

DURATION, STEPS = 4.0, 300
WHOLE = {"end": integral("work")}
"""A measure that needs all outputs."""

MACHINES = {
    "door": (
        door(),
        {"closer": {"stiffness": np.linspace(0.5, 30.0, 9)}},
        {
            "shut": first("door.theta", below=0.05),
            "speed": first("door.theta", below=0.05, give="door.omega"),
            "never": first("door.theta", below=-0.2),
        },
    ),
    "pendulum": (
        pendulum(),
        {"a": {"mass": np.linspace(0.5, 2.0, 7)}},
        {"up": first("P.y", above=-0.9), "fast": first("b.omega", above=6.0, give="a.theta")},
    ),
    "barrier": (
        barrier(),
        {"spring": {"stiffness": np.linspace(1.0, 5.0, 5)}},
        {"open": first("rocker.theta", above=1.7), "early": samples("crank.omega", [0.2, 0.4])},
    ),
}


LEVELS = st.floats(-0.5, 2.0).map(lambda level: round(level, 3))
TIMES = st.lists(st.integers(0, STEPS).map(lambda k: DURATION * k / STEPS), min_size=1, max_size=3)


@st.composite
def measures_of(draw: st.DrawFn, body: str) -> dict[str, Measure]:
    """Some that end a simulation, and some that read a few outputs."""
    out: dict[str, Measure] = {}
    for k in range(draw(st.integers(1, 3))):
        quantity, way = f"{body}.{draw(st.sampled_from(['theta', 'omega']))}", draw(st.sampled_from(["below", "above"]))
        given = draw(st.sampled_from([None, f"{body}.x", f"{body}.omega"]))
        out[f"first {k}"] = first(quantity, **{way: draw(LEVELS)}, give=given)
    if draw(st.booleans()):
        out["some"] = samples(f"{body}.theta", draw(TIMES))
    if draw(st.booleans()):
        out["last"] = final(f"{body}.omega")
    return out


@pytest.mark.parametrize(("name", "body"), [("door", "door"), ("pendulum", "b"), ("barrier", "crank")])
@settings(max_examples=12)
@given(data=st.data())
def test_angles_and_rates_that_pass_thresholds_anywhere(name: str, body: str, data: st.DataObject) -> None:
    m, vary, _ = MACHINES[name]
    measures = data.draw(measures_of(body))
    whole, short = _many(m, vary, {**measures, **WHOLE}), _many(m, vary, measures)
    for column, values in short.columns.items():
        np.testing.assert_array_equal(values, whole[column], err_msg=column)


def test_more_thresholds_than_the_loop_compares_are_looked_at_in_windows() -> None:
    m, vary, _ = MACHINES["door"]
    measures = {f"{k}": first("door.theta", below=1.5 - 0.03 * k) for k in range(MOST_PASSED + 3)}
    whole, short = _many(m, vary, {**measures, **WHOLE}), _many(m, vary, measures)
    for column, values in short.columns.items():
        np.testing.assert_array_equal(values, whole[column], err_msg=column)


def test_an_angle_needs_no_full_window(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = _steps(monkeypatch)
    vary = {"closer": {"stiffness": [30.0, 30.0]}}
    _many(door(), vary, {"moves": first("door.theta", below=math.pi / 2 - 1e-3)})
    compared = steps()
    _many(door(), vary, {"moves": first("door.x", above=-1.0)})  # known at the start
    assert (compared < steps()).all()


def test_rows_end_where_all_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = _steps(monkeypatch)
    m, vary, measures = MACHINES["door"]
    known = {name: measures[name] for name in ("shut", "speed")}
    fast = _many(m, vary, known)
    ended = steps()
    _many(m, vary, {**known, **WHOLE})
    went_on = steps()
    early = fast["shut"] < 0.5 * DURATION
    assert early.any()
    assert (ended[early] < 0.75 * went_on[early]).all()
    open_still = np.isnan(fast["shut"])
    assert open_still.any()
    assert (ended[open_still] == went_on[open_still]).all()


@pytest.mark.skipif(not COMPILED, reason="functions of the user are those of Python here")
def test_what_fails_later_has_its_measure_all_the_same() -> None:
    m = Mechanism("arm", gravity=None)
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.user_force("gale", numba.njit(lambda t, q, v: (0.0, 0.0, 5.0 if q[2] < 20.0 else math.nan)), arm)
    m.start_near(arm=1)
    there, masses = {"there": first("arm.theta", above=0.1)}, {"arm": {"mass": [1.0, 2.0]}}
    short, whole = (_many(m, masses, measures) for measures in (there, {**there, **WHOLE}))
    assert short.good.all()
    assert not whole.good.any()
    assert "gale" in str(whole.reason[0])
    assert (short["there"] > 0.05).all()


def _many(m: Mechanism, vary: dict, measures: dict[str, Measure], formulation: str = "auto", steps: int = STEPS):
    return m.simulate_many(DURATION, vary=vary, measure=measures, steps=steps, formulation=formulation, threads=1)


def _steps(monkeypatch: pytest.MonkeyPatch):
    """What gives the steps of the rows of the last call."""
    taken: list[np.ndarray] = []
    run_rows = loop.run_rows

    def noted(*arguments):
        run_rows(*arguments)
        taken.append(arguments[-1].steps.copy())

    monkeypatch.setattr(loop, "run_rows", noted)

    def last() -> np.ndarray:
        steps = np.concatenate(_of_chunks(taken))
        taken.clear()
        return steps

    return last


def _of_chunks(taken: list[np.ndarray]) -> list[np.ndarray]:
    """Steps at the end of each chunk: they only grow while a chunk goes on."""
    out: list[np.ndarray] = []
    for steps in taken:
        if out and len(out[-1]) == len(steps) and (steps >= out[-1]).all():
            out[-1] = steps
        else:
            out.append(steps)
    return out
