"""Record of a run: the state of every film, rewritten after each change. Nothing depends on it."""

from __future__ import annotations

from typing import Literal

import msgspec

from shared.stage import jsonfile
from shared.stage.errors import UserError
from studio.night.files.runs import Run


class FilmRecord(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One mechanism."""

    outcome: Literal["waiting", "at work", "done", "failed"]
    steps: dict[str, str]
    """State by step, as of the board."""
    seconds: float = 0.0
    """Seconds that its steps took in this run, added up."""
    done: int = 0
    """Pictures of the film that are there."""
    all: int = 0
    """Pictures of the film; 0 until motion, parts and shot are there."""
    each: float | None = None
    """Seconds a picture."""
    left: float | None = None
    """Seconds until the last picture."""
    error: str = ""
    """The last error, of whichever step."""
    elsewhere: str = ""
    """The other process that is at it, in words; empty if none is."""


class NightRecord(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """One run."""

    schema: Literal["mbsd.night"] = "mbsd.night"
    schema_version: Literal[1] = 1
    process: int
    host: str
    preset: str
    started: str
    """Local date and time."""
    updated: str
    ended: Literal["", "done", "failed", "stopped"] = ""
    """Empty while it runs, and for ever where it was killed."""
    forecast: str = ""
    """The forecast of the whole night, in a sentence; empty until it stands."""
    left: float | None = None
    """Seconds until the last film, of what is known."""
    films: dict[str, FilmRecord]


def write(run: Run, record: NightRecord) -> bool:
    """Write the record; False if the disk takes none, which stops no film."""
    try:
        jsonfile.write(run.record, record)
    except UserError:
        return False
    return True


def read(run: Run) -> NightRecord | None:
    """Return the record of a run; None if there is none or it cannot be read."""
    try:
        return jsonfile.read(run.record, NightRecord)
    except UserError:
        return None
