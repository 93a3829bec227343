"""The theory page of the site: docs/theory.md with the equations of the source files that it links to."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from shared.stage.errors import UserError

PAGE = Path("docs/theory.md")
SOURCES = re.compile(r"^Sources: .*?(?=^$|\Z)", re.MULTILINE | re.DOTALL)
"""The paragraph of a section that links to the files and folders with its equations."""
LINK = re.compile(r"\]\(([^)#\s]+)\)")
FEWEST_LINES = 2
"""A docstring of one line has no equations to show."""


def with_equations(text: str, root: Path) -> str:
    """Return the page ``text`` with each list of sources replaced by the docstrings of these files.

    A file stands once: in the section that links to it most closely. Raises UserError where a link gives nothing.
    """
    folder = root.resolve() / PAGE.parent
    places = [(folder / link).resolve() for paragraph in SOURCES.findall(text) for link in LINK.findall(paragraph)]
    closest = {file: place for place in sorted(places, key=lambda p: len(p.parts)) for file in _files(place)}

    def filled(paragraph: re.Match[str]) -> str:
        return "\n".join(_section(link) for link in LINK.findall(paragraph[0]))

    def _section(link: str) -> str:
        place = (folder / link).resolve()
        entries = [entry for file in _files(place) if closest[file] == place and (entry := _entry(file, root))]
        if not entries:
            raise UserError(f"site: {PAGE} lists {link}, which holds no equations; name the file that has them")
        return "\n".join(entries)

    return SOURCES.sub(filled, text)


def _files(place: Path) -> list[Path]:
    """Return the modules of a place: the file itself, or all below a folder, those of the folder first."""
    if place.is_file():
        return [place]
    return sorted(place.rglob("*.py"), key=lambda file: (file.parent != place, file))


def _entry(file: Path, root: Path) -> str:
    """Return the section of one file, or an empty text where its docstring holds no equations."""
    text = ast.get_docstring(ast.parse(file.read_text())) or ""
    first, _, rest = text.partition("\n\n")
    if len(rest.splitlines()) < FEWEST_LINES or file.name.startswith("__"):
        return ""
    acronym = re.match(r"([A-Z]{2,}):", first)
    title = acronym[1] if acronym else file.stem.replace("_", " ").capitalize()
    source = file.relative_to(root.resolve()).as_posix()
    return f"### {title}\n\n{' '.join(first.split())}\n\n```text\n{rest}\n```\n\n`{source}`\n"
