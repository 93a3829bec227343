"""Libraries and programs that no Python package brings, and Debian's and Homebrew's packages that do."""

from __future__ import annotations

from dataclasses import dataclass

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
