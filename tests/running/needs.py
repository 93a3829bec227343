"""Needs of tests: missing programs are reported at the start and at the end, and tests skipped or refused."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NoReturn

import pytest

from shared.system.missing import missing_libraries, missing_programs, program, sentence

TESTS = Path(__file__).parents[1]
SOLVER = {
    "analyses", "dependencies", "drawing", "dynamics", "equations", "kinematics", "model", "published",
    "running", "saving", "studies", "synthesis",
}  # fmt: skip
"""Folders of tests whose files load neither Blender nor the CAD kernel, and so need no library of the system."""


def needed(name: str) -> str:
    """The path of a program; the test or fixture that asks is skipped where it is missing."""
    path = program(name)
    return path or _skipped(name)


def needs(*names: str) -> None:
    """Skip the test or fixture that asks if one of these programs is missing."""
    missing = missing_programs(names)
    if missing:
        _skipped(*missing)


def _skipped(*names: str) -> NoReturn:
    pytest.skip(sentence(programs=names))


def is_strict() -> bool:
    """Return True if something missing is an error: ``make test STRICT=1``, and CI unless STRICT=0."""
    return (os.environ.get("STRICT") or os.environ.get("CI") or "0") != "0"


class Needs:
    """Tells what is missing. Raises pytest.UsageError before the first test where none may be skipped."""

    def __init__(self) -> None:
        self.libraries, self.programs = missing_libraries(), missing_programs()
        if is_strict() and self.lines:
            raise pytest.UsageError(f"{sentence(self.libraries, self.programs)} (CI or STRICT=1: no test is skipped)")

    @property
    def lines(self) -> list[str]:
        """Missing things, what becomes of their tests, and the command that installs them."""
        lines = []
        if self.libraries:
            lines.append(f"{sentence(self.libraries)}; only tests of the solver run")
        if self.programs:
            lines.append(f"{sentence(programs=self.programs)}; tests that use them are skipped")
        return lines

    def pytest_report_header(self) -> list[str]:
        """At the start."""
        return self.lines

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """At the end."""
        if self.lines:
            terminalreporter.section("missing on this machine")
            for line in self.lines:
                terminalreporter.write_line(line)

    def pytest_ignore_collect(self, collection_path: Path) -> bool | None:
        """Leave out the folders that cannot be loaded."""
        inside = collection_path.relative_to(TESTS).parts if collection_path.is_relative_to(TESTS) else ()
        return True if self.libraries and inside and inside[0] not in SOLVER | {"conftest.py", "__init__.py"} else None
