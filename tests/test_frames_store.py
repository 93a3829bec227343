"""The folder of frames, the Blender process and the words for what goes wrong, without rendering anything."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from render import blend, encode, frames, still
from render.blender.worker import _missing_library
from render.child import _sweep
from render.presets import PRESETS, Preset
from render.store import FrameStore, Timing
from shared import jsonfile
from shared.errors import UserError
from shared.paths import ROOT, Out
from shared.shot import Shot
from tests import film_fixture

TINY = Preset("tiny", 32, 18, 1)


def picture(path: Path, seed: int = 0) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    pixels = np.random.default_rng(seed).integers(0, 255, (18, 32, 3), dtype=np.uint8)
    Image.fromarray(pixels).save(path)
    return path


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "render", *arguments], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )


@pytest.mark.parametrize("damage", ["truncated", "flipped", "empty", "other size"])
def test_a_damaged_picture_is_not_kept(tmp_path: Path, damage: str):
    store = FrameStore(tmp_path)
    path = picture(store.path("a"))
    assert store.has("a", 32, 18)
    content = path.read_bytes()
    if damage == "truncated":
        path.write_bytes(content[:-30])
    elif damage == "flipped":
        middle = len(content) // 2
        path.write_bytes(content[:middle] + bytes([content[middle] ^ 0xFF]) + content[middle + 1 :])
    elif damage == "empty":
        path.write_bytes(b"")
    assert not store.has("a", *((64, 36) if damage == "other size" else (32, 18)))
    assert not path.exists()


def test_old_pictures_go_oldest_first_and_some_stay(tmp_path: Path):
    store = FrameStore(tmp_path)
    for age, key in enumerate("abcdef"):
        os.utime(picture(store.path(key), age), (1e9 + age, 1e9 + age))
    assert store.prune({"a"}, spare=2) == 3
    assert sorted(path.stem for path in tmp_path.glob("*.png")) == ["a", "e", "f"]


def test_two_renders_of_one_film_do_not_meet(tmp_path: Path):
    first, second = FrameStore(tmp_path), FrameStore(tmp_path)
    with first.locked(), pytest.raises(UserError, match="another process renders"), second.locked():
        pass
    with FrameStore(tmp_path).locked():
        pass


def test_unfinished_files_are_swept(tmp_path: Path):
    picture(tmp_path / ".abc.part.png")
    with FrameStore(tmp_path).locked():
        assert not list(tmp_path.glob(".*.png"))


def test_scratch_folders_of_dead_processes_are_swept(tmp_path: Path):
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    for number in (dead.pid, os.getpid()):
        (tmp_path / f"tmp-{number}").mkdir()
    _sweep(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [f"tmp-{os.getpid()}"]


def test_a_full_disk_is_refused_before_the_start(out_root: Path, monkeypatch: pytest.MonkeyPatch):
    film_fixture.write(Shot(seconds_per_turn=1.0))
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(1e12, 1e12, 5e6))
    with pytest.raises(
        UserError, match=r"four_bar: 30 pictures of final may need 0\.4 GB.* 0\.0 GB free.*MBSD_OUT"
    ) as _:
        frames.run("four_bar", Preset("final", 1920, 1080, 1))


def test_the_forecast_scales_what_was_measured(out_root: Path):
    store = FrameStore(Out("four_bar").frames("draft"))
    for preset, work, cycles in (("stamp", 5000, 10.0), ("draft", 10**6, 30.0), ("final", 10**9, 50_000.0)):
        timing = Timing(
            preset=preset, device="CPU", work=work, rendered=10, wall=1.1 * cycles, cycles=cycles, overhead=1.1
        )
        jsonfile.write(FrameStore(Out("four_bar").frames(preset)).timing, timing)
    other = FrameStore(Out("slider").frames("preview"))
    assert frames._forecast(Preset("preview", 2000, 2000, 1), other) == (pytest.approx(12.0), "scaled from draft")
    assert frames._forecast(PRESETS["draft"], store) == (pytest.approx(3.0), "as measured before")


def test_nothing_measured_means_no_forecast_yet(out_root: Path):
    assert frames._forecast(TINY, FrameStore(Out("four_bar").frames("tiny"))) is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("film", "four-bar", "--preset", "huge"), ["'huge'", "draft, preview, production, final"]),
        (("film", "no_such"), ["no_such", "four_bar"]),
        (("still", "four_bar", "--frame", "360"), ["no frame 360", "0 to 359"]),
        (("still", "four_bar", "--frame", "-1"), ["no frame -1"]),
    ],
)
def test_wrong_arguments_are_a_sentence(out_root: Path, arguments: tuple[str, ...], words: list[str]):
    film_fixture.write()
    ended = command(*arguments)
    assert ended.returncode == 1
    assert "Traceback" not in ended.stderr
    for word in words:
        assert word in ended.stderr


def test_missing_and_broken_files_are_a_sentence(out_root: Path):
    out = film_fixture.write()
    content = out.motion.read_bytes()
    out.motion.write_bytes(content[: len(content) // 2])
    ended = command("still", "four_bar")
    assert ended.returncode == 1
    assert "data.json" in ended.stderr
    assert "not a whole JSON file" in ended.stderr
    out.motion.unlink()
    assert "make solve-four-bar" in command("film", "four_bar").stderr
    film_fixture.write()
    (out.parts_folder / "crank-crank.stl").unlink()
    ended = command("frames", "four-bar")
    assert ended.returncode == 1
    assert "crank-crank.stl, which is missing" in ended.stderr


def test_a_missing_system_library_names_its_package():
    said = _missing_library("libXi.so.6: cannot open shared object file: No such file or directory")
    assert said == "Blender needs the system library libXi.so.6: sudo apt-get install -y libxi6"
    assert "libfoo.so.1" in _missing_library("libfoo.so.1: cannot open shared object file")


def test_without_ffmpeg_the_film_says_so(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(UserError, match="no ffmpeg"):
        encode.ffmpeg()


def test_ffmpeg_failing_leaves_no_film(tmp_path: Path):
    broken = tmp_path / "a.png"
    broken.write_bytes(b"not a picture")
    with pytest.raises(UserError, match=r"film\.mp4: ffmpeg failed"):
        encode.encode([broken], 30, tmp_path / "film.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_the_film_is_an_mp4_every_player_takes(tmp_path: Path):
    pictures = [picture(tmp_path / f"{i}.png", i) for i in range(5)]
    film = tmp_path / "film.mp4"
    encode.encode(pictures * 3, 10, film)
    content = film.read_bytes()
    assert content.index(b"moov") < content.index(b"mdat")
    said = subprocess.run([encode.ffmpeg(), "-i", str(film)], capture_output=True, text=True, check=False).stderr
    assert "h264 (High)" in said
    assert "yuv420p(tv, bt709" in said
    assert "32x18" in said
    assert "10 fps" in said
    counted = subprocess.run(
        [encode.ffmpeg(), "-i", str(film), "-f", "null", "-"], capture_output=True, text=True, check=False
    ).stderr
    assert counted.split("frame=")[-1].split()[0] == "15"
    again = tmp_path / "again.mp4"
    encode.encode(pictures * 3, 10, again)
    assert again.read_bytes() == content


def test_without_an_installed_blender_scene_ui_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("BLENDER", raising=False)
    monkeypatch.setattr(blend, "USUAL_PLACES", (str(tmp_path / "blender*" / "blender"),))
    with pytest.raises(UserError, match="no installed Blender"):
        blend.find_blender()
    program = tmp_path / "blender-5.2" / "blender"
    program.parent.mkdir()
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    assert blend.find_blender() == str(program)


def test_starting_with_nothing_to_do_is_quick_and_imports_no_blender():
    code = (
        "import sys, render.__main__, render.film, render.still, render.blend, render.inputs\n"
        "heavy = {'bpy', 'numpy', 'matplotlib', 'PIL'} & set(sys.modules)\n"
        "sys.exit(', '.join(sorted(heavy)) or 0)"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr


def test_a_still_outside_the_film_is_refused_in_process(out_root: Path):
    film_fixture.write(Shot(turns=2, seconds_per_turn=0.2))
    with pytest.raises(UserError, match=r"frames 0 to 11 \(2 turns of 6\)"):
        still.still("four_bar", TINY, 12)
