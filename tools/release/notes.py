"""The notes of a tag: what CHANGELOG.md says of its version."""

from __future__ import annotations

import re

from shared.stage.errors import UserError

HISTORY = "### History"
"""Where the list of every change begins, which is too long for a tag."""


def notes(changelog: str, version: str) -> str:
    """The section of ``version`` up to its history, under a title. Raises UserError where it is missing or empty."""
    match = re.search(rf"(?ms)^## \[?{re.escape(version)}\b[^\n]*\n(.*?)(?=^## |\Z)", changelog)
    if not match:
        raise UserError(f"CHANGELOG.md has no section '## {version}'; write what a user notices")
    short = match[1].partition(f"\n{HISTORY}")[0].strip()
    if not re.search(r"(?m)^- ", short):
        raise UserError(f"the section '## {version}' of CHANGELOG.md lists nothing; write what a user notices")
    return f"# mbsd {version}\n\n{short}\n"
