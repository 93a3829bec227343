"""Versions and sources of a computer.

Equal identities give equal results, as far as the processors do.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterable, Iterator, Mapping
from importlib import metadata
from typing import Any, NamedTuple

SHOWN = 3
"""Workers that are named beside the reason they have in common."""


class Trust(NamedTuple):
    """The identity that workers must have to get orders."""

    ours: Mapping[str, str]
    """Versions and sources of this machine by name."""
    request: Callable[[], bytes]
    """Function that a worker runs to give its own identity, as JSON."""


def versions(packages: Iterable[str]) -> dict[str, str]:
    """Return Python's version and those of these packages, by name."""
    out = {"Python": platform.python_version()}
    for package in packages:
        try:
            out[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            out[package] = "none"
    return out


def asker(module: str, function: str, *arguments: Any) -> Callable[[], bytes]:
    """Return a function that gives what ``module.function(*arguments)`` returns on a worker, as JSON.

    A worker with other sources understands it as well, as it travels itself and not by its name.
    """

    def state() -> bytes:
        import importlib
        import json

        return json.dumps(getattr(importlib.import_module(module), function)(*arguments)).encode()

    return state


def differences(theirs: Mapping[str, str], ours: Mapping[str, str]) -> str:
    """Return where another computer differs: ``numpy 2.4.0, here 2.5.5``; empty if it does not."""
    names = [name for name in ours if theirs.get(name) != ours[name]]
    return "; ".join(f"{name} {theirs.get(name, 'unknown')}, here {ours[name]}" for name in names)


def together(reasons: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield workers that have the same reason, the first three by name, and that reason."""
    for reason in sorted(set(reasons.values())):
        names = sorted(name for name, why in reasons.items() if why == reason)
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        yield ", ".join(names[:SHOWN]) + more, reason
