"""System libraries that Blender needs, and the packages that have them."""

from __future__ import annotations

APT = {
    "libGL": "libgl1",
    "libSM": "libsm6",
    "libICE": "libice6",
    "libX11": "libx11-6",
    "libXext": "libxext6",
    "libXi": "libxi6",
    "libXrender": "libxrender1",
    "libXfixes": "libxfixes3",
    "libxkbcommon": "libxkbcommon0",
    "libgomp": "libgomp1",
    "libEGL": "libegl1",
}
"""Debian's package for each library bpy may miss."""


def missing_library(message: str) -> str:
    """What to do about the ImportError of bpy with that message."""
    library = message.split(":")[0]
    package = APT.get(library.split(".so")[0])
    cure = f"sudo apt-get install -y {package}" if package else "install the package that has it"
    return f"Blender needs the system library {library}: {cure}" if ".so" in library else f"bpy cannot start: {message}"
