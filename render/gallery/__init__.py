"""``python -m render gallery``: docs/gallery/, a page with every mechanism that has a poster."""

from __future__ import annotations

import os
from pathlib import Path

from render.freshness import Freshness, current_clearance
from render.gallery.page import Entry, page, sentences
from render.gallery.posters import small_poster, strip
from render.report import description
from render.report.facts import facts
from shared.contract import read_motion, read_parts
from shared.contract.quantity import counted
from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, Out, in_workshop, mechanism_file, mechanism_names, out_root

FOLDER = out_root() / "gallery" if in_workshop() else ROOT / "docs" / "gallery"
STRIP = "strip.jpg"
"""All posters in one picture, for the README."""


def run(folder: Path = FOLDER) -> int:
    """Write README.md, a poster of each mechanism and some of them in one; posters of mechanisms that are gone go.

    Returns 1 if a mechanism is left out, because it has no poster, or one of an older version. Raises UserError if none
    has one.
    """
    entries, posters = [], {}
    names = mechanism_names()
    freshness = Freshness(names)
    for name in names:
        out = Out(name)
        if not (out.poster.is_file() and out.motion.is_file()):
            warn("gallery", f"{name} is left out: it has no poster; {to_run('poster', name)}")
            continue
        if why := freshness.why_older(out, out.poster):
            warn("gallery", f"{name} is left out: its poster is of an older version: {why}; {to_run('poster', name)}")
            continue
        motion = read_motion(out.motion, name)
        parts = read_parts(out.parts, name) if out.parts.is_file() else None
        clearance = current_clearance(out, parts, "gallery")
        posters[f"{name}.jpg"] = small_poster(out.poster)
        place = os.path.relpath(mechanism_file(name), folder)
        entries.append(Entry(name, sentences(description(name)), facts(motion, parts, clearance), place))
    if not entries:
        raise UserError(f"no mechanism has a poster; run {to_run('gallery')}, which makes them")
    posters[STRIP] = strip(list(posters.values()))
    for file, content in posters.items():
        if not (folder / file).is_file() or (folder / file).read_bytes() != content:
            write_bytes(folder / file, content)
    for older in set(folder.glob("*.jpg")) - {folder / file for file in posters}:
        older.unlink()
    write_bytes(folder / "README.md", page(entries, in_workshop()).encode())
    size = max(map(len, posters.values())) / 1000
    say("gallery", f"{counted(len(entries), 'mechanism')} in {folder / 'README.md'}, pictures up to {size:.0f} kB")
    return int(len(entries) < len(names))
