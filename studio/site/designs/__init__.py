"""Designs that a page shows without Python: motions on a grid of main numbers, with polynomials."""

from __future__ import annotations

from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, Out, mechanism_file
from shared.stage.stages import Stage, key_of, versions

SOURCES = [ROOT / "studio" / name for name in ("site/designs", "live/child", "live/numbers.py")]


def stage_of(out: Out) -> Stage:
    """Return the stage of out/<name>/designs.bin."""
    read = out.motion, out.skeleton, mechanism_file(out.name)
    key = key_of(*read, sources_hash(*SOURCES, ROOT / "render" / "view"), versions("numpy"))
    return Stage(out, "designs", key, [out.designs])
