"""A temporary folder for Blender and its job; it is removed when they end, at the latest when the next one starts."""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from shared.stage import locks
from shared.stage.paths import refuse_links

PREFIX, LOCK = "tmp-", ".lock"
UNLOCKED = 60.0
"""Seconds after which a folder that nobody ever locked counts as left behind."""


@contextmanager
def scratch_folder(home: Path) -> Iterator[Path]:
    """Yield a new folder below ``home``, and remove it afterwards; folders of processes that were killed go as well.

    Raises UserError if ``home`` is a link.
    """
    refuse_links(home)
    home.mkdir(parents=True, exist_ok=True)
    sweep(home)
    folder, lock = _locked_folder(home)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


def sweep(home: Path) -> None:
    """Remove the folders whose process has ended."""
    for folder in home.glob(f"{PREFIX}*"):
        if folder.is_symlink() or not folder.is_dir():
            continue
        if (folder / LOCK).exists():
            abandoned = locks.is_abandoned(folder / LOCK)
        else:
            abandoned = _age(folder) > UNLOCKED
        if abandoned:
            shutil.rmtree(folder, ignore_errors=True)


def _locked_folder(home: Path) -> tuple[Path, int]:
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=home))
        with suppress(FileNotFoundError):
            lock = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
            with suppress(OSError):  # a disk without locks: what a kill leaves there stays
                locks.take(lock)
            if os.fstat(lock).st_nlink:
                return folder, lock
            os.close(lock)  # another process took the folder for a leftover before it was locked


def _age(folder: Path) -> float:
    try:
        return time.time() - folder.stat().st_mtime
    except OSError:
        return 0.0
