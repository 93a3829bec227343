"""The system libraries that Blender and the CAD kernel load, and the packages that bring them (Linux alone).

Programs that a user may do without, and the tests may not, are reported where ``--for-tests`` asks.
"""

from __future__ import annotations

import ctypes
import shutil
import sys

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
}

PROGRAMS = {"chromium": "chromium", "rsync": "rsync", "ssh": "openssh-client", "sshd": "openssh-server", "tmux": "tmux"}
"""Of tests: the page is opened in a browser, `make fetch` brings films from an sshd, nights run in tmux."""


def missing() -> list[str]:
    """Names of the libraries that cannot be loaded; always empty on a Mac, which needs none of them."""
    return [name for name in LIBRARIES if not _loads(name)] if sys.platform == "linux" else []


def cure(names: list[str]) -> str:
    """One line that names the libraries and the command that installs them."""
    packages = " ".join(LIBRARIES[name] for name in names)
    return f"missing system libraries {', '.join(names)}: sudo apt-get install -y {packages}"


def missing_programs() -> list[str]:
    """Names of the programs that the tests want and that are not there; sshd may be outside a user's PATH."""
    places = [None, "/usr/sbin:/usr/local/sbin:/sbin"]
    return [name for name in PROGRAMS if not any(shutil.which(name, path=place) for place in places)]


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


def main() -> int:
    """Print the cure on stderr and return 1 if something is missing; ``--packages`` prints package names alone."""
    names = missing()
    programs = missing_programs() if "--for-tests" in sys.argv else []
    packages = [LIBRARIES[name] for name in names] + [PROGRAMS[name] for name in programs]
    if packages and "--packages" in sys.argv:
        print(" ".join(packages))
        return 1
    if names:
        print(cure(names), file=sys.stderr)
    if programs:
        wanted = " ".join(PROGRAMS[name] for name in programs)
        print(f"missing programs {', '.join(programs)}: sudo apt-get install -y {wanted}", file=sys.stderr)
    return 1 if packages else 0


if __name__ == "__main__":
    sys.exit(main())
