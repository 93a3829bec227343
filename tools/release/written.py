"""Words of a release: its version in each file, the notes of its tag, CITATION.cff.

The Citation File Format 1.2.0: citation-file-format.github.io.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError

PLACES = {
    "pyproject.toml": r'(?m)^version = "([^"]+)"',
    "mbsd/__init__.py": r'(?m)^__version__ = "([^"]+)"',
    "CITATION.cff": r"(?m)^version: ['\"]?([^'\"\s]+)",
    "CHANGELOG.md": r"(?m)^## \[?(\d[^\]\s]*)",
}
"""Files, and the first match that counts; of CHANGELOG.md it is the newest version."""
HISTORY = "### History"
"""Where the list of every change begins, which is too long for a tag."""
NEEDED = ("cff-version", "message", "title", "authors")
KNOWN = {
    *NEEDED, "abstract", "commit", "date-released", "doi", "identifiers", "keywords", "license", "preferred-citation",
    "references", "repository", "repository-code", "type", "url", "version",
}  # fmt: skip
OF_AUTHORS = ({"name"}, {"family-names"}, {"given-names"})
"""An entity has a name, a person one of the others."""


def versions(root: Path) -> dict[str, str]:
    """Return the version by file; empty where a file or its line is missing."""
    out = {}
    for name, pattern in PLACES.items():
        path = root / name
        match = re.search(pattern, path.read_text()) if path.is_file() else None
        out[name] = match[1] if match else ""
    return out


def disagreements(said: dict[str, str]) -> list[str]:
    """Return a sentence for each file that does not say what pyproject.toml says."""
    wanted = said["pyproject.toml"]
    return [
        f"{name} says {version or 'no version'} where pyproject.toml says {wanted}"
        for name, version in said.items()
        if version != wanted
    ]


def wanted_version(root: Path) -> str:
    """Return the version of pyproject.toml. Raises UserError where it has none."""
    version = versions(root)["pyproject.toml"]
    if not version:
        raise UserError('pyproject.toml has no line version = "..."')
    return version


def notes(changelog: str, version: str) -> str:
    """Return the section of a version up to its history, under a title. Raises UserError if there is none."""
    match = re.search(rf"(?ms)^## \[?{re.escape(version)}\b[^\n]*\n(.*?)(?=^## |\Z)", changelog)
    if not match:
        raise UserError(f"CHANGELOG.md has no section '## {version}'; write what a user notices")
    short = match[1].partition(f"\n{HISTORY}")[0].strip()
    if not re.search(r"(?m)^- ", short):
        raise UserError(f"the section '## {version}' of CHANGELOG.md lists nothing; write what a user notices")
    return f"# mbsd {version}\n\n{short}\n"


def faults_of_citation(text: str) -> list[str]:
    """Return a sentence for each thing that the format does not take."""
    import yaml

    try:
        given: Any = yaml.safe_load(text)
    except yaml.YAMLError as error:
        return [f"CITATION.cff is no YAML: {' '.join(str(error).split())}"]
    if not isinstance(given, dict):
        return ["CITATION.cff has no fields"]
    faults = [f"CITATION.cff has no {name}" for name in NEEDED if not given.get(name)]
    faults += [f"CITATION.cff has an unknown field {name}" for name in given if name not in KNOWN]
    if given.get("cff-version") != "1.2.0":
        faults.append(f"cff-version is {given.get('cff-version')!r}, a string '1.2.0' is wanted")
    if given.get("type", "software") not in ("software", "dataset"):
        faults.append(f"type is {given['type']!r}; software or dataset")
    if not isinstance(given.get("version", ""), str):
        faults.append(f"version is {given['version']!r}, no string; write it in quotes")
    if not re.fullmatch(r"\d{4}-\d\d-\d\d", str(given.get("date-released", "2026-01-01"))):
        faults.append(f"date-released is {given['date-released']!r}; YYYY-MM-DD")
    return faults + _authors(given.get("authors"))


def _authors(authors: Any) -> list[str]:
    if not isinstance(authors, list):
        return ["authors is no list"]
    nameless = [author for author in authors if not isinstance(author, dict) or not _is_named(set(author))]
    return [f"an author has no name: {author!r}" for author in nameless]


def _is_named(fields: set[str]) -> bool:
    return any(names <= fields for names in OF_AUTHORS)
