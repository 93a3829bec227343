"""shot.json: defaults, refusals, and the shot of the four-bar."""

from __future__ import annotations

import json
from pathlib import Path

import msgspec
import pytest

from mechanisms.four_bar.shot import shot as four_bar_shot
from mechanisms.stages import shot as shot_stage
from shared.contract import ForceMotion, read_motion, read_parts, write_motion
from shared.contract.shot import (
    Camera,
    Label,
    Names,
    Shot,
    Surface,
    Title,
    Trail,
    read_shot,
    refuse_unknown,
    write_shot,
)
from shared.stage.errors import UserError
from tools.fixtures import film_fixture


def test_defaults_and_the_four_bar_survive_a_round_trip(tmp_path: Path):
    rich = Shot(
        trails=(Trail(point="P", tail=0.5),),
        labels=(Label(at="B", text="B"),),
        materials={"crank": "brass", "coupler/coupler": Surface(colour=(0.1, 0.2, 0.3), finish="satin")},
    )
    for shot in (Shot(), four_bar_shot, rich):
        path = tmp_path / "shot.json"
        write_shot(path, shot)
        assert read_shot(path) == shot


@pytest.mark.parametrize(
    ("shot", "field"),
    [
        (Shot(fps=0), "fps"),
        (Shot(turns=0), "turns"),
        (Shot(poster=1.5), "poster"),
        (Shot(seconds_per_turn=-1.0), "seconds_per_turn"),
        (Shot(camera=Camera(elevation=120.0)), "camera.elevation"),
        (Shot(camera=Camera(azimuth=float("nan"))), "camera.azimuth"),
        (Shot(trails=(Trail(point="P", tail=0.0),)), "tail"),
        (Shot(look="candlelight"), "look; known: studio, cyclorama, bench, daylight, road, sand, blueprint"),  # type: ignore[arg-type]
        (Shot(show=("force",)), r"show\[0\]; known: velocities, .*reactions"),  # type: ignore[arg-type]
        (Shot(title="Four bar"), "Expected .*title"),  # type: ignore[arg-type]
    ],
)
def test_values_out_of_range_are_refused_by_field(tmp_path: Path, shot: Shot, field: str):
    with pytest.raises(UserError, match=field):
        write_shot(tmp_path / "shot.json", shot)
    assert not (tmp_path / "shot.json").exists()


def test_an_unknown_field_is_refused(tmp_path: Path):
    path = tmp_path / "shot.json"
    write_shot(path, Shot())
    content = json.loads(path.read_text())
    content["camera"]["zoom"] = 2
    path.write_text(json.dumps(content))
    with pytest.raises(UserError, match="zoom"):
        read_shot(path)


@pytest.mark.parametrize(
    ("shot", "words"),
    [
        (Shot(trails=(Trail(point="Q"),)), ["trails[0].point", "'Q'", "P"]),
        (Shot(labels=(Label(at="E", text="E"),)), ["labels[0].at", "'E'", "A, B, C, D, P"]),
        (Shot(materials={"arm": "brass"}), ["materials", "'arm'", "crank/crank"]),
        (Shot(materials={"crank": "unobtainium"}), ["materials['crank']", "'unobtainium'", "brass"]),
        (Shot(materials={"crank": "aluminum"}), ["'aluminum'", "did you mean 'aluminium'?"]),
        (Shot(materials={"Rocker": "brass"}), ["'Rocker'", "did you mean 'rocker'?"]),
    ],
)
def test_names_the_mechanism_lacks_are_refused_with_those_it_has(out_root: Path, shot: Shot, words: list[str]):
    out = film_fixture.write()
    with pytest.raises(UserError) as refusal:
        refuse_unknown(shot, Names.from_motion(read_motion(out.motion), read_parts(out.parts)))
    for word in ["four_bar", *words]:
        assert word in str(refusal.value)


def test_the_stage_knows_the_names_that_pictures_know(out_root: Path):
    """It reads them from data.json without its numbers: those of drivers, and of forces that have an effort, too."""
    out = film_fixture.write()
    motion = read_motion(out.motion)
    none = [0.0] * len(motion.time)
    push = ForceMotion(
        kind="torque", actions=[], several=False, measures=None, value=None, rate=None, effort=none,
        normal=None, power=none, potential=none, shape=None,
    )  # fmt: skip
    told = {"push": push, "gas": msgspec.structs.replace(push, effort=None)}
    write_motion(out.motion, msgspec.structs.replace(motion, forces=told))
    names = Names.from_motion(read_motion(out.motion), read_parts(out.parts))
    assert names.efforts == ("motor", "push")
    assert shot_stage._names(out) == names
    refuse_unknown(Shot(title=Title(number="motor")), names)
