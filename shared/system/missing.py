"""Entries of the table that are missing on this machine, and the command that installs them.

The standard library of any Python 3 suffices: `make install` asks before there is an environment.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import sys
from collections.abc import Iterable
from dataclasses import dataclass

# Libraries and programs that no Python package brings, and Debian's and Homebrew's packages that do.


LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXi.so.6": "libxi6",
    "libXrender.so.1": "libxrender1",
    "libXfixes.so.3": "libxfixes3",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libexpat.so.1": "libexpat1",
}
"""Libraries that Blender and the CAD kernel load, by their soname, and Debian's packages. A Mac needs none of them."""


@dataclass(frozen=True)
class Program:
    """Program with the names under which it is looked for, and the packages that bring it."""

    debian: str
    homebrew: str = ""
    """Empty where a Mac has it from the start."""
    names: tuple[str, ...] = ()
    """Names in PATH, the first that is there; empty if it has one name alone."""
    variable: str = ""
    """Environment variable with a path that takes precedence."""
    for_tests: bool = True
    """True if `make test` needs it."""


PROGRAMS = {
    "chromium": Program(
        "chromium", "--cask chromium", ("chromium", "chromium-browser", "google-chrome"), variable="CHROMIUM"
    ),
    "rsync": Program("rsync", "rsync"),
    "ssh": Program("openssh-client"),
    "ssh-keygen": Program("openssh-client"),
    "sshd": Program("openssh-server"),
    "tmux": Program("tmux", "tmux"),
    "firefox": Program("firefox-esr", "--cask firefox", ("firefox-esr", "firefox"), for_tests=False),
    "WebKitWebDriver": Program("webkit2gtk-driver", for_tests=False),
    "Xvfb": Program("xvfb", "--cask xquartz", for_tests=False),
}
"""A browser opens and pictures pages, `make fetch` uses rsync and ssh, its tests an sshd, nights run in tmux."""


SBIN = "/usr/sbin:/usr/local/sbin:/sbin"
"""Folders of sshd, which a user's PATH need not have."""


def program(name: str) -> str | None:
    """Return the path of a program, None if it is missing.

    One that is not in the table is looked for in PATH.
    """
    known = PROGRAMS.get(name)
    if known and os.environ.get(known.variable or "-"):
        return os.environ[known.variable]
    for word in (known and known.names) or (name,):
        for place in (None, SBIN):
            path = shutil.which(word, path=place)
            if path:
                return path
    return None


def missing_programs(names: Iterable[str] | None = None) -> list[str]:
    """Return the missing ones of these programs; without names those that the tests need."""
    wanted = [name for name in PROGRAMS if PROGRAMS[name].for_tests] if names is None else names
    return [name for name in wanted if program(name) is None]


def missing_libraries() -> list[str]:
    """Return names of libraries that cannot be loaded; always empty on a Mac, which needs none."""
    return [name for name in LIBRARIES if not _loads(name)] if sys.platform == "linux" else []


def packages(names: Iterable[str]) -> list[str]:
    """Return the packages of libraries and programs on this system, each once.

    Names outside the table have none.
    """
    return list(dict.fromkeys(package for package in map(_package, names) if package))


def remedy(names: Iterable[str]) -> str:
    """Return the command that installs them: ``sudo apt-get install -y libgl1``.

    It is empty if no package is known.
    """
    wanted = packages(names)
    command = "brew install" if sys.platform == "darwin" else "sudo apt-get install -y"
    return f"{command} {' '.join(wanted)}" if wanted else ""


def sentence(libraries: Iterable[str] = (), programs: Iterable[str] = ()) -> str:
    """Return one line that names what is missing and the command that installs it."""
    kinds = {"system libraries": list(libraries), "programs": list(programs)}
    what = " and ".join(f"{kind} {', '.join(names)}" for kind, names in kinds.items() if names)
    command = remedy(name for names in kinds.values() for name in names)
    return f"missing {what}" + (f": {command}" if command else "")


def _package(name: str) -> str:
    if name in LIBRARIES:
        return LIBRARIES[name]
    known = PROGRAMS.get(name)
    if known is None:
        return ""
    return known.homebrew if sys.platform == "darwin" else known.debian


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True
