"""Options of a night: its mechanisms, its preset, and the cost to state."""

from __future__ import annotations

import math
import re
import sys
from dataclasses import dataclass

from render.presets import PRESETS, Preset, has_sound, preset_named
from shared.stage.errors import UserError
from shared.stage.face import said
from shared.stage.paths import all_mechanisms, known_name, unfit_names


@dataclass(frozen=True)
class Options:
    """Options of one night."""

    names: tuple[str, ...]
    """Mechanisms and variants in the order in which their films are made."""
    preset: Preset = PRESETS["preview"]
    show: str = ""
    """Value of SHOW, which replaces the choice of the shots."""
    spectra: str = ""
    """Value of SPECTRA; spectra of things that a mechanism lacks are left out."""
    sound: str = ""
    """Value of SOUND: on, off, or empty, which is on."""
    watts: float | None = None
    """Power of the machine while it renders (W)."""
    python: str = sys.executable
    """The interpreter that runs the stages."""
    unfit: tuple[str, ...] = ()
    """Folders with a mechanism.py whose name is none."""
    whole: bool = False
    """True if these are all mechanisms, rather than those of ONLY."""
    anyway: bool = False
    """True if it begins on a disk that is surely too small."""


def options(
    only: str,
    preset: str,
    show: str,
    spectra: str,
    watts: str,
    python: str,
    anyway: str = "",
    aspect: str = "",
    sound: str = "",
) -> Options:
    """Return options from words of the Makefile.

    Raises UserError for invalid words and without mechanisms.
    """
    wanted = only_of(only)
    has_sound(sound)
    return Options(
        names=wanted or tuple(all_mechanisms()),
        preset=preset_named(preset, aspect),
        show=show,
        spectra=spectra,
        sound=sound,
        watts=watts_of(watts),
        python=python or sys.executable,
        unfit=() if wanted else tuple(unfit_names()),
        whole=not wanted,
        anyway=anyway not in ("", "0"),
    )


def only_of(words: str) -> tuple[str, ...]:
    """Return the mechanisms of ``ONLY=four-bar,geneva_drive``, each once.

    Raises UserError for an unknown one.
    """
    return tuple(dict.fromkeys(known_name(word) for word in re.split(r"[,\s]+", words) if word))


def watts_of(words: str) -> float | None:
    """Return the power of ``WATTS=85`` (W); raises UserError if it is no positive number."""
    if not words.strip():
        return None
    try:
        watts = float(words)
    except ValueError:
        watts = math.nan
    if not 0 < watts < math.inf:
        raise UserError(
            f"{said(watts=words)} is not a power; give what this computer draws while it renders, in watts: "
            f"{said(watts='85')}"
        )
    return watts
