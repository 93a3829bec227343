"""Reads which spectra are wanted: ``SPECTRA = ("shaking force", "motor")`` in mechanism.py, or SPECTRA=... of make."""

from __future__ import annotations

import ast

from shared.stage.errors import UserError
from shared.stage.paths import mechanism_file, shown_file

FORM = 'write names in quotes: SPECTRA = ("shaking force", "motor")'


def spectra_asked(name: str, words: str = "") -> list[str]:
    """Return names of quantities, each once: those of ``words``, commas between them, else those of mechanism.py.

    The file is read without running it. Raises UserError where its SPECTRA is no plain tuple or list of texts.
    """
    if words.strip():
        return list(dict.fromkeys(word.strip() for word in words.split(",") if word.strip()))
    file = mechanism_file(name)
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return []
    for statement in tree.body:
        targets = getattr(statement, "targets", [getattr(statement, "target", None)])
        if any(isinstance(target, ast.Name) and target.id == "SPECTRA" for target in targets):
            return _names(statement, f"{shown_file(name)}:{statement.lineno}")
    return []


def _names(statement: ast.stmt, where: str) -> list[str]:
    value = getattr(statement, "value", None)
    given = None
    if value is not None:
        try:
            given = ast.literal_eval(value)
        except ValueError:
            given = None
    if not isinstance(given, tuple | list) or not all(isinstance(name, str) for name in given):
        raise UserError(f"{where}: SPECTRA is not a list of names that can be read without running the file; {FORM}")
    return list(dict.fromkeys(given))
