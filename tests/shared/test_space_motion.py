"""data.json of mechanisms in space: read back as written, planar files known from it, hostile ones raise an error."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mbsd.spatial import Mechanism, constant_rate, harmonic
from mechanisms.stages.solve.space.motion_file import to_motion3
from shared import contract
from shared.stage import jsonfile
from shared.stage.errors import UserError
from tools.models.motions import four_bar_motion


def motion(steps: int = 24) -> contract.Motion3:
    """Return a crank that turns about a slanted axis and pushes a mass on a rail, with a spring and a traced point."""
    m = Mechanism("slanted", gravity=(0, 0, -9.81))
    crank = m.rod("crank", (0, 0, 0), (0.1, 0, 0.1), mass=0.3, radius=0.01)
    slider = m.body("slider", mass=0.2, inertia=(1e-4, 2e-4, 2e-4), at=(0.5, 0, 0))
    m.revolute("shaft", m.ground, crank, at=(0, 0, 0), axis=(1, 0, 1))
    m.prismatic("rail", m.ground, slider, at=(0.5, 0, 0), axis=(1, 0, 0))
    m.spring("spring", crank, slider, start=(0.1, 0, 0.1), end=(0.5, 0, 0), stiffness=40.0, length=0.3)
    m.drive_turn("motor", "shaft", constant_rate(2 * math.pi))
    m.drive_slide("push", "rail", harmonic(0.05, 2 * math.pi))
    m.trace("P", crank, at=(0.1, 0, 0.1))
    solution = m.sweep(steps=steps)
    inks = {"crank": "#0b62a8", "slider": "#66717b"}
    return to_motion3(solution, inks, {}, {"crank": "mechanism", "slider": "mechanism"})


MOTION = motion()
CONTENT = jsonfile.encode(MOTION)


def test_a_file_is_read_back_as_it_was_written_and_has_its_own_version(tmp_path: Path) -> None:
    path = tmp_path / "data.json"
    contract.write_motion(path, MOTION)
    assert contract.read_any_motion(path, "slanted") == MOTION
    assert contract.is_in_space(path)
    head = json.loads(path.read_bytes())
    assert (head["schema"], head["schema_version"], head["space"]) == ("mbsd.motion", 4, 3)
    assert MOTION.period == pytest.approx(1.0)


def test_planar_readers_say_that_it_is_of_space_and_planar_files_stay_as_they_are(tmp_path: Path) -> None:
    path, planar = tmp_path / "data.json", four_bar_motion(steps=12)
    contract.write_motion(path, MOTION)
    with pytest.raises(UserError, match="'slanted', a mechanism in space; this needs one in the plane"):
        contract.read_motion(path)
    contract.write_motion(path, planar)
    assert not contract.is_in_space(path)
    assert contract.read_any_motion(path) == planar
    assert json.loads(path.read_bytes())["schema_version"] == 3
    assert b'"space"' not in path.read_bytes()


def _set(*way: str | int, to: Any) -> Callable[[dict[str, Any]], None]:
    def change(document: dict[str, Any]) -> None:
        place: Any = document
        for step in way[:-1]:
            place = place[step]
        place[way[-1]] = to

    return change


def _negated(document: dict[str, Any]) -> None:
    for name in ("qw", "qx", "qy", "qz"):
        document["bodies"]["crank"][name][5] *= -1.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_set("space", to=2), "space"),
        (_set("schema_version", to=3), "schema_version is 3, this program reads 4"),
        (_set("bodies", "crank", "qw", 3, to=7.0), r"bodies\.crank: the quaternion .* in row 3; it must be 1"),
        (_set("bodies", "crank", "qw", 3, to=math.nan), "every number must be finite"),
        (_set("bodies", "crank", "qz", to=[0.0]), r"bodies\.crank\.qz has 1 values, time has 25"),
        (_negated, "changes its sign or turns by more than half a turn between rows 4 and 5"),
        (_set("bodies", "crank", "mass", to=-1.0), "mass"),
        (_set("bodies", "crank", "inertia", 0, to=-1.0), "negative principal moment"),
        (_set("bodies", "slider", "x", 24, to=9.0), r"bodies\.slider\.x begins at .* though period is 1 s"),
        (_set("joints", "shaft", "bodies", 1, to="wheel"), "names 'wheel', which is no body"),
        (_set("joints", "shaft", "ux", 0, to=2.0), r"joints\.shaft: the axis"),
        (
            _set("joints", "shaft", "markers", 0, "axis", to=MOTION.joints["shaft"].markers[0].across),
            "they must be perpendicular",
        ),
        (_set("joints", "shaft", "turn", to=[1.0]), r"joints\.shaft\.turn has 1 values"),
        (_set("drivers", "motor", "joint", to="rope"), r"drivers\.motor\.joint names 'rope', which does not exist"),
        (_set("forces", "spring", "rows", to=[]), "rows"),
        (_set("forces", "spring", "rows", 0, "value", to=[1.0]), r"forces\.spring\.rows\[0\]\.value has 1 values"),
        (_set("forces", "spring", "bodies", 0, to="rope"), r"forces\.spring\.bodies names 'rope'"),
        (_set("conventions", "axis", to="other"), r"conventions\.axis"),
        (_set("time", 4, to=0.0), r"time\[4\] = 0\.0 does not come after"),
        (_set("gravity", to=[0.0, 1.0]), "gravity"),
    ],
)
def test_a_hostile_file_raises_an_error_that_names_the_field(change: Any, said: str, tmp_path: Path) -> None:
    path, document = tmp_path / "data.json", json.loads(CONTENT)
    change(document)
    path.write_text(json.dumps(document))
    with pytest.raises(UserError, match=said):
        contract.read_any_motion(path)


def test_a_file_that_is_cut_off_is_not_taken_for_one(tmp_path: Path) -> None:
    path = tmp_path / "data.json"
    path.write_bytes(CONTENT[: len(CONTENT) // 2])
    with pytest.raises(UserError, match=r"not a whole JSON file"):
        contract.read_any_motion(path)


def test_a_force_at_frames_has_its_wrench_in_place_of_rows() -> None:
    m = Mechanism("mount", gravity=(0, 0, -9.81))
    load = m.body("load", 2.0, com=(0, 0, 0.1), inertia=(0.5, 0.6, 0.7))
    m.bushing("bush", m.ground, load, [4e4, 4e4, 9e4, 50, 50, 50], [40] * 6, at=(0, 0, 0), axis=(0, 0, 1))
    solution = m.simulate(duration=0.02, steps=4)
    bush = to_motion3(solution, {"load": "#0b62a8"}, {}, {"load": "mechanism"}).forces["bush"]
    assert bush.rows == []
    assert bush.fz == pytest.approx(solution.force("bush").force[:, 2])
    assert bush.mx == pytest.approx(solution.force("bush").moment[:, 0])
