"""Warnings point at the user's line on every Python."""

from __future__ import annotations

import sys
import warnings
from types import SimpleNamespace
from typing import Any

import pytest

import mbsd.base.warning
from mbsd.base.errors import ModelWarning
from mbsd.base.warning import PACKAGE

DEEP = "def finds(warn):\n    warn('off', ModelWarning)\ndef asked(warn):\n    finds(warn)\n"


@pytest.mark.parametrize("version", [(3, 11), (3, 12)])
def test_a_warning_names_the_file_outside_the_package(
    monkeypatch: pytest.MonkeyPatch, version: tuple[int, int]
) -> None:
    names: dict[str, Any] = {"ModelWarning": ModelWarning}
    exec(compile(DEEP, f"{PACKAGE[0]}found.py", "exec"), names)
    monkeypatch.setattr(mbsd.base.warning, "sys", SimpleNamespace(version_info=version, _getframe=sys._getframe))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        names["asked"](mbsd.base.warning.warn)
    assert [(warning.filename, str(warning.message)) for warning in told] == [(__file__, "off")]
