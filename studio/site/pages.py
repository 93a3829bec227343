"""HTML of the site: the wall, and the page of a mechanism. They can be read without scripts."""

from __future__ import annotations

import base64
import re
import subprocess
import sys
from collections.abc import Sequence
from html import escape
from pathlib import Path

from render.frames.encode import run_ffmpeg
from render.frames.story.stage import film_of as story_of
from render.presets import PRESETS
from render.view.bundle import bundle, sources_key
from render.view.document import document, encode, sketch
from render.view.payload import read_payload
from shared.contract import is_in_space
from shared.contract.quantity import counted
from shared.stage.console import warn
from shared.stage.files import sources_hash, whole_file, write_bytes
from shared.stage.paths import ROOT, Out
from shared.stage.stages import Stage, key_of
from studio.site.designs import SOURCES, stage_of
from studio.site.entries import Entry

# Short silent film on the wall: from the mechanism's film, else from its moving skeleton.


WIDTH, HEIGHT = 480, 270
SECONDS = 12.0
LOOP_PATIENCE = 600.0
"""Seconds in which ffmpeg has to make a loop."""


def films_of(out: Out) -> list[Path]:
    """Return the existing loops, the finest preset first."""
    return [path for preset in reversed(list(PRESETS)) if (path := out.film(preset)).is_file()]


def page_films(out: Out) -> list[Path]:
    """Return films for a mechanism's own page, the best first: of each preset the story, the loop."""
    films = (path for preset in reversed(list(PRESETS)) for path in (story_of(out, preset), out.film(preset)))
    return [path for path in films if path.is_file()]


def write_loop(film: Path, target: Path) -> None:
    """Write a film in the size of a tile, without sound, cut after SECONDS.

    The same film gives the same bytes.

    Raises UserError.
    """
    fitted = f"scale={WIDTH}:{HEIGHT}:force_original_aspect_ratio=increase,crop={WIDTH}:{HEIGHT},format=yuv420p"
    options = (
        *("-t", f"{SECONDS:g}", "-an", "-sn", "-vf", fitted, "-r", "30"),
        *("-c:v", "libx264", "-preset", "slow", "-crf", "30", "-threads", "1", "-movflags", "+faststart"),
        *("-map_metadata", "-1", "-map_chapters", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", "mp4"),
    )
    _run(film, target, options)


def write_still(film: Path, target: Path) -> None:
    """Write a picture of a film after a third of a second, as a JPEG twice a tile's size.

    Raises UserError.
    """
    fitted = f"scale={2 * WIDTH}:{2 * HEIGHT}:force_original_aspect_ratio=increase,crop={2 * WIDTH}:{2 * HEIGHT}"
    _run(film, target, ("-ss", "0.3", "-frames:v", "1", "-vf", fitted, "-q:v", "4", "-f", "mjpeg"))


def _run(film: Path, target: Path, options: tuple[str, ...]) -> None:
    with whole_file(target) as part:
        run_ffmpeg(film.name, "-i", str(film), *options, str(part), patience=LOOP_PATIENCE)


HEAD = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<meta name="description" content="{said}">
<link rel="icon" href="data:,">
<link rel="stylesheet" href="{root}site.css">
</head>
<body>
"""
KILO = 1000


def _prose(said: str) -> str:
    """Return words of a docstring as HTML, with text in backticks as code."""
    return re.sub(r"`+([^`]+)`+", r"<code>\1</code>", escape(said))


def wall(title: str, entries: Sequence[Entry], filters: Sequence[str]) -> str:
    """Return index.html: a tile for each mechanism, with search and filters."""
    tiles = "\n".join(_tile(entry, k) for k, entry in enumerate(entries))
    buttons = "\n".join(
        f'<button type="button" aria-pressed="false" data-purpose="{escape(purpose)}">{escape(purpose)}</button>'
        for purpose in filters
    )
    said = f"{counted(len(entries), 'machine')} in motion, with their forces, parts and numbers to move"
    head = HEAD.format(title=escape(title), said=escape(said), root="")
    return f"""{head}<header>
<h1>{escape(title)}</h1>
<input class="search" type="search" placeholder="Search" aria-label="Search machines" autocomplete="off">
<button type="button" class="theme">Dark</button>
</header>
<main>
<div class="filters" role="group" aria-label="What a machine does">
{buttons}
</div>
<p class="count" role="status">{counted(len(entries), "machine")}</p>
<ul class="wall">
{tiles}
</ul>
</main>
<footer>Each machine is a short Python file; mbsd computes its motion, forces, parts and pictures from it.</footer>
<script src="theme.js"></script>
<script src="loops.js"></script>
<script src="wall.js"></script>
</body>
</html>
"""


def machine(entry: Entry, others: Sequence[Entry]) -> str:
    """Return index.html of a mechanism: its film, sliders, numbers, files and neighbours."""
    facts, listed = ("\n".join(f"<li>{escape(each)}</li>" for each in rows) for rows in (entry.facts, entry.insights))
    shows = f'<h2>What it shows</h2>\n<ul class="insights">\n{listed}\n</ul>\n' if listed else ""
    files = "\n".join(
        f'<li><a href="files/{escape(each.file)}" download>{escape(each.words)} '
        f"<small>{_size(each.size)}</small></a></li>"
        for each in entry.downloads
    )
    beside = "\n".join(_tile(other, k + 1, "../") for k, other in enumerate(others))
    film = (
        f'<h2>Film</h2>\n<video class="film" controls playsinline preload="none" width="1280" height="720" '
        f'poster="{escape(entry.picture)}" src="{escape(entry.film)}" aria-label="Film of {escape(entry.title)}">'
        "</video>"
        if entry.film
        else f'<img class="film" src="{escape(entry.picture)}" width="960" height="540" alt="{escape(entry.title)}">'
    )
    moved = " Move a number and see what it changes." if entry.has_sliders else ""
    article = f'\n<p><a href="{escape(entry.article)}">How it works, step by step</a></p>' if entry.article else ""
    place, sizes = f"{entry.name}/machine.html", 'width="960" height="640" loading="lazy"'
    embedded = f'<iframe src="{place}" title="{entry.title}" {sizes}></iframe>'
    inside = (
        f'<iframe class="machine" src="machine.html" title="{escape(entry.title)} in motion" loading="lazy" '
        'width="960" height="640"></iframe>'
    )
    head = HEAD.format(title=escape(entry.title), said=escape(entry.said), root="../")
    return f"""{head}<header>
<h1>{escape(entry.title)}</h1>
<a href="../index.html">All machines</a>
<button type="button" class="theme">Dark</button>
</header>
<main>
<p class="lead">{_prose(entry.said)}</p>{article}
{film}
<h2>The machine</h2>
<p>Turn it, play it, click a joint for its forces.{moved} <a href="machine.html">On a page of its own</a></p>
{inside}
{shows}<h2>In numbers</h2>
<ul class="facts">
{facts}
</ul>
<h2>Files</h2>
<ul class="files">
{files}
</ul>
<h2>On your own page</h2>
<pre><code>{escape(embedded)}</code></pre>
<h2>Its neighbours</h2>
<ul class="wall">
{beside}
</ul>
</main>
<footer>Made from {escape(entry.name)}/mechanism.py by mbsd.</footer>
<script src="../theme.js"></script>
<script src="../loops.js"></script>
</body>
</html>
"""


def _tile(entry: Entry, place: int, root: str = "") -> str:
    words = " ".join((entry.title, entry.name, entry.said, *entry.purposes)).lower()
    folder = f"{root}{entry.name}/"
    loop = f' data-loop="{escape(folder + entry.loop)}"' if entry.loop else ""
    when = 'loading="lazy"' if place >= 6 or root else 'fetchpriority="high"' if place == 0 else ""
    return (
        f'<li data-words="{escape(words)}" data-purposes="{escape("|".join(entry.purposes))}"{loop}>'
        f'<a class="tile" href="{escape(folder)}index.html"><span class="moving">'
        f'<img src="{escape(folder + entry.picture)}" width="{2 * WIDTH}" height="{2 * HEIGHT}" alt="" {when}></span>'
        f'<b>{escape(entry.title)}</b><span class="said">{_prose(entry.said)}</span></a></li>'
    )


def _size(size: int) -> str:
    return f"{size / KILO**2:.1f} MB" if size >= KILO**2 else f"{max(1, round(size / KILO))} kB"


# Page of a mechanism on the site: the page of ``mbsd view`` with designs for its sliders.


DESIGNS_PATIENCE = 900.0
"""Seconds in which the designs of a machine have to be there."""


def write_machine_page(name: str, target: Path) -> bool:
    """Write the page unless it is current; return True if it has sliders.

    Raises UserError.
    """
    out = Out(name)
    designs = _designs(name)
    table = designs.read_bytes() if designs.is_file() else b""
    key = key_of(out.view, designs if table else "none", sources_key(), sources_hash(*SOURCES, Path(__file__)))
    stage = Stage(out, "site-machine", key, [target])
    if not stage.is_fresh():
        payload = read_payload(out)
        more = _script(table) if table else ""
        page = document(payload["title"], encode(payload), bundle(), more, sketch=sketch(payload["skeleton"]))
        write_bytes(target, page)
        stage.record()
    return bool(table)


def _script(table: bytes) -> str:
    return f'<script type="text/plain" id="mbsd-designs">{base64.b64encode(table).decode()}</script>\n'


def _designs(name: str) -> Path:
    """Return the table of designs, built in a process of its own, since mechanism.py runs there.

    Empty where no number can be moved; missing where the process failed, which is reported and tried again.
    """
    out = Out(name)
    path = out.designs
    if is_in_space(out.motion):  # its numbers cannot be moved yet
        path.unlink(missing_ok=True)
        return path
    if stage_of(out).is_fresh():
        return path
    words = [sys.executable, "-m", "studio.site.designs", name]
    try:
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False, timeout=DESIGNS_PATIENCE)
        said = (done.stderr.strip() or f"exit code {done.returncode}").splitlines()[-1] if done.returncode else ""
    except subprocess.TimeoutExpired:
        said = f"it did not end within {DESIGNS_PATIENCE:.0f} s"
    if said:
        warn("site", f"{name}: its page has no sliders: {said}")
        path.unlink(missing_ok=True)
    return path
