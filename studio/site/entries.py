"""Entries of the site: what it says of each mechanism, read from its files."""

from __future__ import annotations

from dataclasses import dataclass, field

from render.freshness import current_clearance
from render.gallery import sentences
from render.report import description
from render.report.facts import facts
from render.view.payload import title_of
from shared.contract import read_motion, read_parts
from shared.stage.paths import Out
from studio.site.downloads import Download
from studio.site.purposes import purposes


@dataclass
class Entry:
    """Entry of one mechanism. ``picture`` and ``loop`` are files in its folder of the site."""

    name: str
    title: str
    said: str
    facts: list[str]
    purposes: list[str]
    picture: str = ""
    loop: str = ""
    film: str = ""
    has_sliders: bool = False
    downloads: list[Download] = field(default_factory=list)
    neighbours: list[str] = field(default_factory=list)


def entry_of(name: str) -> Entry:
    """Return the entry of a mechanism with a motion. Raises UserError for unreadable files."""
    out = Out(name)
    motion = read_motion(out.motion, name)
    parts = read_parts(out.parts, name) if out.parts.is_file() else None
    clearance = current_clearance(out, parts, "site")
    text = description(name)
    return Entry(name, title_of(name), sentences(text), facts(motion, parts, clearance), purposes(name, text, motion))
