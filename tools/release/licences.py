"""Licences of others in a wheel and in the pages that it makes: NOTICE.md must name them."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

NOTICE = "NOTICE.md"
FILES = ("LICENSE", NOTICE)
OURS = (
    ".py", ".c", ".h", ".js", ".cjs", ".css", ".json", ".typed", ".txt", ".npmrc", ".nbi", ".nbc",
    "METADATA", "WHEEL", "RECORD", "LICENSE", NOTICE,
)  # fmt: skip
"""Endings of what we write ourselves, and of compiled kernels; a font, a picture, a library is somebody's."""
LOCK = Path("render/view/page/package-lock.json")
FOREIGN = re.compile(r"(?i)copyright|SPDX-License-Identifier|\blicen[sc]ed under\b|@license")
SAYS_SO = ("bundle.py", "document.py", "package-lock.json", "help.js", "layout.js", "LICENSE", NOTICE, "METADATA")
"""Files that speak of licences: those of the page's packages are written into each page."""


def faults_of_licences(names: Sequence[str], root: Path) -> list[str]:
    """A sentence for each licence that is missing in a wheel of these files, built from ``root``."""
    notice = (root / NOTICE).read_text() if (root / NOTICE).is_file() else ""
    missing = [f"the wheel has no {file}" for file in FILES if not any(_is_licence(name, file) for name in names)]
    unknown = [name for name in names if not name.endswith(OURS) and not _named(name, notice)]
    return [
        *missing,
        *(f"{name} is in the wheel and not in {NOTICE}; whose is it?" for name in unknown),
        *(f"{name} speaks of a licence and is not in {NOTICE}" for name in _with_foreign_words(names, root, notice)),
        *(f"{package} {version} ({licence}) goes into pages and is not in {NOTICE}"
          for package, version, licence in packages_of_the_page(root) if not _has_row(notice, package, licence)),
    ]  # fmt: skip


def packages_of_the_page(root: Path) -> list[tuple[str, str, str]]:
    """Name, version and licence of every package that is bundled into a page."""
    entries = json.loads((root / LOCK).read_text())["packages"]
    return [
        (name.rpartition("node_modules/")[2], entry["version"], entry["license"])
        for name, entry in entries.items()
        if name and not entry.get("dev")
    ]


def _is_licence(name: str, file: str) -> bool:
    return bool(re.search(rf"\.dist-info/licenses/{re.escape(file)}$", name))


def _named(name: str, notice: str) -> bool:
    return f"`{Path(name).name}`" in notice


def _with_foreign_words(names: Sequence[str], root: Path, notice: str) -> list[str]:
    """Sources in the wheel with a licence of their own in them."""
    return [
        name
        for name in names
        if not name.endswith(SAYS_SO) and (source := _source(name, root)) and not _named(name, notice)
        if FOREIGN.search(source.read_text("utf-8", errors="replace"))
    ]


def _source(name: str, root: Path) -> Path | None:
    path = root / name.removeprefix("mbsd/rooms/")
    return path if path.is_file() and path.suffix in (".py", ".c", ".h", ".js", ".cjs", ".css", ".txt") else None


def _has_row(notice: str, package: str, licence: str) -> bool:
    return any(f"| {package} |" in line and f"| {licence} |" in line for line in notice.splitlines())
