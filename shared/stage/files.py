"""Files written whole (a temporary file, then a rename), locked by one process, and hashed."""

from __future__ import annotations

import errno
import fcntl
import glob
import hashlib
import os
import re
import secrets
import shutil
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.memory import recalled
from shared.stage.paths import refuse_links

# Locks on files that belong to one process. The system releases a lock when its owner ends.
#
# A lock therefore tells what the number of a process cannot: whether the owner still runs, also in a container, after a
# restart of the machine, or on another computer that shares the disk.


def try_lock(handle: int) -> bool:
    """Lock an open file for this process, without waiting; False if another process holds it.

    Raises OSError where the disk knows no locks.
    """
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def is_abandoned(path: Path) -> bool:
    """Return True if the process that locked this file has ended; False if that is unknown."""
    try:
        handle = os.open(path, os.O_RDWR | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        return try_lock(handle)
    except OSError:
        return False
    finally:
        os.close(handle)


# Files written whole: a temporary file beside the target, then a rename.


TEMPORARY = re.compile(r"\..+-[0-9a-f]{8}(\.[^.]+)?")
"""Name of a temporary file; mbsd/base/files.py gives the same."""
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)
IN_THE_WAY = (errno.EISDIR, errno.ENOTDIR, errno.EEXIST, errno.ENOTEMPTY)
OF_THE_DISK = (*FULL, *FORBIDDEN, *IN_THE_WAY, errno.EIO, errno.ENODEV, errno.ESTALE, errno.ELOOP, errno.ENAMETOOLONG)
"""Errors that a user causes and cures, not the program."""


@contextmanager
def whole_file(path: Path, put: Callable[[Path, Path], object] = os.replace) -> Iterator[Path]:
    """Yield a temporary path with the target's suffix; it replaces ``path`` on success.

    Else it is removed.

    ``put`` brings the temporary file to its place; what it leaves under the temporary name is removed.

    A kill or a full disk therefore never leaves a part of a file under the final name.
    Raises UserError naming the file when the disk is full, the folder cannot be written, or a folder of results is a
    link.
    """
    refuse_links(path.parent)
    temporary: Path | None = None
    handle = -1
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        remove_leftovers(path.parent, f".{glob.escape(path.stem)}-*{glob.escape(path.suffix)}")
        handle, temporary = _locked_file(path)
        yield temporary
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        put(temporary, path)
    except OSError as error:
        raise UserError(refusal(path, error)) from error
    finally:
        if temporary is not None:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
            os.close(handle)


def refusal(path: Path | str, error: OSError, doing: str = "write") -> str:
    """Return an error for an unusable file: the file, the reason, the remedy."""
    reason = error.strerror or str(error)
    if error.errno in FULL:
        remedy = f"free some disk space{_free(Path(path))} or set MBSD_OUT to another folder"
    elif error.errno in FORBIDDEN:
        remedy = "make file and folder accessible or set MBSD_OUT to another folder"
    elif error.errno in IN_THE_WAY:
        remedy = "remove or rename what is in its place, or set MBSD_OUT to another folder"
    else:
        remedy = "check the disk or set MBSD_OUT to another folder"
    return f"cannot {doing} {path}: {reason}; {remedy}"


def _free(path: Path) -> str:
    """Return the free space of the disk, in brackets; empty if it is unknown."""
    try:
        return f" ({shutil.disk_usage(path.parent).free / 1e6:.1f} MB are free)"
    except OSError:
        return ""


def _locked_file(path: Path) -> tuple[int, Path]:
    """Return a new temporary file beside ``path`` and its handle, which holds a lock while open."""
    while True:
        temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
        try:
            handle = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)  # less what the umask takes
        except FileExistsError:
            continue
        with suppress(OSError):  # a disk without locks: what a kill leaves there stays
            try_lock(handle)
        if os.fstat(handle).st_nlink:
            return handle, temporary
        os.close(handle)  # another process took it for a leftover before it was locked


def remove_leftovers(folder: Path, name: str = ".*-*") -> None:
    """Remove temporary files in ``folder`` whose writer was killed, as the lock shows.

    ``name`` is their pattern: those of one target, or of all, such as the half film of a killed ``mbsd animate``.
    """
    for left in folder.glob(name):
        if TEMPORARY.fullmatch(left.name) and is_abandoned(left):
            left.unlink(missing_ok=True)


def write_bytes(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path`` whole."""
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file's bytes, as hex."""
    return recalled(("file", path), lambda: _file_hash(path))


def _file_hash(path: Path) -> str:
    with path.open("rb") as handle:
        return hashlib.file_digest(handle, "sha256").hexdigest()


def sources_hash(*folders_or_files: Path, leave_out: Collection[Path] = ()) -> str:
    """Return a SHA-256 over the Python sources below folders (or of files), by name and content.

    Sources below the folders in ``leave_out`` do not count.
    """
    asked = ("sources", folders_or_files, tuple(leave_out))
    return recalled(asked, lambda: _sources_hash(folders_or_files, leave_out))


def _sources_hash(folders_or_files: Collection[Path], leave_out: Collection[Path]) -> str:
    digest = hashlib.sha256()
    for root in folders_or_files:
        files = sorted(root.rglob("*.py")) if root.is_dir() else [root]
        for file in files:
            if any(file.is_relative_to(folder) for folder in leave_out):
                continue
            digest.update(file.relative_to(root.parent).as_posix().encode())
            digest.update(b"\0")
            digest.update(file.read_bytes())
            digest.update(b"\0")
    return digest.hexdigest()
