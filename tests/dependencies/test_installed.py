"""Distributions by the modules that they bring."""

from __future__ import annotations

import os
from importlib import metadata
from pathlib import Path

import pytest

from mbsd.dependencies import installed


def test_modules_and_distributions_are_those_of_the_standard_library() -> None:
    """The standard library asks the disk for every file of every package; ours does not."""
    by_module = {
        top: {distribution.metadata["Name"] for distribution in them} for top, them in installed._by_module().items()
    }
    assert by_module == {top: set(names) for top, names in metadata.packages_distributions().items()}


def test_files_of_packages_are_not_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    installed._by_module.cache_clear()
    looked: list[object] = []
    plain = os.stat
    monkeypatch.setattr(Path, "exists", lambda path: looked.append(path))
    monkeypatch.setattr(os, "stat", lambda path, *rest, **more: looked.append(path) or plain(path, *rest, **more))
    assert len(installed._by_module()) > 50
    assert len(looked) < 2000, "they have tens of thousands"
