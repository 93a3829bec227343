"""Plates: what stands is rendered once, frames only where they differ, and what is kept of them is never wrong."""

from __future__ import annotations

import io
import signal
import subprocess
import sys
import time
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from render.film.inputs import read_film
from render.frames import frames
from render.frames.frames import Pictures, Tally
from render.frames.keys import frame_key
from render.frames.store import FrameStore
from render.presets import Preset
from shared.contract.shot import Camera, Label, Shot, write_shot
from shared.stage.paths import ROOT, Out
from tools.fixtures import film_fixture

SMALL = Preset("small", 320, 180, 8)
"""Large enough for regions to pay."""
SHOT = Shot(turns=1, seconds_per_turn=1.0)
"""Thirty frames of a camera that stands."""


def pictures(shot: Shot = SHOT, preset: Preset = SMALL, whole: bool = False) -> Pictures:
    out = film_fixture.write(shot)
    return Pictures(read_film(out, aspect=preset.aspect), preset, whole=whole)


def test_frames_of_a_standing_camera_share_a_plate_and_stills_have_none(out_root: Path) -> None:
    film = pictures()
    (plate,) = film.plates.plates
    assert set(film.plates.of_frame) == set(range(30))
    assert plate.moving == ["coupler", "crank", "rocker"]
    assert plate.trails == [0]
    still = pictures(whole=True)
    assert not still.plates.plates
    assert still.key(7) == frame_key(still.scene, [still.state(7)])
    assert still.key(7) != film.key(7)  # a still that the film has is rendered whole all the same


@pytest.mark.parametrize(
    ("shot", "preset"),
    [
        (Shot(turns=1, seconds_per_turn=1.0, camera=Camera(orbit=10)), SMALL),
        (Shot(turns=1, seconds_per_turn=1.0, look="blueprint"), SMALL),
        (Shot(turns=1, seconds_per_turn=0.4), SMALL),
        (SHOT, Preset("odd", 191, 107, 8)),
    ],
    ids=["the camera orbits", "lines are drawn", "it is short", "no small picture fits"],
)
def test_a_film_without_a_plate_renders_what_it_did(out_root: Path, shot: Shot, preset: Preset) -> None:
    film = pictures(shot, preset)
    job = film.job(range(film.count), FrameStore(Out("four_bar").frames(preset.name)))
    assert not film.plates.plates
    assert not job.plates
    assert {picture.plate for picture in job.pictures} == {-1}
    stills = pictures(shot, preset, whole=True)
    assert [picture.key for picture in job.pictures] == [stills.key(frame) for frame in range(film.count)]


def plate_key(shot: Shot, preset: Preset = SMALL) -> str:
    (plate,) = pictures(shot, preset).plates.plates
    return plate.key


@pytest.mark.parametrize("change", [{"seconds_per_turn": 2.0}, {"fps": 25}, {"turns": 4}], ids=str)
def test_another_speed_keeps_the_plate(out_root: Path, change: dict) -> None:
    assert plate_key(msgspec.structs.replace(SHOT, **change)) == plate_key(SHOT)


@pytest.mark.parametrize(
    "change",
    [{"look": "daylight"}, {"camera": Camera(azimuth=-17.0)}, {"materials": {"ground": "brass"}}],
    ids=str,
)
def test_another_light_makes_the_plate_again(out_root: Path, change: dict) -> None:
    assert plate_key(msgspec.structs.replace(SHOT, **change)) != plate_key(SHOT)


def test_labels_that_stand_are_part_of_the_plate(out_root: Path) -> None:
    (plate,) = pictures(
        msgspec.structs.replace(SHOT, labels=(Label(at="A", text="A"), Label(at="B", text="B")))
    ).plates.plates
    assert plate.labels == [1]


# In Blender.

FRAMES = [3, 17]


def store_of(out: Out) -> FrameStore:
    return FrameStore(out.frames(SMALL.name), (SMALL.width, SMALL.height))


def rendered(out: Out, chosen: list[int] = FRAMES, whole: bool = False) -> list[bytes]:
    """Return the bytes of some frames."""
    made = Pictures(read_film(out, aspect=SMALL.aspect), SMALL, whole=whole)
    store = store_of(out)
    with store.locked():
        frames.render(made, store, chosen, "of a test", Tally())
        return [frames.picture_of(made, store, frame).read_bytes() for frame in chosen]


START = """
from shared.stage.paths import Out
from tests.render.frames.test_plates import rendered
rendered(Out("four_bar"))
"""


def test_plates_are_the_same_after_a_kill_and_made_again_when_damaged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "killed"))
    out = film_fixture.write(SHOT)
    store = store_of(out)
    process = subprocess.Popen(
        [sys.executable, "-c", START], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    end = time.monotonic() + 120
    while not store.plates.is_dir():  # it is about to render the plate
        assert time.monotonic() < end
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not list(store.plates.glob("*.npz"))
    after_kill = rendered(out)
    assert "for the plate of what stands" in capsys.readouterr().out
    (plate,), (verdict,) = store.plates.glob("*.npz"), store.plates.glob("*.json")
    content = plate.read_bytes()
    assert b'"fault":""' in verdict.read_bytes()

    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "whole"))
    there = film_fixture.write(SHOT)
    assert rendered(there) == after_kill
    assert {path.name: path.read_bytes() for path in store_of(there).plates.glob("*.npz")} == {plate.name: content}

    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "killed"))
    plate.write_bytes(content[:-100])
    for picture in store.folder.glob("*.png"):
        picture.unlink()
    assert rendered(out) == after_kill  # from a plate that was kept, and judged before
    assert plate.read_bytes() == content

    write_shot(out.shot, msgspec.structs.replace(SHOT, seconds_per_turn=2.0))
    capsys.readouterr()
    rendered(out, [5])
    assert [path.name for path in store.plates.glob("*.npz")] == [plate.name]


def test_a_plate_that_failed_its_trial_is_told_and_leaves_frames_whole(
    out_root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = film_fixture.write(SHOT)
    (plate,) = Pictures(read_film(out, aspect=SMALL.aspect), SMALL).plates.plates
    folder = store_of(out).plates
    folder.mkdir(parents=True)
    (folder / f"{plate.trial}.json").write_bytes(b'{"cost": 0.3, "fault": "differs by 9.0 of 255 in the mean"}')
    apart = rendered(out, FRAMES[:1])
    said = capsys.readouterr().out
    assert "a frame put together from its plate differs by 9.0 of 255 in the mean" in said
    assert "all frames of this camera are rendered whole" in said
    whole = rendered(out, FRAMES[:1], whole=True)
    first, second = (np.asarray(Image.open(io.BytesIO(content))).astype(int) for (content,) in (whole, apart))
    assert np.abs(first - second).mean() < 3  # its noise is that of a process which makes plates
    assert not list(folder.glob("*.npz"))
