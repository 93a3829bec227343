"""Machines solved all at once, one by one, simulated, by functions: the same numbers; those that fail are counted."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, Tolerances, Uniform, harmonic, tolerances
from mbsd.measures import final, largest, samples
from tests.tolerancing.linkages import SIZES, four_bar, rocker_angle, switch
from tools.models import linkages


def nearly_open() -> Mechanism:
    """A four-bar whose crank may just turn: s + l is 0.3 mm less than p + q."""
    return linkages.four_bar(0.12, 0.04, 0.12, 0.0403, (0, 90), at=90)


def test_one_by_one_is_all_at_once() -> None:
    sizes = SIZES | {"P": {"y": 1e-4}, "B": {"x": 3e-5}}
    together, alone = (
        tolerances(four_bar(), sizes, largest("P.y"), n=15, steps=36, way=way) for way in ("batch", "sweep")
    )
    assert together.way == "swept all at once"
    assert alone.way == "swept one by one"
    assert alone.values == pytest.approx(together.values, abs=1e-13)
    assert alone.slopes == pytest.approx(together.slopes, abs=1e-9)


def test_masses_and_efforts_are_solved_one_by_one() -> None:
    """Without gravity and friction, the effort at constant speed is proportional to all masses at once."""
    m = four_bar(mass=0.2)
    t = tolerances(m, {name: {"mass": 0.01} for name in ("crank", "coupler", "rocker")}, largest("motor.effort"), n=9)
    assert t.way == "swept one by one"
    assert t.slopes @ np.full(3, 0.2) == pytest.approx(t.nominal, rel=1e-3)  # Euler: homogeneous of degree 1


def test_a_function_of_the_batch_gives_a_number_a_machine() -> None:
    t = tolerances(four_bar(), SIZES, lambda batch: np.ptp(batch.points["P"][:, :, 1], axis=1), n=64, steps=36)
    high, low = (
        tolerances(four_bar(), SIZES, measure, n=64, steps=36).values
        for measure in (largest("P.y"), lambda batch: batch.points["P"][:, :, 1].min(axis=1))
    )
    assert t.values == pytest.approx(high - low, abs=1e-15)


def test_the_way_counts_all_that_were_simulated_by_themselves() -> None:
    m = switch()
    m.event("late", lambda t, moment: t - 0.1)  # of Python
    asked = {"n": 4, "duration": 0.2, "steps": 4, "corners": False}
    t = tolerances(m, {"spring": {"stiffness": 18.0}}, largest("lever.omega"), **asked)
    assert t.way == "simulated, 8 one by one (event 'late': its function gets a moment, not the numbers of frames)"


def test_simulations_are_those_of_changed_mechanisms() -> None:
    t = tolerances(
        switch(), {"spring": {"stiffness": 18.0}, "lever": {"mass": 0.015}}, largest("lever.omega"), n=4, duration=0.2,
        steps=40,
    )  # fmt: skip
    assert t.way == "simulated in one compiled loop"
    m = switch()
    m.change("spring", stiffness=120.0 + t.deviations[2, 0])
    m.change("lever", mass=0.2 + t.deviations[2, 1])
    assert t.values[2] == pytest.approx(m.simulate(0.2, steps=40).body("lever").omega.max(), rel=1e-9)
    assert t.columns == ("spring.stiffness", "lever.mass")


def test_places_and_laws_stray_alike_whatever_the_way() -> None:
    """The end of a bar that strays carries along the place that strays about it."""
    sizes = {
        "crank": 5e-5,
        "B": {"x": 3e-5},
        "D": 2e-5,
        "rocker": {"C.y": 3e-5},
        "motor": {"rate": 0.1},
        "P": {"y": 1e-4},
    }
    asked: dict[str, Any] = {"n": 12, "steps": 12, "duration": 0.5}
    for result in (samples("P.y", [0.25]), largest("rocker.theta")):
        swept, simulated = (tolerances(four_bar(), sizes, result, way=way, **asked) for way in ("sweep", "simulate"))
        assert simulated.way.startswith("simulated in one compiled loop")
        assert simulated.values == pytest.approx(swept.values, abs=1e-9)
        assert simulated.columns == swept.columns == ("crank", "B.x", "D.x", "D.y", "rocker.C.y", "motor.rate", "P.y")
        assert simulated.slopes == pytest.approx(swept.slopes, abs=1e-7)
        assert np.count_nonzero(np.abs(simulated.slopes) > 1e-7) >= 6  # one number does not move what is asked for


def test_simulated_places_are_those_of_mechanisms_built_there() -> None:
    def built(x: float, y: float, torque: float) -> Mechanism:
        m = Mechanism("lever")
        lever = m.bar("lever", 0.1, mass=0.2)
        m.revolute("pivot", m.ground.at(x, y), lever.start)
        m.spring("spring", m.ground.at(0, 0.16), lever.end, stiffness=120.0, damping=0.2, free_length=0.1)
        m.torque("push", lever, harmonic(torque, 20.0))
        m.start_near(lever=80)
        return m

    sizes = {"pivot": 1e-3, "push": {"amplitude": (-0.01, 0.02)}}
    t = tolerances(built(0.0, 0.0, 0.1), sizes, largest("lever.omega"), n=8, duration=0.3, steps=30)
    assert t.columns == ("pivot.x", "pivot.y", "push.amplitude")
    for (x, y, torque), value in zip(t.deviations, t.values, strict=True):
        assert value == built(x, y, 0.1 + torque).simulate(0.3, steps=30).body("lever").omega.max()


def test_names_of_a_joint_and_a_traced_point_are_told_apart_before_anything_is_simulated() -> None:
    m = switch()
    m.trace("pivot", m.bodies["lever"].end)
    with pytest.raises(ModelError, match="'pivot' is a joint and a traced point; rename one of them"):
        tolerances(m, {"pivot": {"x": 1e-4}}, largest("lever.omega"), duration=0.1)


def test_a_function_may_build_the_mechanism() -> None:
    def build(crank: float = 0.040, coupler: float = 0.120) -> Mechanism:
        m = four_bar()
        m.change("crank", length=crank)
        m.change("coupler", length=coupler)
        return m

    sizes = {"crank": 5e-5, "coupler": 8e-5}
    asked: dict[str, Any] = {"n": 6, "steps": 10}
    result = samples("rocker.theta", [0.3])
    built, same = tolerances(build, sizes, result, **asked), tolerances(four_bar(), sizes, result, **asked)
    assert built.values == pytest.approx(same.values, abs=1e-12)
    own = tolerances(build, sizes, lambda m: m.sweep(steps=10).body("rocker").theta[3], **asked)
    assert own.values.tobytes() == built.values.tobytes()


@pytest.fixture(scope="module")
def failing() -> Tolerances:
    sizes = dict.fromkeys(("crank", "coupler", "rocker"), 2e-4)
    return tolerances(nearly_open(), sizes, samples("rocker.theta", [0.25]), limits=(1.5, 1.6), n=4000, steps=40)


def test_machines_that_do_not_close_are_counted(failing: Tolerances) -> None:
    """The crank turns if shortest and longest link are no longer than the other two."""
    crank, coupler, rocker = (np.array([0.04, 0.12, 0.0403]) + failing.deviations).T
    lengths = np.sort(np.column_stack([crank, coupler, rocker, np.full(len(crank), 0.12)]), axis=1)
    grashof = (lengths[:, 0] + lengths[:, 3] <= lengths[:, 1] + lengths[:, 2]) & (lengths[:, 0] == crank)
    assert 0 < len(failing.failed) < 200
    assert sum(failing.failures.values()) == len(failing.failed)
    assert not grashof[[k for k in failing.failed if abs(np.ptp(lengths[k, :2])) > 5e-5]].any()
    assert failing.good[grashof].mean() > 0.99
    assert not failing.good[~grashof].any()


def test_failed_mechanisms_are_not_within_the_limits(failing: Tolerances) -> None:
    assert failing.yields is not None
    assert failing.yields.part == pytest.approx(1.0 - len(failing.failed) / 4000)
    assert all(row.yield_halved > failing.yields.part for row in failing.rows)  # solved again, some close
    assert failing.corners_failed > 0
    assert f"{len(failing.failed)} failed" in repr(failing)
    for reason, count in failing.failures.items():
        assert f"{count} machines failed: {reason}" in str(failing)


def test_one_by_one_they_have_the_names_of_errors() -> None:
    t = tolerances(
        nearly_open(), dict.fromkeys(("crank", "rocker"), 3e-4), samples("rocker.theta", [0.25]), n=60, steps=40,
        way="sweep",
    )  # fmt: skip
    assert len(t.failed) == sum(t.failures.values()) > 0
    assert len(t.failures) == len({reason.partition(" (")[0] for reason in t.failures})
    assert all("Error (four_bar" in reason and reason.endswith(")") for reason in t.failures)


def test_tables_have_all_digits(tmp_path: Path) -> None:
    t = tolerances(four_bar(), SIZES, samples("rocker.theta", [0.3]), limits=(1.82, None), n=200, steps=10)
    t.to_csv(tmp_path / "rows.csv")
    t.to_csv(tmp_path / "machines.csv", machines=True)
    rows = list(csv.DictReader((tmp_path / "rows.csv").open()))
    assert [row["name"] for row in rows] == [row.name for row in t.tighten] == list(t.table()["name"])
    assert [float(row["share"]) for row in rows] == [row.share for row in t.tighten]
    assert rows[0]["sobol_first"] == ""
    machines = np.genfromtxt(tmp_path / "machines.csv", delimiter=",", names=True)
    assert machines["result"] == pytest.approx(t.values, abs=0)
    assert machines.dtype.names == ("crank", "coupler", "rocker", "Dx", "result")
    assert sum(row.share for row in t.rows) == pytest.approx(1.0)


def test_the_picture_shows_limits_and_shares(tmp_path: Path) -> None:
    exact = float(rocker_angle(0.6 * np.pi))
    t = tolerances(
        four_bar(), SIZES, samples("rocker.theta", [0.3]), limits=(exact - 3e-4, 9.0), n=500, steps=10, sobol=True
    )
    picture = t.plot()
    histogram, bars = picture.figure.axes
    assert histogram.get_xlabel() == "rocker.theta"
    assert sum(patch.get_height() for patch in histogram.patches) == 500
    assert [line.get_label() for line in histogram.lines].count("limit") == 1  # the other is far away
    assert {label.get_text() for label in bars.get_yticklabels()} == {row.name for row in t.rows}
    assert max(patch.get_width() for patch in bars.patches) == pytest.approx(100 * t.shares.max(), rel=0.05)
    for name in ("first.svg", "second.svg"):
        t.plot().save(tmp_path / name)
    assert (tmp_path / "first.svg").read_bytes() == (tmp_path / "second.svg").read_bytes()
    with pytest.raises(ModelError, match="two axes"):
        t.plot(3)


@pytest.mark.parametrize("more", [{}, {"sobol": True}, {"corners": True}])
def test_progress_rises_to_1_at_the_end_whatever_is_evaluated(more: dict[str, Any]) -> None:
    told: list[float] = []
    evaluated = 0

    def bent(a: float = 0.0, b: float = 0.0) -> float:
        nonlocal evaluated
        evaluated += 1
        return a**2 + b

    def progress(part: float) -> None:
        told.append(part)
        seen.append(evaluated)

    seen: list[int] = []
    t = tolerances(bent, {"a": 1.0, "b": 0.1}, n=3000, progress=progress, **more)
    assert t.curved  # all are solved again for each dimension
    assert told == sorted(told)
    assert len(set(told)) == len(told) > 8
    assert told[-1] == 1.0
    assert told[-2] < 1.0
    assert seen[-1] == evaluated
    assert max(np.diff([0.0, *told])) < 0.5


def test_corners_that_all_fail_have_no_worst_case() -> None:
    t = tolerances(lambda a=0.0: a if abs(a) < 2.5 else np.nan, {"a": Uniform(3.0)}, n=50)
    assert t.corners_failed == 2
    assert "unknown at the corners: all 2 of them fail" in str(t)


def test_a_function_that_fails_for_a_machine_fails_that_machine_alone() -> None:
    """A result that is no number is refused, and so is a function that fails for the given machine."""

    def root(a: float = 1.0) -> float:
        if a > 1.08:
            raise ValueError("too long")
        return a**2

    t = tolerances(root, {"a": Uniform(0.1)}, n=100)
    assert 0 < len(t.failed) == t.failures["the result fails: ValueError: too long"] < 50
    assert (t.deviations[t.failed, 0] > 0.08).all()

    def measured(sol: Any) -> float:
        return root(1.0 + 100.0 * (sol.mechanism.bodies["crank"].length - 0.04))

    own = tolerances(four_bar(), {"crank": Uniform(1e-3)}, measured, n=40, steps=4, way="sweep")
    assert 0 < len(own.failed) == (own.deviations[:, 0] > 0.8e-3).sum()
    assert own.failures == {"the result fails: ValueError: too long": len(own.failed)}
    with pytest.raises(ModelError, match="result gives 'long'; it must give a number"):
        tolerances(lambda a=1.0: "long" if a > 1.08 else a, {"a": Uniform(0.1)}, n=100)


def test_machines_without_a_number_are_counted() -> None:
    """2.3 % lie two standard deviations below the middle, where there is none."""
    t = tolerances(lambda a=0.0: a if a > -2.0 else np.nan, {"a": 3.0}, n=4000)
    assert t.failures == {"the result is no number": len(t.failed)}
    assert len(t.failed) == (t.deviations[:, 0] <= -2.0).sum()
    assert len(t.failed) / 4000 == pytest.approx(0.0228, abs=0.01)

    def coupled(batch: Any) -> np.ndarray:
        angle = batch.angles["rocker"][:, 0]
        return np.where(angle > float(rocker_angle(0.0)) - 1e-3, angle, np.inf)

    t = tolerances(four_bar(), {"coupler": 1e-4}, coupled, n=4000, steps=4)
    assert t.failures == {"the result is no number": len(t.failed)}
    assert 20 < len(t.failed) < 600
    assert np.isfinite(t.mean)


def test_exceptions_for_the_given_mechanism_are_raised() -> None:
    with pytest.raises(ModelError, match="did you mean 'rocker'"):
        tolerances(four_bar(), {"coupler": 1e-4}, lambda sol: sol.body("rockr").theta[0], n=5, way="sweep")


def test_diameters_and_radii_have_the_grade_of_their_size() -> None:
    m = Mechanism("train", gravity=None)
    rotor, wheel = m.body("rotor", mass=5.0, inertia=0.02), m.body("wheel", mass=8.0, inertia=0.05)
    m.revolute("front", m.ground.at(0, 0), rotor.origin)
    m.revolute("rear", m.ground.at(0, 0), wheel.origin)
    m.shaft("shaft", rotor, wheel, length=0.4, diameter=0.02, bore=0.01)
    m.start_moving(rotor=1.0)
    sizes = {"shaft": {"diameter": "IT7", "bore": "IT7", "length": "m"}}
    t = tolerances(m, sizes, final("wheel.theta"), duration=0.005, steps=5, n=20)
    assert [row.high for row in t.rows] == pytest.approx([21e-6 / 2, 15e-6 / 2, 0.5e-3])


@pytest.mark.filterwarnings("error")
def test_numbers_of_single_precision_are_numbers() -> None:
    t = tolerances(lambda a=1.0: a, {"a": np.float32(0.5)}, limits=(np.float32(0.0), None), n=20)
    assert t.rows[0].high == 0.5
