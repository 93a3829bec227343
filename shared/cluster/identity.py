"""Identity of a machine that builds files of a mechanism: packages, and the sources of rooms."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from pathlib import Path

from mbsd.dealing.identity import versions
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, SOLVER

PACKAGES = ("bpy", "distributed", "msgspec", "numpy", "pillow")
"""Packages whose version decides the pixels of a picture, or how machines talk to each other."""


@functools.cache
def identity(rooms: Iterable[str], packages: Iterable[str] = PACKAGES) -> dict[str, str]:
    """Return the versions of Python and packages, and hashes of the sources of these rooms, by name.

    It is found once in a process, so a worker reports what it was started with.
    """
    return versions(packages) | {f"sources of {room}": sources_of(room) for room in rooms}


def sources_of(room: str, root: Path = ROOT) -> str:
    """Return a short hash of the Python sources of a room or file in the project at ``root``."""
    top, *below = Path(room).parts
    folder = SOLVER.joinpath(*below) if top == "mbsd" and not (root / top).exists() else root / room
    others = [folder / "rooms"] if room == "mbsd" else []  # where an installed package has the other rooms
    return sources_hash(folder, leave_out=others)[:12]
