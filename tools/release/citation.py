"""CITATION.cff: what the Citation File Format 1.2.0 asks for (citation-file-format.github.io)."""

from __future__ import annotations

import re
from typing import Any

NEEDED = ("cff-version", "message", "title", "authors")
KNOWN = {
    *NEEDED, "abstract", "commit", "date-released", "doi", "identifiers", "keywords", "license", "preferred-citation",
    "references", "repository", "repository-code", "type", "url", "version",
}  # fmt: skip
OF_AUTHORS = ({"name"}, {"family-names"}, {"given-names"})
"""An entity has a name, a person one of the others."""


def faults_of_citation(text: str) -> list[str]:
    """A sentence for each thing that the format does not take."""
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
