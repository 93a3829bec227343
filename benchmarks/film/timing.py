"""Overhead of the film: wall time of the last frames stage over Cycles' own render seconds, read from its timing."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

from benchmarks.rows import Row
from render.frames.store import Timing
from shared.stage import jsonfile
from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.paths import out_root

LARGEST_OVERHEAD = 1.10
FEWEST_FRAMES = 10
"""Below this the start of Blender, which is paid once, outweighs the frames."""


def rows_of_films() -> tuple[list[Row], list[str]]:
    """Two rows for each film rendered here (wall, Cycles), and the bars missed."""
    rows: list[Row] = []
    missed: list[str] = []
    for path in sorted(out_root().glob("*/frames/*/timing.json")):
        rows += _rows_of(path, missed)
    if not rows:
        say("bench", "no film was rendered here yet: make frames-four-bar, and the overhead is shown")
    return rows, missed


def _rows_of(path: Path, missed: list[str]) -> list[Row]:
    try:
        timing = jsonfile.read(path, Timing)
    except UserError as error:
        warn("bench", str(error))
        return []
    mechanism, frames = path.parents[2].name, timing.rendered
    print(
        f"\nfilm of {mechanism}, {timing.preset}: {frames} frames on {timing.device}, "
        f"wall {timing.wall:.1f} s, Cycles {timing.cycles:.1f} s, ratio {timing.overhead:.3f}"
    )
    if frames >= FEWEST_FRAMES and timing.preset == "preview" and timing.overhead > LARGEST_OVERHEAD:
        missed.append(f"film of {mechanism}: wall over Cycles {timing.overhead:.3f}, wanted {LARGEST_OVERHEAD}")
    problem, version = f"film of {mechanism}, {frames} frames", metadata.version("bpy")
    settings = f"{timing.preset}, {timing.device}"
    return [
        Row(problem, "mbsd frames stage", version, settings, timing.wall, 0.0),
        Row(problem, "cycles alone", version, settings, timing.cycles, 0.0),
    ]
