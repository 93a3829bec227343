"""The table at the end of make run-all: every run in a row, with its numbers if it was done."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from render.report import facts
from render.report.facts import fastest
from shared.contract import Provenance, read_motion
from shared.contract.clearance import Clearance, PairClearance, write_clearance
from shared.contract.loads import ForceMotion
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion

MOTION = four_bar_motion()


@pytest.fixture
def four_bar_files(out_root: Path) -> None:
    """A four-bar with all its files."""
    out = film_fixture.write()
    pair = PairClearance(
        bodies=("crank", "coupler"), pieces=("a", "b"), gap=1.25e-4, proven=1.2e-4, time=0.0, proof="motion", poses=9
    )
    write_clearance(
        out.clearance,
        Clearance(
            mechanism="four_bar", provenance=Provenance(inputs="0" * 64, versions={}), limit=5e-5, resolution=5e-6,
            interpolation_error=0.0, pairs=[pair], apart=3,
        ),
    )  # fmt: skip


@pytest.mark.usefixtures("four_bar_files")
def test_a_row_has_the_numbers_of_what_was_done(capsys: pytest.CaptureFixture[str]) -> None:
    facts.run(["four_bar 125 done\n", "broken 3 failed\n", "cleaned 1 done\n"])
    said = capsys.readouterr().out.splitlines()
    rows = {line.split()[0]: line for line in said if line.split()}
    assert rows["mechanism"].split("  ")
    four_bar = rows["four_bar"]
    assert "2 min 05 s" in four_bar
    for word in ("m/s (", "N·m (motor)", "125 µm", "done"):
        assert word in four_bar
    assert rows["broken"].split() == ["broken", "3.0", "s", "failed"]
    assert rows["cleaned"].split() == ["cleaned", "1.0", "s", "done"]
    assert max(map(len, said)) <= facts.WIDTH


@pytest.mark.usefixtures("four_bar_files")
def test_results_of_a_failed_run_are_left_out() -> None:
    assert facts.row_of("four_bar 2 failed") == ["four_bar", "2.0 s", "", "", "", "", "failed"]


def test_the_fastest_place_counts_centres_of_mass(out_root: Path) -> None:
    """A bar turns about its frame, which stands still: its centre of mass moves at omega times its radius."""
    motion = read_motion(film_fixture.write().motion)
    crank = motion.bodies["crank"]
    motion.bodies, motion.points, motion.joints = {"crank": crank}, {}, {}
    crank.com = (3.0, 4.0)
    name, speed = fastest(motion)
    assert (name, speed) == ("crank", pytest.approx(5.0 * float(np.abs(crank.omega).max())))


def test_rounding_is_no_effort() -> None:
    [(name, driver)] = MOTION.drivers.items()
    noise = msgspec.structs.replace(driver, effort=[2e-18 * (-1) ** k for k in range(len(driver.effort))])
    idle = msgspec.structs.replace(MOTION, drivers={name: noise})
    assert facts.largest_effort(idle) == f"0 N·m ({name})"
    small = msgspec.structs.replace(driver, effort=[1e-7 for _ in driver.effort])
    assert facts.largest_effort(msgspec.structs.replace(MOTION, drivers={name: small})) == f"100 nN·m ({name})"


def test_a_driver_that_pushes_by_nothing_leaves_the_place_to_a_motor() -> None:
    """As in inverse dynamics, where the driver gives the motion and a motor's torque makes it."""
    count = len(MOTION.time)
    zeros = [0.0] * count
    motor = ForceMotion(
        kind="torque", actions=[], several=False, measures="angle", value=zeros, rate=zeros,
        effort=[0.02, -0.5, *zeros[2:]], normal=None, power=zeros, potential=zeros, shape=None,
        effort_unit="N m", drives=True,
    )  # fmt: skip
    [(name, driver)] = MOTION.drivers.items()
    idle = msgspec.structs.replace(driver, effort=zeros)
    moved = msgspec.structs.replace(MOTION, drivers={name: idle}, forces={"turner": motor})
    assert facts.largest_effort(moved) == "500 mN·m (turner)"
    assert facts.largest_effort(msgspec.structs.replace(MOTION, forces={"turner": motor})).endswith(f"({name})")
    still = msgspec.structs.replace(motor, effort=zeros)
    assert facts.largest_effort(msgspec.structs.replace(moved, forces={"turner": still})) == f"0 N·m ({name})"
