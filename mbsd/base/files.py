"""Files are written whole."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file by a temporary file beside the target, then a rename: no part of a file ever has the final name."""
    _refuse_no_path(path)
    path, temporary = Path(path), None
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
        temporary = Path(name)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        os.replace(temporary, path)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise ModelError(f"cannot write {path}: {why}; choose another place or free some disk space") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _refuse_no_path(path: object) -> None:
    if not isinstance(path, str | os.PathLike):
        raise ModelError(f"the path of a file is {shown(path)}; it must be a text or a path")
