"""The film as a file with every frame, or refused; the contact sheet of twelve frames."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from render.film.film import Film
from render.film.inputs import read_film
from render.frames import encode, still
from render.frames.encode import refuse_other_than
from render.frames.store import FrameStore
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.fixtures import film_fixture
from tools.models.motions import four_bar_motion

TINY = Preset("tiny", 32, 18, 1)


def test_without_ffmpeg_the_film_says_so(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(UserError, match="no ffmpeg"):
        encode.ffmpeg()


def noise(count: int) -> list[bytes]:
    """PNGs of 32x18."""
    made = []
    for seed in range(count):
        made.append(io.BytesIO())
        pixels = np.random.default_rng(seed).integers(0, 255, (18, 32, 3), dtype=np.uint8)
        Image.fromarray(pixels).save(made[-1], format="PNG")
    return [file.getvalue() for file in made]


def test_ffmpeg_failing_leaves_no_film(tmp_path: Path):
    with pytest.raises(UserError, match=r"film\.mp4: ffmpeg failed: .*MB are free"):
        encode.encode([b"not a picture"], 1, TINY, 30, tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("wanted", [4, 6])
def test_a_film_with_a_frame_too_few_or_too_many_is_refused(tmp_path: Path, wanted: int):
    with pytest.raises(
        UserError, match=rf"the film has 5 frames of 32x18 in 0\.500 s; {wanted} of 32x18 in 0\.{wanted}"
    ):
        encode.encode(noise(5), wanted, TINY, 10, tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


def test_a_film_of_another_size_is_refused(tmp_path: Path):
    with pytest.raises(UserError, match=r"the film has 5 frames of 32x18 in .*; 5 of 64x36"):
        encode.encode(noise(5), 5, Preset("other", 64, 36, 1), 10, tmp_path / "film.mp4")


def test_a_film_that_was_cut_does_not_decode(tmp_path: Path):
    film = tmp_path / "film.mp4"
    encode.encode(noise(5), 5, TINY, 10, film)
    content = film.read_bytes()
    refuse_other_than(film, "film", encode.ffmpeg(), 5, TINY, 10, 60.0)
    for cut in (0, 100, len(content) // 2, len(content) - 50):
        film.write_bytes(content[:cut])
        with pytest.raises(UserError, match=r"film: the film (does not decode|has)"):
            refuse_other_than(film, "film", encode.ffmpeg(), 5, TINY, 10, 60.0)


def test_an_ffmpeg_that_hangs_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    fake = tmp_path / "ffmpeg"
    fake.write_text("#!/bin/sh\nexec sleep 60\n")
    fake.chmod(0o755)
    monkeypatch.setattr(encode, "ffmpeg", lambda: str(fake))
    monkeypatch.setattr(encode, "TICK", 0.05)
    monkeypatch.setenv("MBSD_PATIENCE", "0.5")
    with pytest.raises(UserError, match=r"film\.mp4: ffmpeg took no picture for 0\.5 s and was stopped"):
        encode.encode(noise(1) * 200, 200, TINY, 10, tmp_path / "film.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["ffmpeg"]


def test_the_film_is_an_mp4_every_player_takes(tmp_path: Path):
    film = tmp_path / "film.mp4"
    encode.encode(noise(5) * 3, 15, TINY, 10, film)
    content = film.read_bytes()
    assert content.index(b"moov") < content.index(b"mdat")
    said = subprocess.run([encode.ffmpeg(), "-i", str(film)], capture_output=True, text=True, check=False).stderr
    assert "h264 (High)" in said
    assert "yuv420p(tv, bt709" in said
    assert "32x18" in said
    assert "10 fps" in said
    again = tmp_path / "again.mp4"
    encode.encode(noise(5) * 3, 15, TINY, 10, again)
    assert again.read_bytes() == content


SHEET = Preset("tiny", 96, 54, 1)


def test_a_motion_that_repeats_is_shown_over_one_turn(out_root: Path) -> None:
    film = read_film(film_fixture.write(Shot(seconds_per_turn=4.0)))
    assert still.frames_of(film) == list(range(0, 120, 10))


@pytest.mark.parametrize("turns", [2, 3, 4, 6])
def test_a_period_of_several_turns_shows_no_turn_as_another(out_root: Path, turns: int) -> None:
    whole = read_film(film_fixture.write())
    film = Film(four_bar_motion(turns=turns), whole.parts, Shot(seconds_per_turn=4.0), whole.folder)
    times = np.array([film.clock.moment(frame).time for frame in still.frames_of(film)])
    assert (np.diff(times) > 0).all()
    assert times[-1] < turns
    assert times[-1] > 0.95 * turns
    phases = np.sort(times % 1.0)
    assert np.diff(phases).min() > 0.01


def test_another_is_shown_from_its_start_to_its_end(out_root: Path) -> None:
    whole = read_film(film_fixture.write(Shot(seconds_per_turn=4.0)))
    film = Film(msgspec.structs.replace(whole.motion, period=None), whole.parts, whole.shot, whole.folder)
    times = [film.clock.moment(frame).time for frame in still.frames_of(film)]
    assert times == sorted(times)
    assert times[0] == film.motion.time[0]
    assert times[-1] == pytest.approx(film.motion.time[-1])


def test_frames_lie_in_rows_with_their_times(tmp_path: Path) -> None:
    pictures = []
    for k in range(12):
        pictures.append(tmp_path / f"{k}.png")
        Image.new("RGB", (96, 54), (20 * k, 0, 255 - 20 * k)).save(pictures[-1])
    page = Image.open(io.BytesIO(still.sheet(pictures, ["t = 0 s"] * 12, "four bar")))
    wide, high = 96 + still.GAP, 54 + still.FOOT
    assert page.size == (4 * wide + still.GAP, still.HEAD + 3 * high)
    for k in range(12):  # every pixel of a frame is the frame's, and its time is under it
        left, top = still.GAP + k % 4 * wide, still.HEAD + k // 4 * high
        frame = np.asarray(page)[top : top + 54, left : left + 96]
        assert (frame == (20 * k, 0, 255 - 20 * k)).all()
        under = np.asarray(page)[top + 54 : top + high, left : left + 96]
        assert (under == still.PAPER).all(axis=2)[[0, -1]].all()
        assert (np.abs(under.astype(int) - still.INK).sum(axis=2) < 90).any()


@pytest.mark.parametrize(("size", "across"), [((96, 54), 4), ((54, 54), 6), ((48, 60), 6), ((54, 96), 6)])
def test_a_sheet_of_tall_frames_has_more_of_them_in_a_row_and_no_time_is_wider_than_its_frame(
    tmp_path: Path, size: tuple[int, int], across: int
) -> None:
    path = tmp_path / "frame.png"
    Image.new("RGB", size, (0, 0, 0)).save(path)
    page = Image.open(io.BytesIO(still.sheet([path] * 12, ["0.000000001 s"] * 12, "four bar")))
    assert page.width == across * (size[0] + still.GAP) + still.GAP
    assert page.height == still.HEAD + 12 // across * (size[1] + still.FOOT)
    pixels = np.asarray(page).astype(int)
    foot = pixels[still.HEAD + size[1] : still.HEAD + size[1] + still.FOOT]
    for k in range(across + 1):  # nothing is written between two columns
        left = k * (size[0] + still.GAP)
        assert (foot[:, left : left + still.GAP] == still.PAPER).all()


def test_the_film_finds_the_frames_of_the_sheet(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = film_fixture.write(Shot(turns=1, seconds_per_turn=0.4))  # twelve frames
    still.run("four_bar", SHEET)
    with Image.open(out.contact) as page:
        assert page.size == (4 * 106 + 10, 46 + 3 * 80)
    assert len(list(FrameStore(out.frames("tiny")).folder.glob("[!.]*.png"))) == 12
    capsys.readouterr()
    still.run("four_bar", SHEET)
    assert "nothing to do" in capsys.readouterr().out
    out.contact.unlink()
    still.run("four_bar", SHEET)
    assert "0 of 12 pictures to render" in capsys.readouterr().out
    assert Out("four_bar").contact.is_file()
