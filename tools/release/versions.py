"""Where the version is written, and whether all say the same."""

from __future__ import annotations

import re
from pathlib import Path

from shared.stage.errors import UserError

PLACES = {
    "pyproject.toml": r'(?m)^version = "([^"]+)"',
    "mbsd/__init__.py": r'(?m)^__version__ = "([^"]+)"',
    "CITATION.cff": r"(?m)^version: ['\"]?([^'\"\s]+)",
    "CHANGELOG.md": r"(?m)^## \[?(\d[^\]\s]*)",
}
"""Files, and the first match that counts; of CHANGELOG.md it is the newest version."""


def versions(root: Path) -> dict[str, str]:
    """The version by file; empty where a file or its line is missing."""
    out = {}
    for name, pattern in PLACES.items():
        path = root / name
        match = re.search(pattern, path.read_text()) if path.is_file() else None
        out[name] = match[1] if match else ""
    return out


def disagreements(said: dict[str, str]) -> list[str]:
    """A sentence for each file that does not say what pyproject.toml says."""
    wanted = said["pyproject.toml"]
    return [
        f"{name} says {version or 'no version'} where pyproject.toml says {wanted}"
        for name, version in said.items()
        if version != wanted
    ]


def wanted_version(root: Path) -> str:
    """That of pyproject.toml. Raises UserError where it has none."""
    version = versions(root)["pyproject.toml"]
    if not version:
        raise UserError('pyproject.toml has no line version = "..."')
    return version
