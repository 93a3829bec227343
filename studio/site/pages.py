"""HTML of the site: the wall, and the page of a mechanism. They can be read without scripts."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from shared.contract.quantity import counted
from studio.site.entries import Entry
from studio.site.loops import HEIGHT, WIDTH

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
    facts = "\n".join(f"<li>{escape(fact)}</li>" for fact in entry.facts)
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
<p class="lead">{_prose(entry.said)}</p>
{film}
<h2>The machine</h2>
<p>Turn it, play it, click a joint for its forces.{moved} <a href="machine.html">On a page of its own</a></p>
{inside}
<h2>In numbers</h2>
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
