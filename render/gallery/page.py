"""The page of the gallery, Markdown: a poster, what to see in it, the numbers that matter."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from shared.stage.face import to_run

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
    """The whole page, in the order of the names; ``own``: of the machines of a user's own folder."""
    first = [
        "Every mechanism of `mechanisms/`, each from one short file. `mbsd run <name>` makes the film, the parts and",
        "the numbers of one; `make gallery` makes this page.",
    ]
    lines = ["# Gallery", "", *([f"`{to_run('gallery')}` makes this page."] if own else first)]
    for entry in entries:
        title = entry.name.replace("_", " ")
        title = title[:1].upper() + title[1:]
        lines += ["", f"## {title}", "", f"![{title}]({entry.name}.jpg)", ""]
        lines += [entry.said, ""] if entry.said else []
        page_of = f"`{to_run('view', entry.name)}`" if own else f"[the page](../view.md): `mbsd view {entry.name}`"
        lines += [f"{' · '.join(entry.facts)} · [{entry.file.rpartition('/')[2]}]({entry.file}) · {page_of}"]
    return "\n".join(lines) + "\n"


def sentences(docstring: str) -> str:
    """The first two sentences of a docstring on one line; what all of them say is left out."""
    paragraph = " ".join(docstring.split("\n\n")[0].split())
    said = [
        sentence
        for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z0-9])", paragraph)
        if sentence and sentence not in UNSAID
    ]
    return " ".join(said[:LONGEST])
