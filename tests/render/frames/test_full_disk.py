"""A disk that is really full: a film ends in an error that says so, keeps nothing cut, and goes on later."""

from __future__ import annotations

import re
import resource
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from render.blender.picture_file import fault
from render.frames import blend, film, frames, still
from render.frames.encode import refuse_other_than
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from shared.stage.files import file_hash
from shared.stage.paths import ROOT, Out
from tools.fixtures import film_fixture

TINY = Preset("tiny", 96, 54, 1)
SHORT = Shot(turns=2, seconds_per_turn=0.2, trails=(), labels=())


@pytest.fixture
def small_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Out]:
    """The files of a film on a disk of 2 MB in memory."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "none", str(disk)], capture_output=True)
    if mounted.returncode:
        pytest.skip("only root can mount a small disk; the limit on file size below tests the same")
    try:
        monkeypatch.setenv("MBSD_OUT", str(disk / "out"))
        monkeypatch.setattr(frames, "RESERVE", -1e9)  # or the film is refused before it starts
        out = film_fixture.write(SHORT)
        monkeypatch.setattr("render.blender.child.out_root", lambda: tmp_path / "elsewhere")  # Blender's own files
        yield out
    finally:
        subprocess.run(["umount", "-l", str(disk)], check=True)


def fill(out: Out, free: int) -> Path:
    """Leave so many bytes free; the file to remove afterwards."""
    ballast = out.folder.parent / "ballast"
    ballast.write_bytes(bytes(shutil.disk_usage(out.folder).free - free))
    return ballast


def whole(out: Out) -> list[Path]:
    pictures = sorted(out.frames("tiny").glob("*.png"))
    assert not [path for path in pictures if fault(path, 96, 54)]
    return pictures


def test_pictures(small_disk: Out):
    out, ballast = small_disk, fill(small_disk, 40 * 1024)  # room for a few pictures of 9 kB
    with pytest.raises(
        UserError, match=r"frame \d: cannot write .*: No space left on device; free some .*It may need 0\.0 MB"
    ):
        film.run("four_bar", TINY)
    made = whole(out)
    assert 1 <= len(made) < 6
    assert not list(out.frames("tiny").glob(".*.png"))
    assert not out.film("tiny").exists()
    before = {path: path.stat().st_mtime_ns for path in made}
    ballast.unlink()
    film.run("four_bar", TINY)
    assert len(whole(out)) == 6
    assert {path: path.stat().st_mtime_ns for path in made} == before  # none of them was rendered again
    refuse_other_than(out.film("tiny"), "film", film_ffmpeg(), 12, TINY, 30, 60.0)


def film_ffmpeg() -> str:
    from render.frames import encode

    return encode.ffmpeg()


def test_the_film(small_disk: Out):
    out = small_disk
    frames.run("four_bar", TINY)
    ballast = fill(out, 4096)
    with pytest.raises(UserError, match=r"tiny\.mp4: (ffmpeg failed: .*MB are free|the film does not decode)"):
        film.run("four_bar", TINY)
    assert not [*out.film("tiny").parent.glob("*"), *out.frames("tiny").glob("*.mp4*")]
    ballast.unlink()
    film.run("four_bar", TINY)
    refuse_other_than(out.film("tiny"), "film", film_ffmpeg(), 12, TINY, 30, 60.0)


def test_poster_and_scene(small_disk: Out):
    out = small_disk
    frames.run("four_bar", TINY)
    ballast = fill(out, 4096)
    with pytest.raises(UserError, match="No space left on device"):
        still.poster("four_bar", TINY)
    assert not out.poster.exists()
    with pytest.raises(UserError, match=r"four_bar\.blend: cannot write .*: No space left on device"):
        blend.save("four_bar", TINY)
    assert not list(out.folder.glob("*.blend*"))
    ballast.unlink()
    still.poster("four_bar", TINY)
    blend.save("four_bar", TINY)
    assert not fault(out.poster, 96, 54)


@pytest.mark.parametrize("stage", ["film", "scene"])
def test_a_limit_on_the_size_of_files(out_root: Path, stage: str):
    """The same through a limit that needs no rights: Blender's own files may have 60 kB, a picture has 90."""
    out = film_fixture.write(SHORT)
    motion = file_hash(out.motion)
    code = (
        "from shared.stage.console import run_cli; from render.frames import blend, film\n"
        "from render.presets import Preset\n"
        "preset = Preset('tiny', 384, 216, 1)\n"
        f"run_cli(lambda: {'film.run' if stage == 'film' else 'blend.save'}('four_bar', preset) and None)"
    )

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, 60_000))

    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, preexec_fn=limited, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 1
    name = "frame 0" if stage == "film" else "four_bar.blend"
    assert re.search(
        rf"^error: {name}: cannot write .*: File too large; free some disk space", done.stderr, re.MULTILINE
    )
    assert "Traceback" not in done.stderr
    assert not list(out_root.rglob("*.part.*")) + list(out_root.rglob("tmp-*")) + list(out_root.rglob("*.mp4"))
    assert not list(out.folder.rglob("*.png")) + list(out.folder.rglob("*.blend"))
    assert file_hash(out.motion) == motion


@pytest.mark.parametrize("file", ["step", "stl"])
def test_a_solid_that_the_cad_kernel_cuts_short_is_refused(file: str):
    """Its writers say nothing of a full disk either; a cut STEP went unnoticed."""
    code = (
        "import cadquery, resource\n"
        "from mechanisms.stages.parts_files import step_bytes, stl_bytes\n"
        "from shared.stage.console import run_cli\n"
        "solid = cadquery.Workplane().box(10, 10, 10).val()\n"
        "write = {'step': lambda: step_bytes(solid, 'a'), 'stl': lambda: stl_bytes(solid)}\n"
        f"assert len(write['{file}']()) > 600\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500))\n"
        f"run_cli(lambda: write['{file}']() and None)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1
    assert f"error: the CAD kernel wrote 500 bytes of solid.{file} and no more; " in done.stderr
    assert "free some disk space or set TMPDIR" in done.stderr
