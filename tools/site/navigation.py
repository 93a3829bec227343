"""The navigation: the groups of mkdocs.yml, with lists that follow from the pages that there are."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from tools.site.reference.contents import PAGES

DECISIONS = Path("docs/decisions")
HEADING = re.compile(r"^## (.+)$|^- \[(.+?)\]\((.+?)\)$", re.MULTILINE)


def navigation(groups: list[Any], pages: Path) -> list[Any]:
    """The groups with ``{decisions}`` and ``{reference}`` filled in; pages of docs/ in none of them are under More."""
    filled = _filled(groups, {"{decisions}": _decisions(pages), "{reference}": [f"reference/{name}" for name in PAGES]})
    listed = set(_files(filled))
    more = [name for page in sorted((pages / "docs").glob("*.md")) if (name := f"docs/{page.name}") not in listed]
    return [*filled, {"More": more}] if more else filled


def _filled(entries: list[Any], lists: dict[str, list[Any]]) -> list[Any]:
    out: list[Any] = []
    for entry in entries:
        if isinstance(entry, str) and entry in lists:
            out += lists[entry]
        elif isinstance(entry, dict):
            out.append(
                {title: _filled(below, lists) if isinstance(below, list) else below for title, below in entry.items()}
            )
        else:
            out.append(entry)
    return out


def _decisions(pages: Path) -> list[dict[str, list[dict[str, str]]]]:
    """The sections of the list of decisions."""
    out: list[dict[str, list[dict[str, str]]]] = []
    for section, title, place in HEADING.findall((pages / DECISIONS / "README.md").read_text()):
        if section:
            out.append({section: []})
        else:
            next(iter(out[-1].values())).append({title: (DECISIONS / place).as_posix()})
    return out


def _files(entries: list[Any]) -> list[str]:
    """Every page that is named."""
    out: list[str] = []
    for entry in entries:
        for value in entry.values() if isinstance(entry, dict) else [entry]:
            out += _files(value) if isinstance(value, list) else [value]
    return out
