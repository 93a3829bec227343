"""``python -m benchmarks film``: the table of what a film costs in docs/benchmarks.md, each row a ratio of one run.

--name four_bar --preset preview --frames 60    the film; the bars are meant for these, which take long on two cores
--only noop                                     rows by their first word: overhead, plates, plain, resumed, cores, noop
"""

from __future__ import annotations

import argparse
import functools
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks.film.runs import Film, ended, refuse
from benchmarks.rows import Bar
from render.presets import Preset, preset_named
from shared.stage.console import duration, say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, Out, mechanism_names
from tools.documents.pages import between, replaced

PAGE = ROOT / "docs" / "benchmarks.md"
BEGIN, END = "<!-- rows of make bench-film -->", "<!-- end of bench-film -->"
OF_PLAIN = 4
"""Frames of the plain script, and whole frames, that are measured; each takes the same."""
TURNS = 3
"""Turns of the film; a plain script renders each of them."""


def measured(words: Sequence[str]) -> int:
    """Measure, show, and write the table; 1 if a bar is missed. Raises UserError if there is nothing to film."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks film", description=__doc__)
    parser.add_argument("--name", default="four_bar")
    parser.add_argument("--preset", default="preview")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--only", default=",".join(ROWS))
    asked = parser.parse_args(words)
    preset, bars = preset_named(asked.preset), []
    for word in asked.only.split(","):
        if word not in ROWS:
            raise UserError(f"bench: there is no row {word!r}; there is: {', '.join(ROWS)}")
        with tempfile.TemporaryDirectory(prefix="mbsd-bench-") as folder:
            bars.append(ROWS[word](asked.name, preset, asked.frames, Path(folder)))
        _write(bars[-1:])
        say("bench-film", f"{'met' if bars[-1].met else 'missed'}: {bars[-1]} ({bars[-1].settings})")
    return 0 if all(bar.met for bar in bars) else 1


def overhead(name: str, preset: Preset, frames: int, folder: Path) -> Bar:
    """Wall time of the frames stage over the seconds inside Cycles."""
    wall, cycles = _whole(name, preset, frames)
    settings = f"{preset.name}, {frames} frames, {duration(wall)}"
    return _at_most("frames stage, from start to exit", 1.03, wall / cycles, "Cycles' own seconds", settings)


def plates(name: str, preset: Preset, frames: int, folder: Path) -> Bar:
    """Wall time of the frames stage, which renders what changes, over that of its frames rendered whole."""
    own, _ = _whole(name, preset, frames)
    each = Film(name, preset, frames, folder).whole(min(OF_PLAIN, frames))
    settings = f"{preset.name}, {frames} frames, {own / frames:.1f} s against {each:.1f} s a frame"
    return _at_most("frames that render what changes", 0.45, own / (frames * each), "whole frames", settings)


def plain(name: str, preset: Preset, frames: int, folder: Path) -> Bar:
    """A plain Blender script that renders every frame of three turns, against the frames stage."""
    own, _ = _whole(name, preset, frames)
    start, each = Film(name, preset, frames, folder).plain(min(OF_PLAIN, frames))
    script = start + TURNS * frames * each
    settings = f"{preset.name}, {TURNS} x {frames} frames, {each:.1f} s a frame against {own / frames:.1f} s a picture"
    return Bar("a plain Blender script", 4.0, script / own, "frames stage", settings, script >= 4.0 * own)


def resumed(name: str, preset: Preset, frames: int, folder: Path) -> Bar:
    """Time the rest of a run after a SIGKILL at half of the pictures, against the whole."""
    cut = Film(name, preset, frames, folder)
    seconds, _ = _whole(name, preset, frames)
    cut.run_half()
    rest = cut.run()
    settings = f"{preset.name}, {frames} frames, {duration(seconds)}"
    return _at_most("a run resumed at 50 % after SIGKILL", 0.52, rest / seconds, "the whole run", settings)


def cores(name: str, preset: Preset, frames: int, folder: Path) -> Bar:
    """One process on one core against two processes on a core each, which share the frames."""
    if not hasattr(os, "sched_setaffinity") or len(os.sched_getaffinity(0)) < 2:
        raise UserError("bench: two workers need two cores and a system that binds processes to them (Linux)")
    first, second, *_ = sorted(os.sched_getaffinity(0))
    alone, left, right = (Film(name, preset, frames, folder / word) for word in ("alone", "left", "right"))
    single = alone.run([first], range(frames))
    begun = time.perf_counter()
    halves = [left.start([first], range(0, frames, 2)), right.start([second], range(1, frames, 2))]
    with ended(*halves):
        for half in halves:
            refuse(half.wait())
    two = time.perf_counter() - begun
    settings = f"{preset.name}, {frames} frames, {duration(single)} and {duration(two)}"
    return Bar("two workers on separate cores", 1.8, single / two, "one worker", settings, single >= 1.8 * two)


def noop(name: str, preset: Preset, frames: int, folder: Path) -> Bar:
    """``make all`` where all films are there."""
    names = [name for name in mechanism_names() if Out(name).film(preset.name).is_file()]
    if not names:
        raise UserError(f"bench: no mechanism has its film at {preset.name}; make all PRESET={preset.name} makes them")
    command = [sys.executable, "-m", "studio.night", "run", "--preset", preset.name, f"--only={','.join(names)}"]
    refuse(subprocess.run(command, cwd=ROOT, capture_output=True).returncode)  # what is missing is made
    begun = time.perf_counter()
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    seconds = time.perf_counter() - begun
    refuse(done.returncode, done.stderr)
    settings = f"{preset.name}, {len(names)} of {len(mechanism_names())} mechanisms"
    return _at_most("make all with nothing to do, s", 5.0, seconds, "", settings)


ROWS: dict[str, Callable[[str, Preset, int, Path], Bar]] = {
    "overhead": overhead,
    "plates": plates,
    "plain": plain,
    "resumed": resumed,
    "cores": cores,
    "noop": noop,
}


@functools.cache
def _whole(name: str, preset: Preset, frames: int) -> tuple[float, float]:
    """Seconds of a whole run, and those of them inside Cycles; made once for all rows."""
    with tempfile.TemporaryDirectory(prefix="mbsd-bench-") as folder:
        film = Film(name, preset, frames, Path(folder))
        return film.run(), film.timing().cycles


def _at_most(problem: str, wanted: float, reached: float, peer: str, settings: str) -> Bar:
    return Bar(problem, wanted, reached, peer, settings, reached <= wanted, most=True)


def _write(bars: Sequence[Bar]) -> None:
    """Rows measured now; those of other problems stay as they are."""
    page = PAGE.read_text()
    rows = {line.split("|")[1].strip(): line for line in between(page, BEGIN, END).strip().splitlines()[2:]}
    for bar in bars:
        wanted = f"at most {bar.wanted:g}" if bar.most else f"{bar.wanted:g}x"
        reached = f"{bar.reached:.3g}{'' if bar.most else 'x'}"
        met = "yes" if bar.met else "**no**"
        rows[bar.problem] = f"| {bar.problem} | {wanted} | {reached} | {bar.peer} | {bar.settings} | {met} |"
    lines = ["| what | asked for | reached | against | settings | met |", "|---|---|---|---|---|---|", *rows.values()]
    write_bytes(PAGE, replaced(page, BEGIN, END, "\n".join(lines)).encode())
