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
        ({"length": np.linspace(0.5, 1.0, 12)}, "differ"),
        ({"mass": np.linspace(20.0, 30.0, 12)}, "numbers differ that are none of a force"),
        ({"degrees": np.linspace(50.0, 91.0, 12)}, "numbers differ that are none of a force"),
        ({"stiffness": [5.0] * 12}, "the same mechanism"),
    ],
)
def test_what_differs_otherwise_goes_one_by_one_and_says_so(grid: dict, why: str) -> None:
    table = _studied(grid, simulated({"end": final("leaf.theta")}, 0.5, steps=10))
    assert table.attrs["way"].startswith("one by one")
    assert why in table.attrs["way"]
    for _, row in table.iterrows():
        point = {name: float(row[name]) for name in grid}
        assert row["end"] == door(**point).simulate(0.5, steps=10).body("leaf").theta[-1]


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

    with pytest.raises(MoreThanNumbers, match="none of a force"):
        differences([driven(1.0), driven(2.0)])


def test_differences_are_arguments_of_simulate_many() -> None:
    changes = differences([door(5.0, 2.0), door(6.0, 2.0)])
    np.testing.assert_array_equal(changes["closer"]["stiffness"], [5.0, 6.0])
    np.testing.assert_array_equal(changes["closer"]["free_angle"], [-1.0 / 5.0, -1.0 / 6.0])
    assert changes.keys() == {"closer"}
    assert changes["closer"].keys() == {"stiffness", "free_angle"}


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
