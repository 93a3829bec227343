"""`python -m render gallery`: docs/gallery/, a page with every mechanism that has a poster."""

from __future__ import annotations

import io
import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from render.freshness import Freshness, current_clearance
from render.report import description
from render.report.facts import facts
from shared.contract import read_any_motion, read_parts
from shared.contract.quantity import counted
from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, Out, in_workshop, mechanism_file, mechanism_names, out_root

# Posters for a web page: small JPEGs, and all of them in one.

WIDTH = 960
LARGEST = 120_000
"""Bytes."""
QUALITIES = (88, 82, 76, 70, 62, 54, 45)
TILE = 320, 180
"""Pixels of a picture in the strip."""
BESIDE = 4
"""Pictures in a row of it."""
ON_STRIP = 16
LOOK = 24, 14
"""Pixels in which two pictures are compared."""


def small_poster(path: Path) -> bytes:
    """Return a picture as a JPEG of at most LARGEST bytes, at the best quality that fits."""
    from PIL import Image

    with Image.open(path) as whole:
        picture = whole.convert("RGB")
    content = b""
    for width in (WIDTH, 3 * WIDTH // 4, WIDTH // 2):
        small = picture
        if picture.width > width:
            size = width, round(width * picture.height / picture.width)
            small = picture.resize(size, Image.Resampling.LANCZOS)
        for quality in QUALITIES:
            buffer = io.BytesIO()
            small.save(buffer, format="JPEG", quality=quality, optimize=True, progressive=True)
            content = buffer.getvalue()
            if len(content) <= LARGEST:
                return content
    return content


def strip(posters: Sequence[bytes]) -> bytes:
    """Return small posters in rows, as one JPEG; the last row is filled from its middle.

    More than ``ON_STRIP`` are too many for one look: those are taken that are least like each other.
    """
    from PIL import Image, ImageOps

    wide, high = TILE
    tiles = [ImageOps.fit(Image.open(io.BytesIO(poster)), TILE, Image.Resampling.LANCZOS) for poster in posters]
    tiles = [tiles[k] for k in unlike([np.asarray(tile.convert("RGB").resize(LOOK), float) for tile in tiles])]
    rows = math.ceil(len(tiles) / BESIDE)
    sheet = Image.new("RGB", (BESIDE * wide, rows * high), tiles[0].getpixel((2, 2)))
    for row in range(rows):
        beside = tiles[row * BESIDE : (row + 1) * BESIDE]
        left = (BESIDE - len(beside)) * wide // 2
        for k, tile in enumerate(beside):
            sheet.paste(tile, (left + k * wide, row * high))
    content = b""
    for quality in QUALITIES:
        buffer = io.BytesIO()
        sheet.save(buffer, format="JPEG", quality=quality, optimize=True, progressive=True)
        content = buffer.getvalue()
        if len(content) <= 2 * LARGEST:
            break
    return content


def unlike(looks: Sequence[np.ndarray]) -> list[int]:
    """Return numbers of ON_STRIP pictures, each next one least like all that are chosen already."""
    flat = np.stack([look.ravel() for look in looks])
    if len(flat) <= ON_STRIP:
        return list(range(len(flat)))
    taken = [int(((flat - flat.mean(axis=0)) ** 2).sum(axis=1).argmax())]
    while len(taken) < ON_STRIP:
        off = ((flat[:, None] - flat[taken]) ** 2).sum(axis=2).min(axis=1)
        taken.append(int(off.argmax()))
    return sorted(taken)


# The page of the gallery, Markdown: a poster, what to see in it, the numbers that matter.

LONGEST = 2
"""Sentences of each."""
UNSAID = ("SI units.", "SI units and radians.")


@dataclass(frozen=True)
class Entry:
    """One mechanism."""

    name: str
    said: str
    facts: list[str]
    file: str
    """Its mechanism.py, seen from the page."""


def page(entries: Sequence[Entry], own: bool = False) -> str:
    """Return the whole page, in the order of the names; ``own``: of the machines of a user's own folder."""
    first = [
        "Every mechanism of `mechanisms/`, each from one short file. `mbsd run <name>` makes the film, the parts and",
        "the numbers of one; `make gallery` makes this page.",
    ]
    lines = ["# Gallery", "", *([f"`{to_run('gallery')}` makes this page."] if own else first)]
    for entry in entries:
        title = entry.name.replace("_", " ")
        title = title[:1].upper() + title[1:]
        lines += ["", f"## {title}", f"![{title}]({entry.name}.jpg)\\"]
        lines += [f"{entry.said}\\"] if entry.said else []
        page_of = f"`{to_run('view', entry.name)}`" if own else f"[the page](../view.md): `mbsd view {entry.name}`"
        lines += [f"{' · '.join(entry.facts)} · [{entry.file.rpartition('/')[2]}]({entry.file}) · {page_of}"]
    return "\n".join(lines) + "\n"


def sentences(docstring: str) -> str:
    """Return the first two sentences of a docstring on one line; what all of them say is left out."""
    paragraph = " ".join(docstring.split("\n\n")[0].split())
    said = [
        sentence
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z0-9])", paragraph)
        if sentence and sentence not in UNSAID
    ]
    return " ".join(said[:LONGEST])


# ``python -m render gallery``: docs/gallery/, a page with every mechanism that has a poster.

FOLDER = out_root() / "gallery" if in_workshop() else ROOT / "docs" / "gallery"
STRIP = "strip.jpg"
"""All posters in one picture, for the README."""


def run(folder: Path = FOLDER) -> int:
    """Write README.md, a poster of each mechanism and some of them in one picture.

    Posters of mechanisms that are gone are deleted. Returns 1 if a mechanism is left out, because it has no poster, or
    one of an older version. Raises UserError if none has one.
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
        motion = read_any_motion(out.motion, name)
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
