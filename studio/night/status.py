"""``mbsd status`` and ``mbsd stop``: the state of every film, from files alone, and the end of runs."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from datetime import datetime, timedelta

from render.freshness import Freshness
from shared.stage.console import duration, say
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import refusal
from shared.stage.paths import Out
from shared.stage.stages import is_recorded
from studio.night import runs
from studio.night.runs import FilmRecord, NightRecord, Run

# ``mbsd status``: the state of every film, from files alone, during a run and after its end.


HEAD = ("film", "frames", "each", "left", "at")


def tell() -> int:
    """Print the state of every run, a row for each film; always 0."""
    known = [(run, recorded) for run in runs.runs() if (recorded := runs.read(run)) is not None]
    if not known:
        start, here = to_run("overnight"), to_run("all")
        print(f"No night was started here yet: {start} starts one, {here} the same in this terminal.")
        return 0
    sys.stdout.write("\n".join("\n".join(words(run, recorded, run.is_alive())) for run, recorded in known) + "\n")
    return 0


def words(run: Run, recorded: NightRecord, alive: bool) -> list[str]:
    """Return the lines of one run."""
    lines = [f"{standing(recorded, alive)} (run {run.number}, {recorded.preset}, started {recorded.started})"]
    if recorded.forecast:
        lines.append(f"forecast: {recorded.forecast}")
    if alive and recorded.left:
        end = datetime.now() + timedelta(seconds=recorded.left)
        lines.append(f"now: {duration(recorded.left)} left, until {end:%a %H:%M}")
    older = older_films(recorded)
    lines += table([row(name, film, alive, name in older) for name, film in recorded.films.items()])
    for name, film in recorded.films.items():
        if film.error:
            lines.append(f"{name}: {film.error}" + ("; done since then" if film.outcome == "done" else ""))
    lines.append(f"log: {runs.log_file()}")
    return lines


def standing(recorded: NightRecord, alive: bool) -> str:
    """Return the state of the run in a few words."""
    if alive:
        return f"at work as process {recorded.process} on {recorded.host}"
    how = {
        "done": "done",
        "failed": "over, with failures; the same command tries these again",
        "stopped": "stopped; the same command goes on from here",
        "": "ended without a word: killed, or the machine went down; the same command goes on from here",
    }
    return f"{how[recorded.ended]}, last seen {recorded.updated}"


def older_films(recorded: NightRecord) -> set[str]:
    """Return the mechanisms that have changed since their films of a run were made."""
    done = {name: Out(name) for name, film in recorded.films.items() if film.outcome == "done"}
    films = {name: out.film(recorded.preset) for name, out in done.items()}
    known = [name for name, film in films.items() if is_recorded(done[name], film)]
    freshness = Freshness(known)
    return {name for name in known if freshness.why_older(done[name], films[name])}


def row(name: str, film: FilmRecord, alive: bool, is_older: bool = False) -> tuple[str, ...]:
    """Return name, frames, seconds a frame, time left and state of a film.

    ``is_older``: its film is of an older version.
    """
    running = [step for step, state in film.steps.items() if state == "running"]
    if film.elsewhere:
        at = film.elsewhere
    elif running and alive:
        at = ", ".join(running)
    elif film.outcome == "failed":
        at = "failed: " + ", ".join(step for step, state in film.steps.items() if state == "failed")
    elif film.outcome == "done":
        at = "done, of an older version" if is_older else "done"
    else:
        at = "waits" if alive else "not finished"
    over = film.outcome == "done"
    left = "" if over or film.left is None or film.outcome == "failed" else duration(film.left)
    frames = f"{film.all if over else film.done}/{film.all}" if film.all else ""
    each = "" if film.each is None else f"{film.each:.2f} s" if film.each < 9.95 else duration(film.each)
    return name, frames, each, left, at


def table(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Return the rows under :data:`HEAD`, numbers to the right."""
    full = [HEAD, *rows]
    widths = [max(len(line[column]) for line in full) for column in range(len(HEAD))]
    lines = []
    for line in full:
        first, *numbers, last = line
        middle = "  ".join(word.rjust(width) for word, width in zip(numbers, widths[1:-1], strict=True))
        lines.append(f"  {first.ljust(widths[0])}  {middle}  {last}".rstrip())
    return lines


# ``mbsd stop``: end every run on this tree after the current frame, and report the end.


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
    """Return the work it waits for: ``the current frame of four_bar (about 8.3 s)``."""
    recorded = runs.read(run)
    if recorded is not None:
        for name, film in recorded.films.items():
            if any(film.steps.get(step) == "running" for step in ("poster", "film")):
                return f"the current frame of {name}" + (f" (about {duration(film.each)})" if film.each else "")
    return "what it is at"
