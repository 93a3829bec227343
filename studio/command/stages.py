"""Stages of a mechanism as processes: the program of each, and the options that it takes."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from studio.command.options import OPTIONS, given

PYTHON = "MBSD_PYTHON"
"""Environment variable in which the Makefile names the interpreter of all stages."""


@dataclass(frozen=True)
class Stage:
    """One process: ``python -m room name MACHINE`` with the options that it knows."""

    room: str
    name: str = ""
    options: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    """Words that are always said."""
    starts_stages: bool = False
    """True if it starts stages itself, by the interpreter that it is given."""
    solids: bool = False
    """True if it loads the system libraries of parts and pictures."""

    def words(self, operand: str, said: Mapping[str, str], checked: bool = True) -> list[str]:
        """Return the command line.

        ``operand`` is empty for a stage that takes none, and follows ``--`` unless it is ``checked``.
        """
        python = os.environ.get(PYTHON) or sys.executable
        words = [python, "-m", self.room, *filter(None, (self.name, operand if checked else "")), *self.also]
        for option in self.options:
            words += given(OPTIONS[option], said)
        if self.starts_stages:
            words.append(f"--python={python}")
        return words if checked else [*words, "--", operand]


_PICTURE = ("preset", "aspect", "show")
PARTS = Stage("mechanisms", "parts", solids=True)
PARTS_IF_ANY = Stage("mechanisms", "parts", also=("--or-none",))
PARTS_FOR_MOTION = Stage("mechanisms", "parts", also=("--if-needed=motion",))
"""Parts whose masses the motion needs, because mechanism.py does not give them."""
SOLVE = Stage("mechanisms", "solve")
CLEARANCE = Stage("mechanisms", "clearance", solids=True)
SHOT = Stage("mechanisms", "shot")
PRINT = Stage("mechanisms", "print", ("bed", "gap"), solids=True)
PARTS_FOR_MODEL = Stage("mechanisms", "parts", also=("--if-needed=model",))
PARTS_FOR_PROOF = Stage("mechanisms", "parts", also=("--if-needed=proof",))
"""Parts of full size, if a scaled model or its proof needs their masses."""
MODEL = Stage("mechanisms", "parts", ("scale", "anyway"), solids=True)
MODEL_CLEARANCE = Stage("mechanisms", "clearance", ("scale",), solids=True)
MODEL_PRINT = Stage("mechanisms", "print", (*PRINT.options, "scale"), solids=True)
"""The same for a model, where a scale is given."""
ANIMATE = Stage("mechanisms", "animate", ("view",))
REPORT = Stage("render", "report")
PLOTS = Stage("render", "plots", ("spectra",))
COMPARE = Stage("render", "compare", ("spectra",))
GLB = Stage("render", "glb", solids=True)
USD = Stage("render", "usd", ("format",), solids=True)
VIEW = Stage("render", "view")
POSTER, CONTACT, FRAMES, SCENE, SCENE_UI = (
    Stage("render", name, _PICTURE, solids=True) for name in ("poster", "contact", "frames", "scene", "scene-ui")
)
EXPLODED = Stage("render", "exploded", ("preset", "aspect"), solids=True)
FILM = Stage("render", "film", (*_PICTURE, "story", "loop", "sound"), solids=True)
STILL = Stage("render", "still", ("frame", *_PICTURE), solids=True)
BARE_MOTION = (PARTS_FOR_MOTION, SOLVE)
"""The motion by itself; it goes on if there are no automatic parts."""
MOTION = (PARTS, SOLVE)
SCENERY = (PARTS, SOLVE, SHOT)
