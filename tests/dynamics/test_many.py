"""Many simulations in one compiled loop: what can be asked, reasons, what goes by itself, threads and Ctrl-C."""

from __future__ import annotations

import math
import signal
import threading
import time
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, cycloidal
from mbsd.base.warning import quiet
from mbsd.measures import final, largest, samples
from tests.dynamics.many_models import STEPS, door, press
from tools.hunt.free_case import nudged
from tools.hunt.mixed_rows import beside_single_ones, mixed_rows
from tools.hunt.outcome import AGREED, WRONG
from tools.models import assur_models, linkages
from tools.models.stops import barrier


def test_threads_change_no_digit() -> None:
    stiffness = np.linspace(1.0, 9.0, 300)
    one_thread, four = (
        door().simulate_many(
            2.0, vary={"closer": {"stiffness": stiffness}}, measure={"x": final("door.theta")}, steps=400, threads=n
        )
        for n in (1, 4)
    )
    assert one_thread.alone == [None] * 300
    assert np.array_equal(one_thread["x"], four["x"])


def test_rows_that_fail_carry_a_reason_and_do_not_stop_the_others() -> None:
    many = door().simulate_many(
        1.0, vary={"closer": {"damping": [4.0, -1.0, 5.0]}}, measure={"x": final("door.theta")}, steps=STEPS
    )
    assert many.good.tolist() == [True, False, True]
    assert "cannot be negative" in str(many.reason[1])
    assert np.isnan(many["x"]).tolist() == [False, True, False]
    assert many["x"][2] == door(5.0, 5.0).simulate(1.0, steps=STEPS).body("door").theta[-1]


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"vary": {"closr": {"stiffness": [1.0]}}}, "did you mean 'closer'"),
        ({"vary": {"closer": {"stifness": [1.0]}}}, "did you mean 'stiffness'"),
        ({"vary": {"hinge": {"z": [1.0]}}}, "vary: 'hinge': there is no number 'z'; there is: x, y, angle"),
        ({"vary": {"closer": {"stiffness": [1.0, 2.0], "damping": [1.0, 2.0, 3.0]}}}, "equally long"),
        ({"vary": {"closer": {"stiffness": []}}}, "no values"),
        ({"vary": {"closer": {"stiffness": ["stiff"]}}}, "must be a number"),
        ({"vary": {"closer": {"stiffness": [math.nan]}}}, "must be finite"),
        ({"vary": {"closer": [1.0]}}, "give its numbers"),
        ({"vary": None}, "nothing varies"),
        ({"start": {"dor": [1.0]}}, "did you mean 'door'"),
        ({"moving": {"ground": [1.0]}}, "ground does not move"),
        ({"start": {"door": [[1.0, 2.0]]}}, "give \\(n,\\) or"),
        ({"measure": {"x": "door.theta"}}, "must be a measure"),
        ({"measure": {"x": final("door.thta")}}, "did you mean 'door.theta'"),
        ({"measure": {"x": samples("door.theta", [0.33])}}, "is no output"),
        ({"measure": {"x": largest("door.x"), "x_time": final("door.x")}}, "two columns"),
        ({"measure": lambda sol: {"x": "text"}}, "door: measure gives 'text' as 'x'; it must be a number under a name"),
        ({"measure": lambda sol: {"x": 1j}}, "must be a number under a name"),
        ({"measure": lambda sol: {}}, "door: measure gives {}; it must give names and numbers"),
        ({"measure": lambda: {"x": 1.0}}, "door: measure must be a function of a solution"),
        (
            {"measure": lambda sol: {"x": sol.body("dor").x[-1]}},
            "door: measure fails for the first simulation: .*'dor'",
        ),
        (
            {"measure": lambda sol: {"x": sol.bodies["door"]}},
            r"measure fails for the first simulation: .* no attribute 'bodies', did you mean 'body'",
        ),
        ({"vary": {"closer": {3: [1.0]}}}, "give its numbers"),
        ({"vary": {"closer": {"stiffness": [[1.0, 2.0], [3.0, 4.0]]}}}, r"a single number, .* give \(2,\)"),
        ({"vary": {"closer": {"stiffness": np.broadcast_to(1.0, 10**12)}}}, "take 100000000 at most"),
        ({"start": {"door": np.broadcast_to(1.0, 10**12)}}, "take 100000000 at most"),
        ({"duration": 0.0}, "must be positive"),
        ({"steps": 0}, "above zero"),
        ({"threads": 0}, "above zero"),
        ({"tolerance": 5.0}, "tolerance is 5"),
        ({"method": "dop835"}, "did you mean"),
        ({"method": "rk4", "formulation": "independent"}, "method 'rk4' works in reference coordinates"),
        (
            {"vary": {"closer": {"name": [1.0, 2.0]}}},
            "vary: 'closer': there is no number 'name'; there is: stiffness",
        ),
        ({"progress": lambda: None}, "progress must be a function of the part done, 0 .. 1: too many"),
    ],
)
def test_what_cannot_be_asked_is_refused(asked: dict, words: str) -> None:
    usual = {"duration": 1.0, "vary": {"closer": {"stiffness": [1.0, 2.0]}}, "measure": {"x": final("door.theta")}}
    with pytest.raises(ModelError, match=words):
        door().simulate_many(**{**usual, "steps": 10, **asked})


def test_progress_is_the_part_done_and_what_it_raises_ends_all() -> None:
    parts: list[float] = []
    vary = {"closer": {"stiffness": np.linspace(1.0, 2.0, 200)}}
    door().simulate_many(1.0, vary=vary, measure={"x": final("door.theta")}, steps=400, progress=parts.append)
    assert parts == sorted(parts)
    assert parts[-1] == 1.0

    def stop(part: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        door().simulate_many(1.0, vary=vary, measure={"x": final("door.theta")}, steps=400, progress=stop)
    with pytest.raises(ZeroDivisionError):  # it is no error of a simulation
        door().simulate_many(1.0, vary=vary, measure={"x": final("door.theta")}, steps=400, progress=lambda part: 1 / 0)


def test_a_long_simulation_by_itself_ends_when_all_are_to_end() -> None:
    """A thread of the interpreter sends Ctrl-C while a row that would take minutes is under way in another one."""
    sender = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
    m = door()
    m.change("closer", stiffness=1e6, damping=0.0)
    sender.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        m.simulate_many(
            1e5, start={"door": [30.0, 40.0]}, measure=lambda sol: {"x": sol.body("door").theta[-1]}, steps=1
        )
    assert time.monotonic() - begun < 20.0


def test_threads_that_silence_warnings_leave_them_as_they_were() -> None:
    before, both = list(warnings.filters), threading.Barrier(2)

    def run(first: bool) -> None:
        with quiet():
            both.wait()
            if first:
                both.wait()
        if not first:
            both.wait()

    threads = [threading.Thread(target=run, args=(first,)) for first in (True, False)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert list(warnings.filters) == before


def test_all_rows_may_fail_and_columns_are_there() -> None:
    many = door().simulate_many(
        1.0, vary={"closer": {"damping": [-1.0, -2.0]}}, measure={"x": samples("door.theta", [0.5, 1.0])}, steps=4
    )
    assert not many.good.any()
    assert np.isnan(many["x"]).all()
    assert many["x"].shape == (2, 2)
    with pytest.raises(ModelError, match="there is no column 'X'"):
        _ = many["X"]


def test_a_mechanism_that_cannot_start_itself_serves_if_its_rows_can() -> None:
    m = barrier()
    m.start_near(crank=0, coupler=45, rocker=90)
    m.change("coupler", length=1.4)
    many = m.simulate_many(
        0.2, vary={"coupler": {"length": [1.4, 0.38]}}, measure={"x": final("rocker.theta")}, steps=4
    )
    assert "do not close" in str(many.reason[0])
    assert many["x"][1] == barrier().simulate(0.2, steps=4).body("rocker").theta[-1]


def test_rows_do_not_depend_on_those_before_them() -> None:
    """A longer bar takes along what is at its end, and only that."""

    def with_point() -> Mechanism:
        m = barrier()
        m.trace("Q", m.bodies["coupler"].at(0.39, 0.0))
        return m

    vary, measure = {"coupler": {"length": [0.38, 0.39, 0.385]}, "C": {"y": [0.0, 1e-3, 0.0]}}, {"x": final("Q.x")}
    many = with_point().simulate_many(0.1, vary=vary, measure=measure, steps=4)
    last = {name: {key: values[-1:] for key, values in own.items()} for name, own in vary.items()}
    assert with_point().simulate_many(0.1, vary=last, measure=measure, steps=4)["x"][0] == many["x"][2]


def test_numbers_that_a_row_refuses_are_its_reason() -> None:
    m = Mechanism("lift", gravity=None)
    arm = m.bar("arm", 0.2, mass=1.0)
    m.revolute("pivot", m.ground.at(0, 0), arm.start)
    m.torque("motor", arm, cycloidal(0.5, 0.2))
    many = m.simulate_many(0.3, vary={"motor": {"duration": [0.2, -0.1, 0.1]}}, measure={"x": final("arm.theta")})
    assert many.good.tolist() == [True, False, True]
    assert "duration is -0.1 s; it must be positive" in str(many.reason[1])
    many = press().simulate_many(0.1, vary={"O": {"y": [0.0, 0.5]}}, measure={"x": final("P.x")}, steps=4)
    assert many.good.tolist() == [True, False]
    assert "AssemblyError" in str(many.reason[1])


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"vary": {"O": {"z": [1.0]}}}, "vary: 'O': there is no number 'z'; there is: x, y, angle"),
        ({"vary": {"O.x": [1.0]}}, r"give its numbers and their values: \{'O': \{'x': \[...\]\}\}"),
        ({"vary": {"O": {"x": [math.inf]}}}, "must be finite"),
        ({"vary": {"O": {"x": [[0.0, 1.0]]}}}, "x of 'O' is a single number"),
        ({"vary": {"O": {"x": [0.0, 1.0], "y": [0.0, 1.0, 2.0]}}}, "y of 'O' has 3 values|equally long"),
        ({"vary": {"motor": {"law": [1.0, 2.0]}}}, r"is a law and no number; .* \{'motor': \{'amplitude': \[...\]\}\}"),
        ({"vary": {"motor": {"rat": [1.0]}}}, "did you mean 'rate'"),
        ({"vary": {"rod": {"com": [[0.1, 0.0]], "com.x": [0.1]}}}, "'com.x' is a part of 'com'"),
        ({"vary": {"O": {"x": [0.1], "i.x": [0.1]}}}, "'O.x' and 'O.i.x' are the same number"),
        ({"vary": {"crank": {"start.angle": [0.1]}}}, "driver 'motor' says where 'crank' is"),
        ({"vary": {"hand": {"start.angle": [0.1]}}, "start": {"hand": [5.0]}}, "also given by start="),
        ({"vary": {"hand": {"moving.omega": [0.1]}}}, "no such number before start_moving gives it"),
        ({"vary": {"ground": {"x": [0.1]}}}, "there is no number 'x'"),
    ],
)
def test_what_cannot_vary_is_refused(asked: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        press().simulate_many(0.1, measure={"x": final("P.x")}, **asked)


def test_a_method_of_python_and_a_step_without_solution_say_why_they_are_by_themselves() -> None:
    asked = {"vary": {"closer": {"stiffness": [4.0, 8.0]}}, "measure": {"x": final("door.theta")}, "steps": 4}
    assert "'scipy-radau' has no loop over many" in door().simulate_many(0.5, method="scipy-radau", **asked).way
    many = door().simulate_many(
        40.0, vary={"closer": {"stiffness": [4.0, 4e6]}}, measure=asked["measure"], steps=4, method="rk4", step=1.0
    )
    assert many.good.tolist() == [True, False]
    assert "the equations of a step of 1 s have no solution" in str(many.reason[1])
    assert many.alone == [None, "the equations of a step had no solution"]


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
