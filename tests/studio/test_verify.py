"""Same inputs, same outputs: files are built again and compared, and differences are reported."""

from __future__ import annotations

import io
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from render.blender.picture_file import name_of
from render.frames import encode, film
from render.frames.store import FrameIndex, FrameStore
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from studio.verify import files, verify
from studio.verify import film as compared_film
from tools.fixtures import film_fixture

TINY = Preset("tiny", 96, 54, 1)
SHORT = Shot(turns=2, seconds_per_turn=0.2, trails=(), labels=())


@pytest.fixture
def filmed(out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Out:
    """Return a small film, with stages that rebuild its files by copying them."""
    out = film_fixture.write(SHORT)
    kept = tmp_path / "kept"
    shutil.copytree(out.folder, kept)
    film.run("four_bar", TINY)
    real = verify._stage

    def stage(root: Path, module: str, *arguments: str) -> None:
        if module == "mechanisms":
            shutil.copytree(kept, root / "four_bar", dirs_exist_ok=True)
        else:
            real(root, module, *arguments)

    monkeypatch.setattr(verify, "_stage", stage)
    return out


def test_a_film_is_the_same_and_each_difference_is_told(filmed: Out, capsys: pytest.CaptureFixture[str]) -> None:
    before = {path: path.read_bytes() for path in filmed.folder.parent.rglob("*") if path.is_file()}
    assert verify.run("four_bar", TINY, "0,5") == 0
    said = capsys.readouterr()
    assert not said.err
    for words in (
        r"solids \(parts\.json, STL, STEP\): same, 11 files",
        r"motion \(data\.json\): same, \d+ bytes",
        "frame 0: same, 96x54 pixels, the same bytes",
        "frame 5: same",
        "film: same, 12 decoded frames, the same file",
        r"sound \(four_bar-tiny\.wav\): same, \d+ bytes",
        "four_bar: 8 the same$",
    ):
        assert re.search(words, said.out, re.MULTILINE), said.out
    after = {path: path.read_bytes() for path in filmed.folder.parent.rglob("*") if path.is_file()}
    assert {path: content for path, content in after.items() if ".blender" not in path.parts} == {
        path: content for path, content in before.items() if ".blender" not in path.parts
    }
    assert not (filmed.folder.parent / ".verify").exists()

    _damage(filmed)
    assert verify.run("four_bar", TINY, "1") == 1
    said = capsys.readouterr()
    for words in (
        r"solids \(STL, STEP\): differs, 1 of 10 files, such as coupler-coupler\.stl from byte 99 on",
        r"motion \(data\.json\): differs, at time\[1\]: ",
        r"frame 1: differs, 1 of 5184 pixels by up to \d+ of 255, the first at \(7, 3\)",
        r"sound \(four_bar-tiny\.wav\): differs, it cannot be rebuilt: .*time\[",
        # The encoder looks ahead, so frames before the damaged one may differ, too.
        r"film: differs, \d+ of 12 decoded frames, the first is frame [01]",
    ):
        assert re.search(words, said.err), said.err
    assert re.search(r"four_bar: 2 the same, 5 different", said.out)


def _damage(out: Out) -> None:
    """Damage a byte of a solid, a number of the motion and a pixel of frame 1."""
    solid = out.parts_folder / "coupler-coupler.stl"
    content = bytearray(solid.read_bytes())
    content[99] ^= 1
    solid.write_bytes(content)
    text = out.motion.read_text()
    out.motion.write_text(re.sub(r'("time": \[\s*[0-9.]+,\s*)([0-9.]+)', lambda m: f"{m[1]}1{m[2]}", text, count=1))
    store = FrameStore(out.frames("tiny"))
    index = jsonfile.read(store.index, FrameIndex)
    name = index.frames[1]
    with Image.open(store.folder / name) as picture:
        pixels = np.array(picture)
    pixels[3, 7] ^= 128
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="PNG")
    (store.folder / name).unlink()
    other = name_of(name.partition("-")[0], buffer.getvalue())
    (store.folder / other).write_bytes(buffer.getvalue())
    index.frames = [other if frame == name else frame for frame in index.frames]
    jsonfile.write(store.index, index)


def test_a_real_mechanism_is_solved_again(out_root: Path) -> None:
    """With the stages themselves in processes of their own; a changed number is found, and so is another input."""
    command = [sys.executable, "-m"]
    options = {"cwd": ROOT, "capture_output": True, "text": True}
    subprocess.run([*command, "mechanisms", "solve", "pendulum"], check=True, **options)
    done = subprocess.run([*command, "studio.verify", "pendulum"], **options)
    assert done.returncode == 0, done.stderr
    assert re.search(r"motion \(data\.json\): same, \d+ bytes", done.stdout)
    assert "solids: not compared, there are none" in done.stdout
    out = Out("pendulum")
    content = out.motion.read_text()
    out.motion.write_text(re.sub(r'("inputs": ")[0-9a-f]{8}', r"\g<1>00000000", content))
    done = subprocess.run([*command, "studio.verify", "pendulum"], **options)
    assert done.returncode == 1
    assert "motion (data.json): made from other inputs" in done.stderr
    assert "make run-pendulum, then again" in done.stdout


def test_missing_products_are_reported(out_root: Path) -> None:
    with pytest.raises(UserError, match=r"four_bar: .*data\.json does not exist; make run-four-bar first"):
        verify.run("four_bar", TINY)
    assert not out_root.exists()


@pytest.mark.parametrize(("words", "numbers"), [("", [0, 40, 80]), ("5", [5]), ("7, 3,7", [3, 7]), ("119 0", [0, 119])])
def test_chosen_frames(words: str, numbers: list[int]) -> None:
    assert compared_film.chosen(words, 120, "arm") == numbers


def test_few_frames_are_chosen_once() -> None:
    assert compared_film.chosen("", 1, "arm") == [0]
    assert compared_film.chosen("", 2, "arm") == [0, 1]


@pytest.mark.parametrize("words", ["120", "-1", "1.5", "x", "²"])
def test_no_such_frame(words: str) -> None:
    with pytest.raises(UserError, match=r"arm: there is no frame .*; the film has frames 0 to 119"):
        compared_film.chosen(words, 120, "arm")


def test_differences_of_files(tmp_path: Path) -> None:
    old, new = tmp_path / "a.json", tmp_path / "b.json"
    old.write_text('{"a": [1, {"b": 2}], "c": 1}')
    assert str(files.compare("a", old, new)) == "a: differs, it was not rebuilt"
    assert str(files.compare("a", new, old)) == "a: differs, it does not exist, but was rebuilt"
    for text, words in (
        ('{"a": [1, {"b": 3}], "c": 1}', "at a[1].b: 2, rebuilt 3"),
        ('{"a": [1], "c": 1}', "at a[1]: {'b': 2}, rebuilt nothing"),
        ('{"a": [1, {"b": 2}], "c": 1, "d": 0}', "at d: nothing, rebuilt 0"),
        ('{"a": [1, {"b": 2}],  "c": 1}', "in its layout"),
        ('{"a": [1, {"b"', "it is not whole JSON; from byte 14 on; 28 bytes, rebuilt 14"),
    ):
        new.write_text(text)
        assert files.compare("a", old, new).detail == words
    new.write_bytes(old.read_bytes())
    assert files.compare("a", old, new).verdict == "same"


def test_a_damaged_film_is_a_finding(tmp_path: Path) -> None:
    store, names = FrameStore(tmp_path / "tiny"), []
    store.folder.mkdir()
    for k in range(4):
        buffer = io.BytesIO()
        Image.new("RGB", (96, 54), (40 * k, 90, 160)).save(buffer, format="PNG")
        names.append(name_of(f"{k:032x}", buffer.getvalue()))
        (store.folder / names[-1]).write_bytes(buffer.getvalue())
    index = FrameIndex(mechanism="arm", preset="tiny", width=96, height=54, fps=30, frames=names)
    path = tmp_path / "arm-tiny.mp4"
    (scratch := tmp_path / "scratch").mkdir()

    def finding() -> str:
        return str(compared_film.compare_film(path, scratch, store, index, TINY))

    assert finding() == "film: not compared, arm-tiny.mp4 does not exist"
    encode.encode(((store.folder / name).read_bytes() for name in names), 4, TINY, 30, path)
    assert finding() == "film: same, 4 decoded frames, the same file"
    whole = path.read_bytes()
    path.write_bytes(whole[:-20])
    assert "film: differs" in finding()
    encode.encode(((store.folder / name).read_bytes() for name in names[:3]), 3, TINY, 30, path)
    assert finding() == "film: differs, 3 frames decode, rebuilt 4"
    (store.folder / names[2]).write_bytes(b"")
    assert finding() == f"film: differs, 1 of its pictures are gone or damaged, such as {names[2]}"
