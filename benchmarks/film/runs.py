"""Films of so many frames in scratch, and processes that render them."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import msgspec

from render.film.inputs import read_film
from render.frames.frames import Pictures, Tally, render
from render.frames.store import FrameStore, Timing
from render.presets import Preset
from shared.contract.shot import read_shot, write_shot
from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from shared.stage.signals import terminable
from studio.verify.again import preset_words


class Film:
    """A copy of a mechanism's motion, parts and shot below ``folder``, with a film of ``frames`` pictures."""

    def __init__(self, name: str, preset: Preset, frames: int, folder: Path) -> None:
        self.name, self.preset, self.frames, self.root = name, preset, frames, folder / "out"
        made = Out(name)
        if not (made.motion.is_file() and made.parts.is_file() and made.shot.is_file()):
            raise UserError(f"bench: {name} has no motion, parts or shot yet; make poster-{name.replace('_', '-')}")
        copy = self.root / name
        shutil.copytree(made.parts_folder, copy / "parts")
        shutil.copy(made.motion, copy / "data.json")
        shot = read_shot(made.shot)
        write_shot(copy / "shot.json", msgspec.structs.replace(shot, seconds_per_turn=frames / shot.fps))

    @property
    def store(self) -> FrameStore:
        """Its pictures."""
        return FrameStore(self.root / self.name / "frames" / self.preset.name)

    def pictures(self) -> int:
        """How many are there."""
        return len(list(self.store.folder.glob("[!.]*.png")))

    def start(self, cores: Sequence[int] = (), only: Sequence[int] = ()) -> subprocess.Popen[bytes]:
        """The frames stage in a process of its own, on some cores alone; ``only`` some of its frames."""
        command = [sys.executable, "-m", "render", "frames", self.name, "--preset", self.preset.name]
        if only:
            numbers = ",".join(map(str, only))
            command = [sys.executable, "-m", "studio.verify.again", self.name, preset_words(self.preset), numbers, ""]
        return subprocess.Popen(
            command,
            cwd=ROOT,
            env=os.environ | {"MBSD_OUT": str(self.root)},
            stdout=subprocess.DEVNULL,
            start_new_session=True,
            preexec_fn=(lambda: os.sched_setaffinity(0, cores)) if cores else None,
        )

    def run(self, cores: Sequence[int] = (), only: Sequence[int] = ()) -> float:
        """Seconds from start to end; raises UserError if it fails."""
        begun = time.perf_counter()
        with ended(self.start(cores, only)) as process:
            refuse(process.wait())
        return time.perf_counter() - begun

    def run_half(self) -> float:
        """Kill the stage as a power cut does when half of the pictures are there; seconds until then."""
        begun = time.perf_counter()
        with ended(self.start()) as process:
            while self.pictures() < self.frames // 2:
                if process.poll() is not None:
                    refuse(process.returncode or 1)
                time.sleep(0.02)
        return time.perf_counter() - begun

    def timing(self) -> Timing:
        """Timing of the last run."""
        return jsonfile.read(self.store.timing, Timing)

    def whole(self, count: int) -> float:
        """Seconds inside Blender's renderer for each of ``count`` frames that are rendered whole."""
        with _results_in(self.root):
            film = read_film(Out(self.name), aspect=self.preset.aspect)
            store, tally = FrameStore(self.store.folder.with_name("whole")), Tally()
            step = max(1, self.frames // count)
            with store.locked():
                pictures = Pictures(film, self.preset, whole=True)
                render(pictures, store, range(0, step * count, step), "whole", tally)
        return tally.cycles / tally.rendered

    def plain(self, count: int) -> tuple[float, float]:
        """Seconds of a plain script until its first frame, and for each of ``count`` frames."""
        with _results_in(self.root):
            film = read_film(Out(self.name), aspect=self.preset.aspect)
        folder = self.root / "plain"
        folder.mkdir(exist_ok=True)
        step = max(1, self.frames // count)
        job = Pictures(film, self.preset).job(range(0, step * count, step), self.store)
        paper = folder / "job.json"
        paper.write_bytes(msgspec.json.encode(job))
        command = [sys.executable, "-m", "benchmarks.film.plain", str(paper), str(folder)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        refuse(done.returncode, done.stderr)
        # Blender's own lines are flushed by C at the exit, after Python's unless that is unbuffered.
        measured = json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))
        return measured["start"], sum(measured["each"]) / len(measured["each"])


@contextmanager
def ended(*processes: subprocess.Popen[bytes]) -> Iterator[subprocess.Popen[bytes]]:
    """Yield the first; all are killed with the block, as a power cut ends them. Blender ends with its stage."""
    try:
        with terminable():
            yield processes[0]
    finally:
        for process in processes:
            if process.poll() is None:
                process.kill()
            process.wait()


@contextmanager
def _results_in(folder: Path) -> Iterator[None]:
    before = os.environ.get("MBSD_OUT", "")
    os.environ["MBSD_OUT"] = str(folder)
    try:
        yield
    finally:
        os.environ["MBSD_OUT"] = before


def refuse(code: int, said: str = "") -> None:
    """Raise UserError if a process has failed."""
    if code:
        raise UserError(f"bench: rendering failed with code {code}: {said.strip()[-300:]}")
