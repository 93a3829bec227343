"""Setup of scheduler and workers: no HTTP server, and workers remember the sources of their start."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from mbsd.dealing.identity import versions
from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, SOLVER

# Identity of a machine that builds files of a mechanism: packages, and the sources of rooms.


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


FRAMES = ("render", "shared", "mbsd/base", "mbsd/dealing")
"""Rooms that decide how a picture looks, and how machines speak with each other."""
PARTS = (
    *("mbsd", "shared", "mechanisms/stages"),
    *(f"mechanisms/{name}.py" for name in ("__init__", "__main__", "automatic")),
)
"""Rooms that decide what solids a mechanism gets, without what authors write."""
OF_PARTS = (
    *("cadquery", "cadquery-ocp", "distributed", "llvmlite", "msgspec", "numba", "numpy", "python-sat", "scipy"),
    "trimesh",
)
"""Packages that decide it, and how machines speak with each other."""


def dask_setup(server: Any) -> None:
    """Prepare the scheduler or the worker, which then listens on its own address alone. Dask calls it.

    Dask's HTTP server shows logs to whoever asks and passes requests on to other machines, so it is closed.
    """
    server.http_server.stop()
    if hasattr(server, "nthreads"):  # a worker, which may be asked after its sources have changed
        identity(FRAMES, PACKAGES)
        identity(PARTS, OF_PARTS)
