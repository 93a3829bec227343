"""How long Blender may be silent before it counts as hanging."""

from __future__ import annotations

import os
from dataclasses import dataclass

START = 300.0
"""Seconds until the first picture, in which Blender is loaded and the scene is built."""
KERNELS = 1800.0
"""Seconds for the drivers of a GPU to compile Cycles, once on a machine."""
FLOOR = 120.0
"""Seconds for everything else, however short a picture takes."""
TIMES = 10.0
"""Multiple of the longest picture so far: a machine may become that busy."""
LONGEST = 6 * 3600.0
"""Seconds that no silence is longer than, whatever a timing.json says."""
VARIABLE = "MBSD_PATIENCE"
"""Environment variable with seconds to take in place of FLOOR; the others follow in proportion."""


@dataclass
class Patience:
    """How long the Blender process may say nothing, by what is known of it."""

    longest: float = 0.0
    """Seconds that the longest picture took."""
    pictures: int = 0
    """Made by this process."""

    def finished(self, seconds: float) -> None:
        """Count a picture that took so long."""
        self.longest = max(self.longest, seconds)
        self.pictures += 1

    def limit(self, doing: str) -> float:
        """Seconds of silence that are too long for what Blender does now."""
        if "kernels" in doing:
            floor = KERNELS
        else:
            floor = FLOOR if self.pictures else START
        return max(self.scaled(floor), min(TIMES * self.longest, LONGEST))

    def scaled(self, seconds: float) -> float:
        """Seconds in the proportion that the environment asks for."""
        return seconds * _scale()


def _scale() -> float:
    try:
        given = float(os.environ.get(VARIABLE, ""))
    except ValueError:
        return 1.0
    return given / FLOOR if 0 < given < float("inf") else 1.0
