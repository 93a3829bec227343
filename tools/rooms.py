"""Writes the map of rooms into ARCHITECTURE.md, from the docstrings of their packages: ``make docs``."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "ARCHITECTURE.md"
BEGIN, END = "<!-- rooms: written by make docs -->\n", "<!-- end of rooms -->\n"
DEPTH = {"mbsd": 2, "mechanisms": 3, "render": 2, "shared": 2, "studio": 2}
"""Rooms, and how many levels of folders are listed of each: a room alone is one."""


def written(page: str) -> str:
    """The page with the map as it should be. Raises ValueError where it has no place for it."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{PAGE.name} has no place for the map: {BEGIN.strip()} ... {END.strip()}")
    return before + BEGIN + table() + END + after


def table() -> str:
    """One row a package: its folder and the first sentence of its docstring."""
    rows = [row for room, depth in DEPTH.items() for row in _rows(ROOT / room, depth)]
    return "| room | what is in it |\n|---|---|\n" + "".join(f"{row}\n" for row in rows)


def _rows(folder: Path, depth: int, level: int = 0) -> list[str]:
    init = folder / "__init__.py"
    if level == depth or not init.is_file():
        return []
    own = f"| {'&nbsp;&nbsp;' * level}`{folder.relative_to(ROOT).as_posix()}/` | {sentence(init)} |"
    return [own, *(row for below in sorted(folder.iterdir()) for row in _rows(below, depth, level + 1))]


def sentence(file: Path) -> str:
    """The first paragraph of a module's docstring, on one line. Raises ValueError where there is none."""
    text = ast.get_docstring(ast.parse(file.read_text()))
    if not text:
        raise ValueError(f"{file.relative_to(ROOT)} has no docstring; say in a sentence what the room holds")
    return " ".join(text.partition("\n\n")[0].split()).replace("``", "`").replace("|", "\\|")


def main() -> int:
    """Write the map, or with --check tell whether it is as it should be."""
    page = PAGE.read_text()
    wanted = written(page)
    if sys.argv[1:] == ["--check"]:
        return 0 if page == wanted else 1
    PAGE.write_text(wanted)
    return 0


if __name__ == "__main__":
    sys.exit(main())
