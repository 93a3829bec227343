"""Safe replacement of the author's file, only while it is unchanged: no save is lost."""

from __future__ import annotations

import ctypes
import os
import shutil
import stat
import sys
import time
from contextlib import suppress
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.files import refusal, whole_file

AT_FDCWD, RENAME_EXCHANGE = -100, 2
"""Constants of Linux's <fcntl.h> and <linux/fs.h>."""
MOMENT = 0.05
"""Seconds in which an editor that had opened the old file before ends writing it."""


class Meanwhile(Exception):
    """Error for a file that has changed since it was read."""


def content_of(path: Path) -> bytes:
    """Return the content of a file of the author's. Raises UserError."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise UserError(refusal(path, error, "read")) from error


def replace(path: Path, before: bytes, after: bytes) -> None:
    """Write ``after`` into the file, whole, if it still has ``before``; mode and owner stay.

    The new file and the old one change places in one step where the system can; then what was taken out is looked at,
    and put back if an editor had saved meanwhile. Raises Meanwhile, and UserError where the file cannot be written.
    """
    try:
        status = path.stat()
    except OSError as error:
        raise UserError(refusal(path, error)) from error
    if not status.st_mode & (stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH) or not os.access(path, os.W_OK):
        raise UserError(f"{path.name} is read-only, so nothing is written into it: make it writable (chmod u+w {path})")

    def exchange(temporary: Path, target: Path) -> None:
        if content_of(target) != before:
            raise Meanwhile
        if not _exchanged(temporary, target):
            os.replace(temporary, target)
            return
        if temporary.read_bytes() == before:
            time.sleep(MOMENT)
            if temporary.read_bytes() == before:
                return
        _put_back(temporary, target, after)
        raise Meanwhile

    with whole_file(path, exchange) as temporary:
        temporary.write_bytes(after)
        temporary.chmod(stat.S_IMODE(status.st_mode))
        with suppress(OSError):
            shutil.chown(temporary, status.st_uid, status.st_gid)


def _put_back(temporary: Path, target: Path, after: bytes) -> None:
    """Restore an editor's save, unless there is a newer one."""
    if target.is_file() and target.read_bytes() == after:
        _exchanged(temporary, target)


def _exchanged(first: Path, second: Path) -> bool:
    """Exchange two files in one step; False where the system cannot."""
    rename = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None) if sys.platform == "linux" else None
    if rename is None:
        return False
    return rename(AT_FDCWD, os.fsencode(first), AT_FDCWD, os.fsencode(second), RENAME_EXCHANGE) == 0
