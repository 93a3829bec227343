"""The system libraries that Blender and the CAD kernel load, and the packages that bring them (Linux alone)."""

from __future__ import annotations

import ctypes
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


def missing() -> list[str]:
    """Names of the libraries that cannot be loaded; always empty on a Mac, which needs none of them."""
    return [name for name in LIBRARIES if not _loads(name)] if sys.platform == "linux" else []


def cure(names: list[str]) -> str:
    """One line that names the libraries and the command that installs them."""
    packages = " ".join(LIBRARIES[name] for name in names)
    return f"missing system libraries {', '.join(names)}: sudo apt-get install -y {packages}"


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


def main() -> int:
    """Print the cure on stderr and return 1 if something is missing; ``--packages`` prints package names alone."""
    names = missing()
    if names and "--packages" in sys.argv:
        print(" ".join(LIBRARIES[name] for name in names))
    elif names:
        print(cure(names), file=sys.stderr)
    return 1 if names else 0


if __name__ == "__main__":
    sys.exit(main())
