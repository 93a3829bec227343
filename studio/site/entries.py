"""Entries of the site: words on each mechanism, its purposes as filters, and the files it offers."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from render.freshness import current_clearance
from render.gallery import sentences
from render.insights import insights
from render.report import description
from render.report.facts import facts
from render.view.payload import title_of
from shared.contract import AnyMotion, Motion, Motion3, read_any_motion, read_parts
from shared.stage.files import write_bytes
from shared.stage.paths import Out, mechanism_file

# Purposes of a mechanism as filters of the wall, from its docstring and the kinds of data.json.


WORDS = {
    "walks": r"\bwalk",
    "lifts": r"\blift",
    "locks": r"\block|\bdwell|\brests? while|toggle",
    "turns into straight": r"straight",
    "clamps and presses": r"\bclamp|\bpress",
    "quick return": r"quick return|quick-return|returns? (?:faster|quickly)",
    "drives a vehicle": r"\bsteer|\bcar\b|\bwheel rolls|\bvehicle|\bbicycle",
    "swings": r"\bpendul|\bswings?\b",
    "shakes": r"\bvibrat|\bshak|\bbalanc",
    "human body": r"\bthigh|\bknee|\bathlete|\bhip\b",
}
"""Purposes, and how a docstring speaks of them."""
ENGINE = re.compile(r"\bengine\b|\bcylinder", re.IGNORECASE)
KINDS = {
    "gears": ("gear", "rack"),
    "belts and chains": ("belt", "chain"),
    "cams": ("cam", "geneva", "curve"),
    "springs": ("spring",),
    "impacts": ("impact", "contact", "limit"),
}
"""Parts of machines, by what the names of kinds in data.json begin with or hold."""
COMMON = 2
"""A filter of fewer machines is none."""


def purposes(name: str, said: str, motion: AnyMotion) -> list[str]:
    """Return the filters that match a mechanism, in the order of the lists above."""
    text = f"{name.replace('_', ' ')}. {said}"
    out = [purpose for purpose, pattern in WORDS.items() if re.search(pattern, text, re.IGNORECASE)]
    if ENGINE.search(text):
        out.append("engines")
    if isinstance(motion, Motion3):
        out.append("moves in space")
    things = (motion.joints, motion.drivers, motion.forces, getattr(motion, "contacts", {}))
    kinds = {thing.kind for group in things for thing in group.values()}
    out += [part for part, stems in KINDS.items() if any(stem in kind for kind in kinds for stem in stems)]
    return out


def filters(purposes_of: dict[str, list[str]]) -> list[str]:
    """Return purposes that at least COMMON mechanisms have, the most common ones first."""
    counts: dict[str, int] = {}
    for each in purposes_of.values():
        for purpose in each:
            counts[purpose] = counts.get(purpose, 0) + 1
    return sorted((purpose for purpose in counts if counts[purpose] >= COMMON), key=lambda word: (-counts[word], word))


def neighbours(name: str, purposes_of: dict[str, list[str]], most: int = 4) -> list[str]:
    """Return the mechanisms that share most with this one.

    Of equals those with fewer purposes of their own come first, then by name.
    """
    ours = set(purposes_of[name])

    def likeness(other: str) -> float:
        theirs = set(purposes_of[other])
        return len(ours & theirs) / max(1, len(ours | theirs))

    others = sorted((other for other in purposes_of if other != name), key=lambda other: (-likeness(other), other))
    return others[:most]


# Files of a mechanism that its page offers: copies, and folders as one reproducible ZIP.


LARGEST = 40_000_000
"""Bytes of a download; what is larger stays at home."""
EPOCH = 1980, 1, 1, 0, 0, 0


@dataclass(frozen=True)
class Download:
    """File beside the page, and its description."""

    file: str
    words: str
    size: int


def write_downloads(name: str, folder: Path, is_of_now: Callable[[Path], bool]) -> list[Download]:
    """Copy current files of a mechanism into ``folder``; outdated ones are removed."""
    out, written = Out(name), []
    for file, words, content in _offered(out, mechanism_file(name), is_of_now):
        if len(content) > LARGEST:
            continue
        path = folder / file
        if not path.is_file() or path.read_bytes() != content:
            write_bytes(path, content)
        written.append(Download(file, words, len(content)))
    for older in set(folder.glob("*")) - {folder / each.file for each in written}:
        older.unlink()
    return written


def _offered(out: Out, source: Path, is_of_now: Callable[[Path], bool]) -> Iterator[tuple[str, str, bytes]]:
    yield source.name, "the model, Python", source.read_bytes()
    singles = ((out.motion, "the motion, JSON"), (out.glb, "parts in motion, glTF"), (out.report, "the report"))
    for path, words in singles:
        if path.is_file() and is_of_now(path):
            yield path.name, words, path.read_bytes()
    folders = (
        (out.parts_folder, "*.stl", f"{out.name}_stl.zip", "parts, STL"),
        (out.parts_folder, "*.step", f"{out.name}_step.zip", "parts, STEP"),
        (out.print_folder, "*.3mf", f"{out.name}_3mf.zip", "plates to print, 3MF"),
        (out.print_folder, "*.dxf", f"{out.name}_dxf.zip", "outlines to cut, DXF"),
    )
    for folder, pattern, file, words in folders:
        if (paths := sorted(folder.glob(pattern))) and all(map(is_of_now, paths)):
            yield file, words, _zipped(paths)


def _zipped(paths: list[Path]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in paths:
            entry = zipfile.ZipInfo(path.name, EPOCH)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, path.read_bytes())
    return buffer.getvalue()


# Entries of the site: what it says of each mechanism, read from its files.


INSIGHTS = 5
"""Insights on the page of a mechanism, at most."""


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
    article: str = ""
    insights: list[str] = field(default_factory=list)
    has_sliders: bool = False
    downloads: list[Download] = field(default_factory=list)
    neighbours: list[str] = field(default_factory=list)


def entry_of(name: str) -> Entry:
    """Return the entry of a mechanism with a motion. Raises UserError for unreadable files."""
    out = Out(name)
    motion = read_any_motion(out.motion, name)
    parts = read_parts(out.parts, name) if out.parts.is_file() else None
    clearance = current_clearance(out, parts, "site")
    text = description(name)
    telling = insights(motion)[:INSIGHTS] if isinstance(motion, Motion) else []
    shows = [each.sentence() for each in telling]
    known = facts(motion, parts, clearance)
    return Entry(name, title_of(name), sentences(text), known, purposes(name, text, motion), insights=shows)
