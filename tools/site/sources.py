"""Pages of files that documents link to: their text, coloured, out of the way of the search."""

from __future__ import annotations

import re
from pathlib import Path

LANGUAGES = {".py": "python", ".json": "json", ".js": "javascript", ".sh": "sh", ".toml": "toml"}
APART = "---\nsearch:\n  exclude: true\nhide:\n  - toc\n---\n\n"


def page_of_source(root: Path, source: Path) -> str:
    """The page of one file."""
    text = (root / source).read_text().rstrip("\n")
    longest = max((len(run) for run in re.findall(r"`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    language = LANGUAGES.get(source.suffix, "text")
    return f"{APART}# {source.name}\n\n`{source.as_posix()}`\n\n{fence}{language}\n{text}\n{fence}\n"


def page_of_folder(root: Path, source: Path) -> str:
    """The list of the files of a folder, each with its page."""
    names = sorted(path.name for path in (root / source).iterdir() if path.is_file())
    rows = "\n".join(f"- [{name}]({name}.md)" for name in names)
    return f"{APART}# {source.name}\n\nThe files of `{source.as_posix()}/`:\n\n{rows}\n"
