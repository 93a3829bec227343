"""``mbsd stop``: end every run on this tree after the frame in flight, and report the end."""

from __future__ import annotations

import time

from shared.stage.console import duration, say
from shared.stage.errors import UserError
from shared.stage.files import refusal
from studio.night.files import record, runs
from studio.night.files.runs import Run

LOOK = 0.2
"""Seconds between two looks."""
WORD = 30.0
"""Seconds between two words on what is waited for."""


def stop() -> int:
    """Stop all runs and wait for their end; 0 also without any.

    Raises UserError if it cannot ask.
    """
    running = runs.alive()
    if not running:
        say("stop", "no night is at work here")
        return 0
    for run in running:
        try:
            run.ask_to_stop()
        except OSError as error:
            raise UserError(refusal(run.wish, error)) from error
    began = announced = time.monotonic()
    for run in running:
        say("stop", f"run {run.number} ends after {_in_flight(run)}; Ctrl-C leaves it to that")
        while run.is_alive():
            time.sleep(LOOK)
            if time.monotonic() - announced > WORD:
                announced = time.monotonic()
                say("stop", f"run {run.number}: {duration(announced - began)}, still {_in_flight(run)}")
        say("stop", f"run {run.number} has ended after {duration(time.monotonic() - began)}; the same command goes on")
    return 0


def _in_flight(run: Run) -> str:
    """Return the work it waits for: ``the frame in flight of four_bar (about 8.3 s)``."""
    recorded = record.read(run)
    if recorded is not None:
        for name, film in recorded.films.items():
            if any(film.steps.get(step) == "running" for step in ("poster", "film")):
                return f"the frame in flight of {name}" + (f" (about {duration(film.each)})" if film.each else "")
    return "what it is at"
