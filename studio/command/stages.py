"""Stages of a mechanism as processes: the program of each, and the options that it takes."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from render.presets import ASPECTS, PRESETS, WIDE

# Options of commands: each once, with its name on the command line, for make and in mbsd.toml.
#
# Under make the Makefile exports the words as variables of the environment, ``PRESET=final``; a name is the same in
# capitals. In mbsd.toml ``preset = "final"`` says once what is meant wherever nothing else is given.


FORMATS = ("csv", "parquet", "svg", "dxf", "step", "mjcf", "urdf", "fmu", "modelica")
"""Formats of mbsd export that the solved mechanism is written in."""
SCENES = ("usd", "usdz")
"""Formats of its scene, which render/usd writes."""


@dataclass(frozen=True)
class Option:
    """One option, whose value the stages check."""

    name: str
    help: str
    metavar: str = "WORD"
    default: str = ""
    choices: tuple[str, ...] = ()
    kept: bool = False
    """True if mbsd.toml may give it."""
    flag: bool = False
    """True if it is given without a value."""
    valued: bool = False
    """True if a stage takes this flag as ``=1``."""
    joint: str = ""
    """Text between several values, each from another use of the option; empty if it takes one."""

    @property
    def variable(self) -> str:
        """Name of the option as a variable of make."""
        return self.name.replace("-", "_").upper()


OPTIONS: dict[str, Option] = {
    option.name: option
    for option in (
        Option("preset", "quality of pictures", default="preview", choices=tuple(PRESETS), kept=True),
        Option("aspect", f"shape of the picture; {WIDE} if not given", choices=tuple(ASPECTS), kept=True),
        Option("show", "arrows and words in the picture: reactions,velocities,title", kept=True, joint=","),
        Option("sound", "of the film; on if not given", choices=("on", "off"), kept=True),
        Option(
            "story",
            "explain: a film of shots; compare: variants beside each other; loop: the motion, if not given",
            choices=("loop", "explain", "compare"),
        ),
        Option("loop", "seconds of a silent film with captions that ends as it begins: 12", "S"),
        Option("spectra", "spectra to plot: 'shaking force,motor'", kept=True, joint=","),
        Option("bed", "size of a plate in mm; 220x220 if not given", "WxH", kept=True),
        Option("scale", "of a model: 1:20, 1/20, 0.05 or 2:1; the machine itself if not given", "1:N", kept=True),
        Option("gap", "what pieces keep apart on a plate in mm; 5 if not given", "MM", kept=True),
        Option("frame", "number of the frame, from 0", "N", default="0"),
        Option("frames", "numbers of frames: 0,30", "N,N", joint=","),
        Option("view", "what is shown: reactions,velocities; all is all side by side", joint=","),
        Option("only", "these alone, commas between them; all if not given", "NAMES", joint=","),
        Option("watts", "power of this machine while it renders (W), to tell the energy", "W", kept=True),
        Option(
            "anyway",
            "begin though the disk is surely too small, or the same parts were refused before",
            flag=True,
            valued=True,
        ),
        Option("kind", "driven or simulated", default="driven", choices=("driven", "simulated")),
        Option("as", "its name here; that of the file if not given", "NAME"),
        Option("format", "of the file", default="csv", choices=(*FORMATS, *SCENES)),
        Option("time", "of the pose in a drawing or assembly (s)", "S", default="0"),
        Option("over", "what a study varies: 'crank=0.03:0.05:5; speed=6,12', or each by itself", "GRID", joint="; "),
        Option("single", "one file in place of a folder", flag=True),
        Option("port", "of 127.0.0.1; any free one if not given", "N"),
        Option("limit", "seconds that solving may take; 30 if not given", "S"),
        Option("no-parts", "make no parts in the background", flag=True),
        Option("open", "open the page in the browser", flag=True),
        Option("folder", "folder of the project on the other machine"),
        Option("names", "names alone, a line each", flag=True),
        Option("json", "for other programs", flag=True),
        Option("host", "address that other machines reach"),
    )
}


def given(option: Option, words: Mapping[str, str]) -> list[str]:
    """Return the words of a stage's command line that give this option; none without a value."""
    value = words.get(option.name, "")
    if not value:
        return []
    return [f"--{option.name}" if option.flag and not option.valued else f"--{option.name}={value}"]


# Stages of a mechanism as processes: the program of each, and the options that it takes.


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
CLEARANCE_OR_WARNING = Stage("mechanisms", "clearance", also=("--or-warn",), solids=True)
"""The proof among pictures, which go on where parts are shown and cannot be built."""
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
DESIGNS = Stage("studio.site.designs")
ARTICLE = Stage("render", "article")
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
