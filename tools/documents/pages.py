"""Pages of docs/ whose parts are computed: text between two markers, and files that change."""

from __future__ import annotations

import os
from pathlib import Path

from shared.stage.files import write_bytes
from shared.stage.paths import ROOT

DOCS = ROOT / "docs"


def between(page: str, begin: str, end: str) -> str:
    """Return the text between two markers. Raises ValueError where the page lacks one."""
    _, mark, rest = page.partition(begin)
    if not mark or end not in rest:
        raise ValueError(f"the page has no '{begin}' ... '{end}'")
    return rest.partition(end)[0]


def replaced(page: str, begin: str, end: str, text: str) -> str:
    """Return the page with ``text`` between two markers. Raises ValueError where the page lacks one."""
    return page.replace(f"{begin}{between(page, begin, end)}{end}", f"{begin}\n{text}\n{end}", 1)


def write_changed(path: Path, content: bytes) -> None:
    """Write a file of docs/ and report it, unless it has this content."""
    if not path.exists() or path.read_bytes() != content:
        write_bytes(path, content)
        print(f"{os.path.relpath(path)} is new: {len(content) / 1000:.0f} kB")
