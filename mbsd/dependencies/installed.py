"""Files of the interpreter and of installed packages: their versions count, not their content."""

from __future__ import annotations

import inspect
import os
import site
import sys
import sysconfig
from collections import defaultdict
from collections.abc import Mapping
from functools import cache
from importlib import metadata


def _folders(*paths: str) -> set[str]:
    return {kind(path) + os.sep for path in paths for kind in (os.path.abspath, os.path.realpath)}


# Not the whole of sys.prefix: an environment may be the folder in which its user works.
PACKAGES = tuple(
    _folders(
        *map(sysconfig.get_path, ("purelib", "platlib", "scripts")),
        *site.getsitepackages(),
        site.getusersitepackages(),
        *(os.path.join(sys.prefix, name) for name in ("lib", "lib64", "share")),
    )
)
STANDARD_LIBRARY = tuple(_folders(*map(sysconfig.get_path, ("stdlib", "platstdlib"))))
SYSTEM = tuple(f"/{top}/" for top in ("proc", "sys", "dev", "usr", "bin", "sbin", "lib", "lib64", "System", "Library"))
"""Folders of the system; what is read there is none of the user's."""


def is_installed(place: str) -> bool:
    """True if a file belongs to the interpreter or to an installed package."""
    return place.startswith(PACKAGES) or place.startswith(STANDARD_LIBRARY)


@cache
def distributions(top: str) -> tuple[str, ...]:
    """The installed distributions that bring a top-level module; empty for one of the standard library."""
    if top in sys.stdlib_module_names:
        return ()
    try:
        metadata.version(top)
    except (metadata.PackageNotFoundError, ValueError):
        return tuple(sorted({distribution.metadata["Name"] for distribution in _by_module().get(top, ())}))
    return (top,)


@cache
def _by_module() -> Mapping[str, list[metadata.Distribution]]:
    """Distributions by top-level module.

    ``metadata.packages_distributions()`` asks the disk for every file of every package, which takes a second.
    """
    by_module: defaultdict[str, list[metadata.Distribution]] = defaultdict(list)
    for distribution in metadata.distributions():
        for top in _tops(distribution):
            by_module[top].append(distribution)
    return by_module


def _tops(distribution: metadata.Distribution) -> set[str]:
    """Top-level modules of a distribution: those that it declares, else those of its files."""
    declared = (distribution.read_text("top_level.txt") or "").split()
    if declared:
        return set(declared)
    record = distribution.read_text("RECORD")
    if record is None:
        paths = [file.as_posix() for file in distribution.files or ()]
    else:
        paths = [line.removeprefix('"').partition(",")[0] for line in record.splitlines()]
    tops = {path.partition("/")[0] if "/" in path else inspect.getmodulename(path) or path for path in paths}
    return {top for top in tops if "." not in top}
