"""Studies of simulations: one compiled loop where mechanisms differ in numbers alone, and single ones agree."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mbsd import Mechanism, ModelError, Simulated, constant_rate, simulated, study
from mbsd.measures import final, first, largest, samples
from mbsd.studies.numbers_alone import MoreThanNumbers, differences

MEASURES = {"end": final("leaf.theta"), "fast": largest("leaf.omega"), "on": samples("leaf.theta", [0.5, 1.0])}


def door(
    stiffness: float = 5.0,
    damping: float = 2.0,
    turn: float = 1.0,
    mass: float = 30.0,
    degrees: float = 90.0,
    length: float = 0.9,
):
    m = Mechanism("door", gravity=None)
    leaf = m.bar("leaf", length, mass=mass)
    m.revolute("hinge", m.ground.at(0, 0), leaf.start)
    m.torsion_spring("closer", m.ground, leaf, stiffness, damping, free_angle=-turn / stiffness)
    m.start_near(leaf=degrees)
    m.start_moving(leaf=0.1)
    return m


GRID = {"stiffness": np.linspace(2.0, 9.0, 4), "damping": [1.0, 3.0], "turn": [0.5, 1.0, 1.5]}


def _studied(grid: dict, measure: Simulated, build: Callable[..., Mechanism] = door) -> pd.DataFrame:
    return study(build, grid, measure, folder=None, processes=1, progress=False)


def _shut_at(angle: float) -> Simulated:
    return simulated({"end": first("leaf.theta", below=angle)}, 4.0, steps=40)


def test_numbers_are_those_of_single_simulations() -> None:
    table = _studied(GRID, simulated(MEASURES, 1.0, steps=20))
    assert table.attrs["way"] == "in one compiled loop"
    assert table["reason"].isna().to_numpy().all()
    for _, row in table.iloc[::5].iterrows():
        sol = door(*row[list(GRID)].astype(float)).simulate(1.0, steps=20)
        leaf = sol.body("leaf")
        assert row["end"] == leaf.theta[-1]
        assert [row["on_0"], row["on_1"]] == leaf.theta[[10, 20]].tolist()
        assert row["fast"] == leaf.omega.max()
        assert row["fast_time"] == sol.t[leaf.omega.argmax()]


def test_processes_and_what_is_kept_change_nothing(tmp_path: Path) -> None:
    asked = _shut_at(0.5)
    alone = _studied(GRID, asked)
    kept = study(door, GRID, asked, folder=tmp_path, processes=2, progress=False)
    again = study(door, GRID, asked, folder=tmp_path, processes=1, progress=False)
    np.testing.assert_array_equal(alone["end"], kept["end"])
    np.testing.assert_array_equal(kept["end"], again["end"])
    assert alone["end"].notna().to_numpy().any()
    earlier = study(door, GRID, _shut_at(0.6), folder=tmp_path, processes=1, progress=False)["end"].to_numpy()
    shut = alone["end"].notna().to_numpy()
    assert (earlier < alone["end"].to_numpy())[shut].all(), "another level is another study"


@pytest.mark.parametrize(
    ("grid", "why"),
    [
        ({"length": np.linspace(0.5, 1.0, 12)}, "neither of a force nor a mass"),
        ({"mass": np.linspace(20.0, 30.0, 12)}, "speeds at the start are found with the masses"),
        ({"degrees": np.linspace(50.0, 91.0, 12)}, "neither of a force nor a mass"),
        ({"stiffness": [5.0] * 12}, "the same mechanism"),
    ],
)
def test_other_differences_run_as_built_and_are_reported(grid: dict, why: str) -> None:
    table = _studied(grid, simulated({"end": final("leaf.theta")}, 0.5, steps=10))
    assert table.attrs["way"].startswith("in one compiled loop, each is prepared anew")
    assert why in table.attrs["way"]
    for _, row in table.iterrows():
        point = {name: float(row[name]) for name in grid}
        assert row["end"] == door(**point).simulate(0.5, steps=10).body("leaf").theta[-1]


def flap(mass: float = 2.0, inertia: float = 0.3, com: float = 0.2, degrees: float = 60.0, omega: float = 0.0):
    m = Mechanism("flap")
    leaf = m.body("leaf", mass=mass, inertia=inertia, com=(com, 0.01))
    rod, arm = m.bar("rod", 0.5, mass=0.3 * mass), m.bar("arm", 0.4, mass=0.2)
    m.revolute("hinge", m.ground.at(0, 0), leaf.origin)
    m.revolute("B", leaf.at(0.3, 0), rod.start)
    m.revolute("C", rod.end, arm.start)
    m.revolute("D", arm.end, m.ground.at(0.6, 0.1))
    m.torsion_spring("closer", m.ground, leaf, 2.0, 0.1)
    m.start_near(leaf=degrees, rod=0, arm=-60)
    if omega:
        m.start_moving(leaf=omega)
    return m


@pytest.mark.parametrize(
    ("grid", "way"),
    [
        ({"mass": np.linspace(1.0, 3.0, 6), "inertia": [0.2, 0.3, 0.5]}, "in one compiled loop"),
        ({"mass": np.linspace(1.0, 3.0, 6), "omega": [1.0, 2.0, 3.0]}, "prepared anew"),
        ({"degrees": np.linspace(40.0, 70.0, 9), "com": [0.1, 0.2]}, "prepared anew"),
    ],
)
def test_digits_do_not_follow_from_which_points_go_together(grid: dict, way: str) -> None:
    measures = {"x": final("leaf.theta"), "a": largest("arm.alpha"), "f": largest("D.fx"), "s": largest("hinge.fy")}
    asked = simulated(measures, 0.4, steps=12)
    whole = _studied(grid, asked, flap)
    assert way in whole.attrs["way"]
    assert whole["reason"].isna().to_numpy().all()
    names = list(grid)
    points = whole[names].to_dict("records")
    for some in (range(17, -1, -1), range(0, 18, 2), [3, 5], [7]):
        part = _studied([points[k] for k in some], asked, flap)  # pyright: ignore[reportArgumentType]
        np.testing.assert_array_equal(part[list(measures)], whole[list(measures)].iloc[list(some)])
    alone = flap(**{str(name): value for name, value in points[4].items()}).simulate(0.4, steps=12)
    assert whole["x"].iloc[4] == alone.body("leaf").theta[-1]
    assert whole["a"].iloc[4] == alone.body("arm").alpha.max()


def test_structures_are_simulated_beside_each_other_and_what_cannot_start_has_its_reason() -> None:
    def build(spring: bool, length: float) -> Mechanism | None:
        if length > 2.0:
            return None
        m = door()
        arm = m.bar("arm", length, mass=1.0)
        m.revolute("elbow", m.bodies["leaf"].end, arm.start)
        m.revolute("wall", arm.end, m.ground.at(0.0, 1.4))
        if spring:
            m.torsion_spring("second", m.ground, m.bodies["leaf"], 1.0, 0.0)
        m.start_near(leaf=90, arm=60)
        m.start_moving(leaf=0.0)
        return m

    grid = {"spring": [False, True], "length": [0.2, 0.6, 0.7, 3.0]}
    table = _studied(grid, simulated({"end": final("leaf.theta")}, 0.3, steps=4), build)  # pyright: ignore[reportArgumentType]
    assert table["reason"].notna().tolist() == [True, False, False, True] * 2
    assert "do not close" in table["reason"].iloc[0]
    assert "must give a Mechanism" in table["reason"].iloc[3]
    for k in (1, 2, 5, 6):
        m = build(bool(table["spring"].iloc[k]), float(table["length"].iloc[k]))
        assert m is not None
        assert table["end"].iloc[k] == m.simulate(0.3, steps=4).body("leaf").theta[-1]
    none = _studied({"spring": [True], "length": [0.2]}, simulated({"end": final("leaf.theta")}, 0.3, steps=4), build)  # pyright: ignore[reportArgumentType]
    assert "do not close" in none["reason"].iloc[0]


def test_another_structure_is_more_than_numbers() -> None:
    def either(spring: bool) -> Mechanism:
        m = door()
        if spring:
            m.torsion_spring("second", m.ground, m.bodies["leaf"], 1.0, 0.0)
        return m

    with pytest.raises(MoreThanNumbers, match="more than numbers"):
        differences([either(False), either(True)])

    def driven(rate: float) -> Mechanism:
        m = door()
        m.drive_angle("motor", m.bodies["leaf"], constant_rate(rate))
        return m

    with pytest.raises(MoreThanNumbers, match="neither of a force nor a mass"):
        differences([driven(1.0), driven(2.0)])


def test_differences_are_arguments_of_simulate_many() -> None:
    changes = differences([door(5.0, 2.0), door(6.0, 2.0)])
    np.testing.assert_array_equal(changes["closer"]["stiffness"], [5.0, 6.0])
    np.testing.assert_array_equal(changes["closer"]["free_angle"], [-1.0 / 5.0, -1.0 / 6.0])
    assert changes.keys() == {"closer"}
    assert changes["closer"].keys() == {"stiffness", "free_angle"}
    masses = differences([flap(2.0, 0.3), flap(2.5, 0.4)])
    np.testing.assert_array_equal(masses["leaf"]["inertia"], [0.3, 0.4])
    np.testing.assert_array_equal(masses["rod"]["mass"], [0.6, 0.75])


def test_points_that_fail_have_reasons_and_stop_no_other() -> None:
    def build(damping: float) -> Mechanism:
        if damping > 2.5:
            raise ValueError("no such oil")
        return door(damping=damping)

    grid = {"damping": [*np.linspace(0.5, 2.0, 11), -1.0, 3.0]}
    table = _studied(grid, simulated({"end": final("leaf.theta")}, 0.5, steps=5), build)
    assert table["reason"].isna().tolist() == [True] * 11 + [False, False]
    assert "cannot be negative" in table["reason"].iloc[11]
    assert "no such oil" in table["reason"].iloc[12]
    assert table["end"].isna().to_numpy().sum() == 2


def test_it_measures_a_mechanism_by_itself_and_refuses_what_is_no_measure() -> None:
    numbers = simulated({"end": final("leaf.theta")}, 0.5, steps=5)(door())
    assert numbers == {"end": door().simulate(0.5, steps=5).body("leaf").theta[-1]}
    with pytest.raises(ModelError, match="give names and measures"):
        simulated({"end": math.pi}, 0.5)  # pyright: ignore[reportArgumentType]
    with pytest.raises(ModelError, match="there is no quantity"):
        simulated({"end": final("leaf.thetta")}, 0.5)(door())


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (simulated({"end": final("leaf.theta")}, -1.0), "duration is -1.0 s; it must be positive"),
        (simulated({"end": final("leaf.theta")}, 1.0, method="dop835"), "did you mean 'dop853'"),
        (simulated({"end": final("leaf.thetta")}, 1.0), "did you mean 'leaf.theta'"),
        (simulated({"end": samples("leaf.theta", [0.33])}, 1.0, steps=10), "is no output"),
        (simulated({"reason": final("leaf.theta")}, 1.0), "two columns 'reason'"),
    ],
)
def test_impossible_measures_are_refused_before_anything_is_built(asked: Simulated, words: str) -> None:
    built = []

    def build(stiffness: float) -> Mechanism:
        built.append(stiffness)
        return door(stiffness)

    with pytest.raises(ModelError, match=words):
        _studied({"stiffness": np.linspace(1.0, 2.0, 50)}, asked, build)
    assert len(built) == 1
