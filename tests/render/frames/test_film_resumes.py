"""A film that is stopped, killed or damaged while it is made goes on where it was, with the right pictures."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import psutil
import pytest

from render.blender.picture_file import fault
from render.frames import film, frames
from render.frames.store import FrameStore, Timing
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.files import file_hash
from shared.stage.paths import ROOT
from tools.fixtures import film_fixture

TINY = Preset("tiny", 96, 54, 2)


def stamps(store: FrameStore) -> dict[str, int]:
    """Pictures that are there, and when they were written; half-written ones have a dot before their names."""
    return {path.name: path.stat().st_mtime_ns for path in store.folder.glob("[!.]*.png")}


def test_a_picture_damaged_while_the_others_are_rendered_is_never_filmed(
    out_root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    """Swapped for another whole picture before the index is written, and once more while the film is."""
    out = film_fixture.write(Shot(turns=1, seconds_per_turn=0.1))
    store, render = FrameStore(out.frames("tiny")), frames.render
    ways = [lambda first, second: first.write_bytes(second.read_bytes())]

    def render_and_swap(*arguments: Any) -> None:
        render(*arguments)
        if ways:
            ways.pop()(*sorted(store.folder.glob("[!.]*.png"))[:2])

    monkeypatch.setattr(frames, "render", render_and_swap)
    film.run("four_bar", TINY)
    assert capsys.readouterr().out.count("is not the picture that was rendered any more") == 1
    content = out.film("tiny").read_bytes()

    out.film("tiny").unlink()
    encoded = store.folder / out.film("tiny").name
    encoded.unlink()  # else the film is made from the pictures as they were encoded
    done = frames.run

    def run_and_swap(*arguments: Any) -> None:
        done(*arguments)
        first, second = sorted(store.folder.glob("[!.]*.png"))[:2]
        stamp = (out.stamps / "frames-tiny.json").read_text()
        hashes = [file_hash(path) for path in (first, second)]
        first.write_bytes(second.read_bytes())  # and stamped so, as if it had happened just before the stage's end
        (out.stamps / "frames-tiny.json").write_text(stamp.replace(*hashes))

    monkeypatch.setattr(frames, "run", run_and_swap)
    with pytest.raises(UserError, match=r"four_bar: frame \d \(.*\.png\) changed or went while the film was written"):
        film.run("four_bar", TINY)
    assert not out.film("tiny").exists()
    assert not encoded.exists()
    monkeypatch.setattr(frames, "run", done)
    film.run("four_bar", TINY)
    assert out.film("tiny").read_bytes() == content


def start(preset: str) -> subprocess.Popen[bytes]:
    code = f"from render.frames import frames; from render.presets import Preset; frames.run('four_bar', {preset})"
    return subprocess.Popen(
        [sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


def wait_for(condition, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def children(of: int) -> list[int]:
    return [child.pid for child in psutil.Process(of).children()]


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL], ids=lambda s: s.name)
def test_a_film_goes_on_where_it_was_stopped(out_root: Path, how: signal.Signals, capsys: pytest.CaptureFixture[str]):
    out = film_fixture.write(Shot(turns=1, seconds_per_turn=1.0))
    store = FrameStore(out.frames("tiny"))
    process = start("Preset('tiny', 96, 54, 2)")
    wait_for(lambda: len(children(process.pid)) == 1)
    workers = children(process.pid)
    wait_for(lambda: len(stamps(store)) > 1)  # the last one may not be counted yet, and none leaves no timing
    os.kill(workers[0], signal.SIGSTOP)  # no picture more, however late the other signal comes on a busy machine
    process.send_signal(how)
    process.wait(timeout=20)
    with contextlib.suppress(ProcessLookupError):
        os.kill(workers[0], signal.SIGCONT)

    def gone() -> bool:
        try:
            os.kill(workers[0], 0)
        except ProcessLookupError:
            return True
        state = Path(f"/proc/{workers[0]}/stat")
        return state.exists() and state.read_text().rsplit(")", 1)[1].split()[0] == "Z"

    wait_for(gone, 20)
    finished = stamps(store)
    assert 1 <= len(finished) < 30
    assert not [fault(store.folder / name, 96, 54) for name in finished if fault(store.folder / name, 96, 54)]
    if how is not signal.SIGKILL:
        assert not list(store.folder.glob(".*.part.png"))
        assert not list(out_root.glob(".blender/tmp-*"))
        assert jsonfile.read(store.timing, Timing).rendered in (len(finished), len(finished) - 1)

    frames.run("four_bar", TINY)
    assert f"{30 - len(finished)} of 30 pictures to render" in capsys.readouterr().out
    assert {name: at for name, at in stamps(store).items() if name in finished} == finished
    assert len(stamps(store)) == 30
    assert not list(store.folder.glob(".*.part.png"))
    assert not list(out_root.glob(".blender/tmp-*"))
