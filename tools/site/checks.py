"""Checks of a built site: links lead somewhere, and nothing is loaded from a network."""

from __future__ import annotations

import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {("script", "src"), ("img", "src"), ("source", "srcset"), ("iframe", "src"), ("link", "href")}
"""Elements that a browser fetches by itself."""
KEPT_LINKS = ("canonical", "prev", "next")
"""Values of ``rel`` that fetch nothing."""
IN_STYLE = re.compile(r"url\([\"']?(https?:|//)|@import")


class _Page(HTMLParser):
    """The names of places of a page, and its links: tag, attribute, value."""

    def __init__(self) -> None:
        super().__init__()
        self.places: set[str] = set()
        self.links: list[tuple[str, str, str]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep what it names and where it leads."""
        values = {name: value or "" for name, value in attrs}
        self.places |= {values[name] for name in ("id", "name") if name in values}
        if tag == "link" and values.get("rel") in KEPT_LINKS:
            return
        for name in ("src", "href", "srcset"):
            if name in values:
                self.links.append((tag, name, values[name]))


@cache
def _read(path: Path) -> _Page:
    page = _Page()
    page.feed(path.read_text())
    return page


def faults(site: Path) -> list[str]:
    """A sentence for each link that is wrong; none where all is well."""
    _read.cache_clear()
    pages = [path for path in sorted(site.rglob("*.html")) if path.name != "404.html"]
    styles = [
        f"{path.relative_to(site)} loads from a network"
        for path in sorted(site.rglob("*.css"))
        if IN_STYLE.search(path.read_text())
    ]
    return styles + [
        f"{page.relative_to(site)}: {tag} {link[:80]} {wrong}"
        for page in pages
        for tag, name, link in _read(page).links
        if (wrong := _fault(site, page, tag, name, link))
    ]


def _fault(site: Path, page: Path, tag: str, name: str, link: str) -> str:
    """Return what is wrong with one link; empty if nothing."""
    parts = urlsplit(link)
    if parts.scheme in ("data", "mailto", "javascript"):
        return ""
    if parts.scheme or parts.netloc:
        return "is loaded from a network" if (tag, name) in LOADED else ""
    target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
    if not target.is_relative_to(site.resolve()) or not target.is_file():
        return "leads nowhere"
    if parts.fragment and target.suffix == ".html" and unquote(parts.fragment) not in _read(target).places:
        return "leads to no place of that page"
    return ""
