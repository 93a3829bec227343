"""Files that Blender saves are checked before they get their name, since Blender does not report a full disk."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from shared.stage.errors import UserError
from shared.stage.files import refusal

ATTEMPTS = 2


def save_whole(
    part: Path, save: Callable[[Path], object], fault: Callable[[Path], str | None], most: int, name: str
) -> None:
    """Have ``save`` write the file ``part`` and check it by ``fault``, which words what is wrong with it.

    ``most`` is the number of bytes that it may need, ``name`` what messages call it. On an error ``part`` is removed.
    Raises UserError with the reason that the system gives for a file of that size.
    """
    try:
        wrong = None
        for _ in range(ATTEMPTS):
            try:
                save(part)
                wrong = fault(part)
            except RuntimeError as error:  # Blender notices a full disk now and then, without the name of the file
                wrong = f"was not written ({str(error).strip()})"
            if wrong is None:
                with part.open("rb") as written:
                    os.fsync(written.fileno())
                return
            _try_to_write(part, most)
        raise UserError(f"{name}: what Blender saved {wrong}, though the disk has room; run the same command again")
    except BaseException as error:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise UserError(f"{name}: {refusal(part, error)}. It may need {most / 1e6:.1f} MB") from error
        raise


def _try_to_write(part: Path, size: int) -> None:
    """Raises the OSError that Blender kept to itself, if there still is one."""
    with part.open("wb") as file:
        file.write(bytes(size))
        file.flush()
        os.fsync(file.fileno())
