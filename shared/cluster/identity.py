"""What a machine works with. Machines with the same identity give the same results, as far as their processors do."""

from __future__ import annotations

import functools
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping
from importlib import metadata
from pathlib import Path

from shared.stage.files import sources_hash
from shared.stage.paths import ROOT, SOLVER

PACKAGES = ("bpy", "distributed", "msgspec", "numpy", "pillow")
"""Those whose version decides what comes out of a picture, or how machines speak with each other."""

SHOWN = 3
"""Workers that are named beside the reason they have in common."""


@functools.cache
def identity(rooms: Iterable[str], packages: Iterable[str] = PACKAGES) -> dict[str, str]:
    """Python, packages, and the sources of these rooms, by name.

    It is found once in a process, so a worker reports what it was started with.
    """
    versions = {"Python": platform.python_version()}
    for package in packages:
        try:
            versions[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            versions[package] = "none"
    return versions | {f"sources of {room}": sources_of(room) for room in rooms}


def sources_of(room: str, root: Path = ROOT) -> str:
    """A short hash of the Python sources of a room, or of one file, in the project at ``root``."""
    folder = SOLVER if room == "mbsd" and not (root / room).exists() else root / room
    return sources_hash(folder)[:12]


def asker(rooms: tuple[str, ...], packages: tuple[str, ...]) -> Callable[[], bytes]:
    """A function that a worker with other sources understands as well, as it travels itself and not by its name.

    It gives the identity as MessagePack.
    """

    def asked() -> bytes:
        import msgspec

        from shared.cluster.identity import identity

        return msgspec.msgpack.encode(identity(rooms, packages))

    return asked


def differences(theirs: Mapping[str, str], ours: Mapping[str, str]) -> str:
    """Where another machine differs from this one: ``numpy 2.4.0, here 2.5.5``; empty where it does not."""
    names = [name for name in ours if theirs.get(name) != ours[name]]
    return "; ".join(f"{name} {theirs.get(name, 'unknown')}, here {ours[name]}" for name in names)


def together(reasons: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Workers that have the same reason, the first three by name, and that reason."""
    for reason in sorted(set(reasons.values())):
        names = sorted(name for name, why in reasons.items() if why == reason)
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        yield ", ".join(names[:SHOWN]) + more, reason
