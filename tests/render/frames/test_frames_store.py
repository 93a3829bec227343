"""The folder of frames, the Blender process and the words for what goes wrong, without rendering anything."""

from __future__ import annotations

import errno
import json
import os
import shutil
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from render.blender.picture_file import fault, name_of
from render.blender.process import scratch_folder, sweep
from render.blender.worker.worker import missing_library
from render.frames import blend, frames, still
from render.frames.store import FrameStore, Timing
from render.presets import PRESETS, Preset
from shared.contract.shot import Shot
from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from tools.fixtures import film_fixture

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


def stored(store: FrameStore, key: str, seed: int = 0) -> Path:
    """A picture in the store, as the Blender process leaves it."""
    content = picture(store.folder / "new.png", seed).read_bytes()
    return (store.folder / "new.png").rename(store.folder / name_of(key, content))


@pytest.mark.parametrize("damage", ["truncated", "flipped", "empty", "swapped", "a comment more"])
def test_a_picture_with_other_bytes_is_not_kept(tmp_path: Path, damage: str, capsys: pytest.CaptureFixture[str]):
    store = FrameStore(tmp_path)
    path, other = stored(store, "a", 0), stored(store, "b", 1)
    assert store.find("a") == path
    content = path.read_bytes()
    assert store.read(path.name) == content
    middle = len(content) // 2
    path.write_bytes(
        {
            "truncated": content[:-1],
            "flipped": content[:middle] + bytes([content[middle] ^ 0xFF]) + content[middle + 1 :],
            "empty": b"",
            "swapped": other.read_bytes(),
            "a comment more": content[:-12] + b"\0\0\0\0tEXt\xd8\xf1\x11\xb4" + content[-12:],
        }[damage]
    )
    assert store.read(path.name) is None
    assert store.find("a") is None
    assert f"{path.name} is not the picture that was rendered any more; it is rendered again" in capsys.readouterr().out
    assert not path.exists()
    assert store.find("b") == other


def test_a_picture_under_the_name_of_another_is_not_taken(tmp_path: Path):
    store = FrameStore(tmp_path)
    path = stored(store, "a")
    path.rename(path.with_name("b" + path.name[1:]))
    assert store.find("b") is None


def test_a_picture_is_looked_at_to_its_last_byte(tmp_path: Path):
    path = picture(tmp_path / "a.png")
    content = path.read_bytes()
    assert fault(path, 32, 18) is None
    assert fault(path, 64, 36) == "is 32x18, not 64x36"
    for cut in [*range(0, len(content), 17), *range(len(content) - 13, len(content))]:
        path.write_bytes(content[:cut])
        assert fault(path, 32, 18), cut
    for place in [*range(60), *range(60, len(content), 17)]:
        path.write_bytes(content[:place] + bytes([content[place] ^ 0x55]) + content[place + 1 :])
        assert fault(path, 32, 18), place
    path.unlink()
    assert fault(path, 32, 18) == "is not there"


def test_old_pictures_go_oldest_first_and_some_stay(tmp_path: Path):
    store = FrameStore(tmp_path)
    made = [stored(store, key, age) for age, key in enumerate("abcdef")]
    for age, path in enumerate(made):
        os.utime(path, (1e9 + age, 1e9 + age))
    assert store.prune({made[0]}, spare=2) == 3
    assert sorted(path.name[0] for path in tmp_path.glob("*.png")) == ["a", "e", "f"]


def test_two_renders_of_one_film_do_not_meet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("render.frames.store.WAIT", 0.2)
    first, second = FrameStore(tmp_path), FrameStore(tmp_path)
    with first.locked(), pytest.raises(UserError, match="another process renders"), second.locked():
        pass
    with FrameStore(tmp_path).locked():
        pass


def test_a_run_that_is_being_stopped_is_waited_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    code = "import sys, time, pathlib, render.frames.store as s\nwith s.FrameStore(pathlib.Path(sys.argv[1])).locked():"
    code += " print(flush=True); time.sleep(1)"
    other = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], cwd=ROOT, stdout=subprocess.PIPE)
    assert other.stdout
    other.stdout.readline()
    with FrameStore(tmp_path).locked():
        assert "another process has" in capsys.readouterr().out
    other.communicate()


def test_a_folder_in_place_of_the_lock(tmp_path: Path):
    (tmp_path / ".lock").mkdir()
    with FrameStore(tmp_path).locked():
        assert (tmp_path / ".lock").is_file()
    (tmp_path / ".lock").unlink()
    (tmp_path / ".lock" / "mine").mkdir(parents=True)
    with pytest.raises(UserError, match=r"cannot write .*\.lock: Directory not empty; remove or rename"):
        FrameStore(tmp_path).locked().__enter__()


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def refuse(*_: object) -> int:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(UserError, match=r"cannot write .*\.lock: Read-only file system; make file and folder acc"):
        FrameStore(tmp_path).locked().__enter__()


@pytest.mark.parametrize(
    ("field", "value"),
    [("rendered", 0), ("work", 0), ("cycles", -1.0), ("cycles", 1e300), ("device", "\udcff")],
    ids=str,
)
def test_a_timing_that_cannot_be_is_as_good_as_none(out_root: Path, tmp_path: Path, field: str, value: object):
    store = FrameStore(tmp_path)
    timing = Timing(preset="tiny", device="CPU", work=1, rendered=10, wall=1.1, cycles=1.0, overhead=1.1)
    jsonfile.write(store.timing, timing)
    assert frames.forecast(TINY, store)
    document = json.loads(store.timing.read_bytes()) | {field: value}
    store.timing.write_bytes(json.dumps(document, ensure_ascii=False).encode(errors="surrogateescape"))
    assert store.read_timing() is None
    assert frames.forecast(TINY, store) is None


def test_unfinished_files_are_swept(tmp_path: Path):
    picture(tmp_path / ".abc.part.png")
    with FrameStore(tmp_path).locked():
        assert not list(tmp_path.glob(".*.png"))


def test_scratch_folders_of_dead_processes_are_swept(tmp_path: Path):
    code = "import sys, os, pathlib; from render.blender.process import scratch_folder\n"
    code += "with scratch_folder(pathlib.Path(sys.argv[1])): os._exit(0)"
    subprocess.run([sys.executable, "-c", code, str(tmp_path)], cwd=ROOT, check=True)
    assert len(list(tmp_path.iterdir())) == 1
    (tmp_path / "tmp-of-the-user").mkdir()  # younger than a minute and without a lock
    with scratch_folder(tmp_path) as mine:
        sweep(tmp_path)
        assert sorted(tmp_path.iterdir()) == sorted([mine, tmp_path / "tmp-of-the-user"])
    assert [path.name for path in tmp_path.iterdir()] == ["tmp-of-the-user"]


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
    assert frames.forecast(Preset("preview", 2000, 2000, 1), other) == (pytest.approx(12.0), "scaled from draft")
    assert frames.forecast(PRESETS["draft"], store) == (pytest.approx(3.0), "as measured before")


def test_nothing_measured_means_no_forecast_yet(out_root: Path):
    assert frames.forecast(TINY, FrameStore(Out("four_bar").frames("tiny"))) is None


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
    said = missing_library("libXi.so.6: cannot open shared object file: No such file or directory")
    assert said == "Blender needs the system library libXi.so.6: sudo apt-get install -y libxi6"
    assert "libfoo.so.1" in missing_library("libfoo.so.1: cannot open shared object file")


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
        "import sys, render.__main__, render.film.inputs\nfrom render.frames import film, still, blend\n"
        "heavy = {'bpy', 'numpy', 'matplotlib', 'PIL'} & set(sys.modules)\n"
        "sys.exit(', '.join(sorted(heavy)) or 0)"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr


def test_a_still_outside_the_film_is_refused_in_process(out_root: Path):
    film_fixture.write(Shot(turns=2, seconds_per_turn=0.2))
    with pytest.raises(UserError, match=r"frames 0 to 11 \(the motion 2 times, 6 frames each\)"):
        still.still("four_bar", TINY, 12)
