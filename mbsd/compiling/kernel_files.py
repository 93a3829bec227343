"""Files of compiled kernels: written whole with a digest; damaged ones are removed and logged.

numba writes an index (.nbi) and a data file (.nbc) for each function, both pickled. It neither flushes them to the disk
nor checks what it reads, so after a power cut every later run would end in an EOFError. Here each file ends with a
mark and the SHA-256 of what stands before it, which unpickling passes over. A file without that mark is one of numba's
own or of an older version; it counts if it can be unpickled.

Compiled code that came in the wheel stands in ``SHIPPED``; ``MADE_FOR`` says for which Python, numba and processor.
"""

from __future__ import annotations

import hashlib
import io
import json
import logging
import os
import pickle
import platform
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import IndexDataCacheFile

LOG = logging.getLogger("mbsd")
MARK = b"mbsd-sha256"
"""Before the digest at the end of a file."""
_TOLD: list[str] = []
"""The damaged file that this process has named."""


class KernelFiles(IndexDataCacheFile):
    """Index and data files of one function."""

    def _load_index(self) -> dict[Any, str]:
        """Return the data file of each signature; empty if the index is missing, damaged or cannot be read."""
        return self._read_or_removed(Path(self._index_path), super()._load_index) or {}

    def _load_data(self, name: str) -> Any:
        """Return what was kept; None if the file is damaged or cannot be read."""
        return self._read_or_removed(Path(self._data_path(name)), lambda: super(KernelFiles, self)._load_data(name))

    def _read_or_removed(self, path: Path, read: Callable[[], Any]) -> Any:
        try:
            refuse_damaged(path.read_bytes())
            return read()
        except Exception as error:  # unpickling raises nearly everything
            if isinstance(error, OSError) and not isinstance(error, PermissionError | IsADirectoryError):
                return None  # it is not there, or this process has too many files open
            _remove(path)
            tell_of_damage(str(path), str(error) or type(error).__name__)
            return None

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[io.BytesIO]:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Collect the content, and write it with its digest: to a temporary file, to the disk, to its name."""
        content = io.BytesIO()
        yield content
        temporary = f"{filepath}.tmp.{os.getpid()}"
        try:
            with open(temporary, "wb") as file:
                file.write(sealed(content.getvalue()))
                file.flush()
                os.fsync(file.fileno())
            os.replace(temporary, filepath)
        except BaseException:
            with suppress(OSError):
                os.unlink(temporary)
            raise


def sealed(content: bytes) -> bytes:
    """Return the content with the mark and its digest behind it."""
    return content + MARK + hashlib.sha256(content).digest()


def refuse_damaged(content: bytes) -> None:
    """Raise UnpicklingError if the digest at the end is not that of the content."""
    size = len(content) - hashlib.sha256().digest_size - len(MARK)
    if size >= 0 and content[size:].startswith(MARK) and sealed(content[:size]) != content:
        raise pickle.UnpicklingError("its SHA-256 is wrong")


def _remove(path: Path) -> None:
    """Remove what stands there, if that is allowed; a folder, too, which a new file could not replace."""
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink()


def tell_of_damage(path: str, reason: str) -> None:
    """Log, once in a process, that compiled code was damaged and is compiled again."""
    if _TOLD:
        return
    _TOLD.append(path)
    left = "; it cannot be removed, so install mbsd again" if os.path.lexists(path) else ""
    LOG.warning("mbsd: %s is damaged (%s); its kernel is compiled again%s", path, reason, left)


SHIPPED = Path(__file__).parent.parent / "kernels"
"""Folders as in mbsd/compiling/kernel_cache.py; there is none in a clone, nor in a wheel without kernels."""
MADE_FOR = SHIPPED / "made_for.json"
"""Processor and Python that a kernel was compiled for, as :func:`here` returns them."""


def here() -> dict[str, str]:
    """Return what compiled code depends on beside its sources."""
    return {
        "Python": platform.python_version().rpartition(".")[0],
        "numba": numba.__version__,
        "system": platform.system(),
        "processor": platform.machine(),
    }


@cache
def tell_of_other_kernels() -> None:
    """Log, once, why the wheel's kernels do not serve here, if they do not."""
    try:
        made_for = json.loads(MADE_FOR.read_text())
    except (OSError, ValueError):
        made_for = {}
    others = [f"{what} {made_for.get(what)} (here {it})" for what, it in here().items() if made_for.get(what) != it]
    if others:
        LOG.warning("mbsd: the kernels of its wheel are for %s, so they are compiled anew", ", ".join(others))
