"""A story of postage stamps is rendered, killed, goes on where it was, and comes to the same bytes."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import msgspec
import numpy as np
from PIL import Image

from render import freshness
from render.film.story.frame import Picture
from render.frames import frames
from render.frames.encode import ffmpeg, refuse_other_than
from render.frames.store import FrameStore
from render.frames.story import stage
from render.frames.story.telling import StoryPictures, telling_of
from render.presets import Preset
from render.showreel import showreel
from render.showreel.join import read_clip
from shared.contract.shot import Camera, Shot, Story
from shared.stage.paths import ROOT, Out
from tools.fixtures import film_fixture

TINY = Preset("draft-tiny", 96, 54, 1)
SHORT = Shot(seconds_per_turn=0.3, story=Story(shots=("title", "assembly", "reason")))


def stamps(out: Out) -> dict[str, int]:
    folder = FrameStore(out.frames("draft-tiny-story")).folder
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("[!.]*.png")}


def test_a_story_is_killed_and_goes_on(out_root: Path, tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.setattr(freshness, "current_names", set)  # the motion is one that no stage has solved
    out = film_fixture.write(SHORT)
    code = "from render.frames.story import stage; from render.presets import Preset; "
    code += "stage.run('four_bar', Preset('draft-tiny', 96, 54, 1))"
    process = subprocess.Popen([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.DEVNULL)
    end = time.monotonic() + 120
    while len(stamps(out)) < 2:
        assert time.monotonic() < end
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = stamps(out)
    film = stage.film_of(out, TINY.name)
    assert not film.exists()

    stage.run("four_bar", TINY)
    said = capsys.readouterr().out
    rendered = [int(n) for n in re.findall(r"(\d+) of \d+ pictures to render", said)]
    assert 0 < sum(rendered) <= telling_of(out, TINY).count - len(before)
    assert {name: at for name, at in stamps(out).items() if name in before} == before
    _check(out, film)
    content, subtitles = film.read_bytes(), film.with_suffix(".srt").read_bytes()
    stage.run("four_bar", TINY)
    assert "nothing to do" in capsys.readouterr().out
    film.unlink()
    stage.run("four_bar", TINY)
    assert "to render" not in capsys.readouterr().out, "the silent film is still there"
    assert (film.read_bytes(), film.with_suffix(".srt").read_bytes()) == (content, subtitles)

    film.rename(film.with_name("four_bar-draft-tiny-explain.mp4"))
    reel = showreel.run(TINY, "four_bar")
    assert b"Four bar" in reel.read_bytes()
    assert read_clip(reel).frames == telling_of(out, TINY).story.total, "a story has its own title"


def test_pieces_are_lifted_trails_hidden_and_lenses_changed(out_root: Path) -> None:
    """In one job, whose pictures differ just where they should."""
    out = film_fixture.write(Shot(seconds_per_turn=0.3, camera=Camera(blur=0.0)))
    telling = telling_of(out, TINY)
    at = telling.film.clock.frames / 2
    camera = telling.film.camera(int(at))
    plain = Picture(at=at, camera=camera)
    rows = [
        plain,
        msgspec.structs.replace(plain, hidden="trails"),
        msgspec.structs.replace(plain, hidden="all"),
        msgspec.structs.replace(plain, hidden="all", lifts=(("coupler/coupler", 0.05),)),
        msgspec.structs.replace(plain, hidden="all", camera=msgspec.structs.replace(camera, lens=2 * camera.lens)),
    ]
    pictures = StoryPictures(telling.film, TINY, rows=tuple((row, row, row) for row in rows), what="trials")
    store = FrameStore(out.frames("trials"), (TINY.width, TINY.height))
    with store.locked():
        frames.render(pictures, store, range(len(rows)), "trials", frames.Tally())
    shown = [_pixels(frames.picture_of(pictures, store, k)) for k in range(len(rows))]
    assert np.array_equal(shown[1], shown[2])  # this machine has trails alone beside its solids
    assert np.abs(shown[0] - shown[1]).max() > 30
    assert np.abs(shown[3] - shown[2]).max() > 60
    assert (np.abs(shown[3] - shown[2]).max(axis=2) > 12).mean() < 0.5  # the rest stays where it is
    near = np.asarray(Image.fromarray(shown[2].astype(np.uint8)).crop((24, 13, 72, 40)).resize((96, 54)), float)
    assert np.abs(near - shown[4]).mean() < 0.5 * np.abs(shown[2] - shown[4]).mean()


def test_a_picture_has_the_same_bytes_whatever_else_its_job_renders(out_root: Path) -> None:
    """A story that was stopped renders the rest alone: near and far cameras, lens blur and lifts of others are gone."""
    out = film_fixture.write(Shot(seconds_per_turn=0.3))
    telling = telling_of(out, TINY)
    story = telling.story
    middles = {placed.shot.name: story.picture((placed.first + placed.end) // 2) for placed in story.placed}
    rows = [middles[name] for name in ("macro", "assembly", "last", "motion")]
    contents = []
    for chosen in (rows, rows[2:]):
        pictures = StoryPictures(telling.film, TINY, rows=tuple((row, row, row) for row in chosen), what="trials")
        store = FrameStore(out.frames(f"trials{len(chosen)}"), (TINY.width, TINY.height))
        with store.locked():
            frames.render(pictures, store, range(len(chosen)), "trials", frames.Tally())
        contents.append([frames.picture_of(pictures, store, k).read_bytes() for k in range(len(chosen))])
    assert contents[0][2:] == contents[1]


def _pixels(path: Path) -> np.ndarray:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"), float)


def _check(out: Out, film: Path) -> None:
    """Every frame is there in its size, the chapters are the shots."""
    story = telling_of(out, TINY).story
    refuse_other_than(film, film.name, ffmpeg(), story.total, TINY, story.fps, 60.0)
    listing = subprocess.run([ffmpeg(), "-i", str(film)], capture_output=True, text=True).stderr
    assert re.search(r"Stream #0:1.*Audio: aac.*48000 Hz, stereo", listing)
    assert re.findall(r"title\s*: (.*)", listing) == ["Four bar", "Title", "Assembly", "Why"]
    starts = [float(start) for start in re.findall(r"start (\d+\.\d+), end", listing)]
    assert all(abs(a - b[0]) < 2e-3 for a, b in zip(starts, story.chapters, strict=True))
