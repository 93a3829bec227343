"""Books of a run: pictures, pace and errors of its films, its record and its forecast."""

from __future__ import annotations

import os
import socket
import time
from datetime import datetime
from typing import Literal

from shared.stage.paths import out_root
from studio.night import runs
from studio.night.forecast import Forecast, Frames, forecast, refuse
from studio.night.plan.options import Options
from studio.night.plan.steps import FILM, PROBE, Board
from studio.night.runs import FilmRecord, Log, NightRecord, Run

GAP = 0.5
"""Seconds between two writings of the record, where only pictures were made."""
REFINED, OFTEN, SELDOM = 60.0, 4.0, 1800.0
"""Seconds until the forecast is stated as it is by then; each time so many times later, until that seldom."""


class Books:
    """Books of one coordinator."""

    def __init__(self, asked: Options, run: Run, log: Log, board: Board) -> None:
        self.asked, self.run, self.log, self.board = asked, run, log, board
        self.frames: dict[str, Frames] = {}
        self._films = {name: FilmRecord(outcome="waiting", steps={}) for name in asked.names}
        self._record = NightRecord(
            process=os.getpid(),
            host=socket.gethostname(),
            preset=asked.preset.name,
            started=_now(),
            updated=_now(),
            films=self._films,
        )
        self._due = True
        self._written = 0.0
        self._told: float | None = None
        """Time at which the forecast was stated last (monotonic)."""
        self._again = REFINED
        self._said: set[tuple[str, str]] = set()

    def started(self, name: str, step: str) -> None:
        """Record that a step begins."""
        self._films[name].elsewhere = ""
        if step in (PROBE, FILM):
            self._read(name)
            self.frames[name].begin()

    def ended(self, name: str, step: str, seconds: float) -> None:
        """Record that a step has ended, well or not."""
        self._films[name].seconds += seconds
        if step in (PROBE, FILM):
            self._read(name)

    def error(self, name: str, text: str) -> None:
        """Keep the last error of a mechanism."""
        self._films[name].error = text

    def elsewhere(self, name: str, who: str) -> None:
        """Record that another process works on this mechanism; ``who`` names it."""
        if self._films[name].elsewhere != who:
            self._films[name].elsewhere = who
            if (name, who) not in self._said:
                self._said.add((name, who))
                self.log.say(f"{name}: {who}; it waits for that")
            self.changed()

    def new_picture(self, name: str) -> bool:
        """Look at the folder of a film that is being rendered; return True if a picture has come."""
        if not self.frames[name].look():
            return False
        self._due = True
        return True

    def is_complete(self, name: str) -> bool:
        """Return True if every picture of a film exists, so only the film is to be written."""
        return name in self.frames and bool(self.frames[name].all) and not self.frames[name].left

    def each(self, name: str) -> float | None:
        """Return the seconds a picture of a film takes."""
        return self.frames[name].each if name in self.frames else None

    def moved(self) -> None:
        """Write the record after a change of the board; state the forecast once every probe is over."""
        if self.board.is_measured() and self._told is None and not self.board.is_over():
            self.tell_forecast("forecast")
        self.changed()

    def changed(self) -> None:
        """Write the record now."""
        self._due, self._written = True, 0.0
        self.write_if_due()

    def write_if_due(self) -> None:
        """Write the record if anything has changed; repeat the forecast now and then."""
        now = time.monotonic()
        if self._told is not None and now - self._told > self._again and not self.board.is_over():
            self._again = min(OFTEN * self._again, SELDOM)
            self.tell_forecast("as it is now")
        if self._due and now - self._written >= GAP:
            self._due, self._written = False, now
            self._write()

    def close(self, ended: Literal["done", "failed", "stopped"], why: str = "") -> None:
        """End the record of the run; ``why`` is stated in place of its forecast."""
        self._record.ended = ended
        self._record.forecast = f"not begun: {why}" if why else self._record.forecast
        self._write()

    def forecast(self) -> Forecast:
        """Return the forecast of the work that is left now."""
        films = [name for name in self.asked.names if self.board.outcome(name) in ("waiting", "at work")]
        known = [self.frames[name] for name in films if name in self.frames and self.frames[name].all]
        return forecast(known, len(films) - len(known), self.asked.preset, out_root())

    def tell_forecast(self, word: str) -> None:
        """State the forecast, with a warning if the disk may be too small.

        Raises UserError if it surely is.
        """
        first, self._told = self._told is None, time.monotonic()
        self._read_what_is_there()
        forecast = self.forecast()
        self._record.forecast = forecast.words(datetime.now(), self.asked.watts)
        self.log.say(f"{word}: {self._record.forecast}")
        if first:
            refuse(self.asked, forecast)
        if first and not forecast.fits:
            self.log.warn(
                f"the disk may be too small for all of it; films are made as long as there is room. Free some space on "
                f"the disk of {out_root()}, take a smaller PRESET or set MBSD_OUT to another disk"
            )

    def seconds(self, name: str) -> float:
        """Return the seconds that the steps of a mechanism took in this run."""
        return self._films[name].seconds

    def _read_what_is_there(self) -> None:
        """Count the pictures of films whose poster existed already."""
        for name in self.asked.names:
            if name not in self.frames and self.board.state(name, FILM) == "waiting":
                self._read(name)

    def _read(self, name: str) -> None:
        frames = self.frames.setdefault(name, Frames(name, self.asked.preset))
        frames.read(self.asked.show)

    def _write(self) -> None:
        for name, film in self._films.items():
            film.outcome, film.steps = self.board.outcome(name), dict(self.board.steps_of(name))
            if name in self.frames:
                known = self.frames[name]
                film.done, film.all, film.each = known.existing, known.all, known.each
                film.left = None if known.each is None else known.left * known.each
        self._record.left = self.forecast().seconds
        self._record.updated = _now()
        runs.write(self.run, self._record)


def _now() -> str:
    return datetime.now().isoformat(" ", "seconds")
