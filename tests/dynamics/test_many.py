"""Many simulations in one compiled loop: the numbers of single ones, whatever varies; reasons; what goes by itself."""

from __future__ import annotations

import math
import signal
import threading
import time
import warnings
from collections.abc import Callable

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError
from mbsd.base.quiet import quiet
from mbsd.compiling.jit import COMPILED
from mbsd.measures import final, largest, samples, smallest
from mbsd.model.force import ForceKind
from mbsd.testing.kinds import force_kinds
from tests.dynamics.many_models import STEPS, door, pendulum
from tools.models.random_linkages import linkage
from tools.models.stops import barrier


def test_random_machines_have_the_digits_of_single_simulations() -> None:
    for seed in range(6):
        formulation = ("auto", "reference")[seed % 2]
        rng, count = np.random.default_rng(seed), 4
        m = linkage(seed, 1 + seed % 2, damping=bool(seed % 2)).m
        body, joint = list(m.bodies)[1], next(iter(m.joints))
        vary = {body: {"mass": rng.uniform(0.5, 2.0, count)}}
        for force in m.forces.values():
            for key in ("stiffness", "damping"):
                if isinstance(force.given.get(key), float):
                    vary[force.name] = {key: force.given[key] * rng.uniform(0.7, 1.3, count)}
        measures = {
            "x": samples(f"{body}.x", [0.25, 0.5]),
            "a": final(f"{body}.ax"),
            "r": largest(f"{joint}.fx"),
            "w": final("work"),
            "e": smallest("kinetic"),
        }
        many = m.simulate_many(0.5, vary=vary, measure=measures, steps=STEPS, formulation=formulation)
        for k in range(count):
            alone = linkage(seed, 1 + seed % 2, damping=bool(seed % 2)).m
            for name, values in vary.items():
                alone.change(name, **{key: float(column[k]) for key, column in values.items()})
            sol = alone.simulate(0.5, steps=STEPS, formulation=formulation)
            assert many["x"][k].tolist() == [sol.body(body).x[10], sol.body(body).x[20]]
            assert many["a"][k] == sol.body(body).ax[-1]
            np.testing.assert_allclose(many["r"][k], sol.joint(joint).fx.max(), rtol=1e-12)
            assert sol.work is not None
            assert many["w"][k] == sol.work[-1]
            np.testing.assert_allclose(many["e"][k], sol.energy.kinetic.min(), rtol=1e-12)


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


def test_lengths_are_prepared_row_by_row_and_traces_follow() -> None:
    lengths = np.array([0.35, 0.38, 0.4])
    m = barrier()
    m.trace("P", m.bodies["coupler"].end)
    many = m.simulate_many(
        0.3, vary={"coupler": {"length": lengths}}, measure={"x": final("P.x"), "f": largest("D.fy")}, steps=STEPS
    )
    assert "prepared" in many.way
    for k, length in enumerate(lengths):
        alone = barrier()
        alone.trace("P", alone.bodies["coupler"].end)
        alone.change("coupler", length=float(length))
        sol = alone.simulate(0.3, steps=STEPS)
        assert many["x"][k] == sol.point("P").x[-1]
        np.testing.assert_allclose(many["f"][k], sol.joint("D").fy.max(), rtol=1e-12)


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


def test_what_is_left_to_events_is_simulated_by_itself_and_says_so() -> None:
    def ended() -> Mechanism:
        m = barrier(stops=True)
        m.event("late", lambda t, moment: t - 0.3)
        return m

    damping = np.array([0.2, 0.5])
    many = ended().simulate_many(
        0.5, vary={"spring": {"damping": damping}}, measure={"angle": final("rocker.theta")}, steps=STEPS
    )
    assert "one by one (event 'late'" in many.way
    for k in range(2):
        m = ended()
        m.change("spring", damping=float(damping[k]))
        assert many["angle"][k] == m.simulate(0.5, steps=STEPS).body("rocker").theta[-1]


@pytest.mark.parametrize("compiled", [True, False])
def test_functions_of_the_user_take_part_if_they_are_compiled(compiled: bool) -> None:
    def wind(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
        return 0.2 * math.sin(3.0 * t), 0.0, -0.1 * v[2]

    def with_wind(mass: float) -> Mechanism:
        m = pendulum()
        m.user_force("wind", function, m.bodies["b"])
        m.change("a", mass=mass)
        return m

    function: Callable = numba.njit(wind) if compiled and COMPILED else wind
    masses = np.linspace(0.5, 1.5, 3)
    many = with_wind(1.0).simulate_many(0.5, vary={"a": {"mass": masses}}, measure={"x": final("P.x")}, steps=STEPS)
    assert ("compiled loop" in many.way) == (function is not wind)
    assert ("numba.njit" in many.way) == (function is wind)
    assert many["x"].tolist() == [with_wind(mass).simulate(0.5, steps=STEPS).point("P").x[-1] for mass in masses]


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
        ({"measure": lambda sol: {"x": sol.bodies["door"]}}, "measure fails for the first simulation: AttributeError"),
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


def example(kind: ForceKind) -> Mechanism | None:
    """Two bodies with a force of a kind between two others; None where it cannot start."""
    m = Mechanism("example")
    a, b = m.bar("a", 1.0, mass=1.0), m.bar("b", 0.8, mass=0.7)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.spring("first", m.ground.at(0.5, 1.0), b.at(0.5, 0.1), 20.0, 0.1, free_length=1.0)
    assert kind.example is not None
    try:
        kind.example(m, a.at(0.3, 0.1), b.at(0.2, -0.1))
    except ModelError:
        return None
    m.torsion_spring("last", m.ground, a, 3.0, 0.2)
    m.start_near(a=-40, b=-80)
    return m


@pytest.mark.parametrize("kind", [kind for kind in force_kinds() if kind.example is not None], ids=lambda k: k.name)
def test_all_kinds_of_forces_have_the_digits_of_single_simulations(kind: ForceKind) -> None:
    m = example(kind)
    if m is None or kind.of_reactions:
        pytest.skip("its example needs another joint")
    vary: dict[str, dict[str, list[float]]] = {
        "a": {"mass": [1.0, 1.3]}, "first": {"stiffness": [25.0, 14.0]}, "last": {"damping": [0.2, 0.1]}
    }  # fmt: skip
    for name, force in m.forces.items():
        numbers = [key for key, value in force.given.items() if isinstance(value, float) and value]
        if name not in vary and numbers:
            vary[name] = {numbers[0]: [force.given[numbers[0]], 1.02 * force.given[numbers[0]]]}
    many = m.simulate_many(0.1, vary=vary, steps=4, measure={"x": final("b.x"), "f": final("A.fx")})
    for k in range(2):
        alone = example(kind)
        assert alone is not None
        for name, values in vary.items():
            alone.change(name, **{key: column[k] for key, column in values.items()})
        sol = alone.simulate(0.1, steps=4)
        assert many.reason[k] is None
        assert many["x"][k] == sol.body("b").x[-1]
        np.testing.assert_allclose(many["f"][k], sol.joint("A").fx[-1], rtol=1e-9)


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


@pytest.mark.parametrize("damping", [{"damping": 10.0}, {"restitution": 0.5}])
def test_contacts_by_penalty_bounce_as_in_single_simulations(damping: dict[str, float]) -> None:
    def ball(mass: float = 1.0, height: float = 0.5) -> Mechanism:
        m = Mechanism("ball")
        body = m.body("ball", mass=mass, inertia=0.1)
        m.contact("floor", m.ground.at(0, 0), body.at(0, 0), radius=0.1, stiffness=1e4, **damping)
        m.start_near(ball=(0.0, height, 0.0))
        return m

    masses, heights = [1.0, 2.0, 0.5], [0.3, 0.5, 0.9]
    many = ball().simulate_many(
        1.0,
        vary={"ball": {"mass": masses}},
        start={"ball": np.column_stack([np.zeros(3), heights, np.zeros(3)])},
        measure={"y": final("ball.y"), "fast": largest("ball.vy")},
        steps=30,
    )
    assert many.alone == [None] * 3
    assert many.note is None
    for k in range(3):
        sol = ball(masses[k], heights[k]).simulate(1.0, steps=30)
        assert many["y"][k] == sol.body("ball").y[-1]
        assert many["fast"][k] == sol.body("ball").vy.max()
