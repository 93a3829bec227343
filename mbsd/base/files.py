"""Files written whole, to a temporary file beside the target, then to its name; tables as CSV.

A temporary file is locked by its writer for as long as he works, so the next writer of the same target can tell what a
kill has left and removes it. The system gives a file the rights that the user's umask leaves.

A spreadsheet takes a CSV cell that begins with = + - @, a tab or a line end for a formula, which may open files and
addresses. Such a text gets an apostrophe in front, as OWASP advises (CSV Injection); numbers stay numbers.
"""

from __future__ import annotations

import csv
import io
import os
import secrets
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from glob import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mbsd.base.errors import ModelError
from mbsd.base.names import shown

if TYPE_CHECKING:
    import pandas


try:
    import fcntl
except ImportError:  # Windows
    fcntl = None


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file whole: no part ever has the final name. Raises ModelError if the disk takes none."""
    _refuse_no_path(path)
    with whole_file(Path(path)) as temporary:
        temporary.write_bytes(content)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path with the suffix of ``path``, which it replaces at the end.

    An error leaves the old file.

    Raises ModelError where the disk refuses it.
    """
    with temporary_file(path) as temporary:
        yield temporary
        with temporary.open("rb") as written:
            os.fsync(written.fileno())
        os.replace(temporary, path)


@contextmanager
def temporary_file(path: Path) -> Iterator[Path]:
    """Yield a new hidden file beside ``path``, with its suffix, locked meanwhile and removed at the end.

    Those that killed writers of ``path`` have left are removed first. Raises ModelError where the disk refuses it.
    """
    handle, temporary = -1, None
    try:
        _remove_leftovers(path)
        handle, temporary = _locked_file(path)
        yield temporary
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise ModelError(f"cannot write {path}: {why}; choose another place or free some disk space") from error
    finally:
        if temporary is not None:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
            os.close(handle)


def _locked_file(path: Path) -> tuple[int, Path]:
    while True:
        temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
        try:
            handle = os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)
        except FileExistsError:
            continue
        _is_locked_here(handle)
        if os.fstat(handle).st_nlink:
            return handle, temporary
        os.close(handle)  # another process took it for a leftover before it was locked


def _remove_leftovers(path: Path) -> None:
    for left in path.parent.glob(f".{escape(path.stem)}-*{escape(path.suffix)}"):
        with suppress(OSError):
            handle = os.open(left, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
            try:
                if _is_locked_here(handle):
                    left.unlink(missing_ok=True)
            finally:
                os.close(handle)


def _is_locked_here(handle: int) -> bool:
    """Lock an open file for this process; False if another one holds it, or the disk knows no locks."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _refuse_no_path(path: object) -> None:
    if not isinstance(path, str | os.PathLike):
        raise ModelError(f"the path of a file is {shown(path)}; it must be a text or a path")


FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")
"""Characters with which a formula begins."""


def csv_text(names: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a table with all digits, a line for ``names`` first; NaN is an empty cell."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in (names, *rows):
        writer.writerow([cell(value) for value in row])
    return text.getvalue()


def cell(value: Any) -> Any:
    """Return a value as a cell: a text that is no number is no formula either, and NaN is empty."""
    if isinstance(value, str):
        return f"'{value}" if value.startswith(FORMULA) and not _is_number(value) else value
    return "" if value != value else value


def frame_csv(frame: pandas.DataFrame, **options: Any) -> str:
    """Return a table of pandas as CSV by its ``to_csv`` with ``options``, names and texts as :func:`cell`."""
    plain = frame.rename(columns=cell).rename_axis(index=cell)
    for place, kind in enumerate(frame.dtypes):
        if kind.kind == "O":
            texts = plain.iloc[:, place].map(lambda value: cell(value) if isinstance(value, str) else value)
            plain.isetitem(place, texts)
    return plain.to_csv(lineterminator="\n", **options)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
