"""Coordinator of the steps of every mechanism: one render always running, other steps beside it.

What is to be made is decided by stamps and pictures alone, so after whatever end the same command goes on.
"""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress

from shared.cluster.address import address
from shared.stage.console import duration
from shared.stage.errors import BUSY, UserError
from studio.night.books import Books
from studio.night.plan.options import Options
from studio.night.plan.steps import FILM, STEPS, Board, Step, command
from studio.night.process import Process, ending, is_tried_again, limit
from studio.night.runs import Claims, Log, Run

TICK = 0.1
"""Seconds between two looks at the processes."""
ELSEWHERE = 2.0
"""Seconds between two tries for a mechanism that another run has."""
BUSY_ELSEWHERE = 10.0
"""The same where another process, which is no run, has the frames of a film."""
AWAY, MOST_AWAY = ("parts",), 4
"""Steps that workers of a cluster do, and how many of them wait for these at once beside what takes a core here."""
LONGEST_TICK = 5.0
"""Seconds of silence that one look counts at most."""


class Coordinator:
    """One run over the mechanisms of ``asked``; ``environment`` is added to that of the steps."""

    def __init__(
        self,
        asked: Options,
        run: Run,
        log: Log,
        board: Board,
        steps: Sequence[Step] = STEPS,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        self.asked, self.run, self.log, self.board = asked, run, log, board
        self.steps = {step.name: step for step in steps}
        self.cores = os.process_cpu_count() or 1
        self.environment = dict(environment or {})
        self.claims = Claims()
        self.running: list[Process] = []
        self.books = Books(asked, run, log, board)
        self._tries: dict[tuple[str, str], int] = {}
        self._elsewhere: dict[str, float] = {}
        """Moment of the next try, by mechanism that another run has."""
        self._looked = time.monotonic()

    def go(self) -> bool:
        """Run all steps; False if somebody stopped it. However it ends, no process remains."""
        self.books.moved()
        try:
            while not self.board.is_over():
                if self.run.is_asked_to_stop():
                    self._stop_after_frame()
                    return False
                self._start()
                time.sleep(TICK)
                self._look()
            return True
        finally:
            self._end_all()

    def _start(self) -> None:
        """Start one render, and beside it as many steps as cores are free."""
        rendering = any(self.steps[process.step].renders for process in self.running)
        if not rendering:
            rendering = self._start_first(renders=True)
        places = max(self.cores - 1, 0) if rendering else self.cores
        while self._is_place_free(places) and self._start_first(renders=False):
            pass

    def _others(self) -> list[Process]:
        return [process for process in self.running if not self.steps[process.step].renders]

    def _is_place_free(self, places: int) -> bool:
        beside = self._others()
        away = sum(process.step in AWAY for process in beside) if address() else 0
        return len(beside) - min(away, MOST_AWAY) < places

    def _start_first(self, renders: bool) -> bool:
        """Start the most urgent step whose mechanism is free; False if there is none."""
        now = time.monotonic()
        for name, step in self.board.ready(renders):
            if self._elsewhere.get(name, now) > now:
                continue
            try:
                who = self.claims.claim(name)
            except UserError as error:
                self.log.fail(f"{name}: {error}")
                self.books.error(name, f"{step}: {error}")
                self.board.fail(name, step)
                self.books.moved()
                continue
            if who:
                self._elsewhere[name] = now + ELSEWHERE
                self.board.away.add(name)
                self.books.elsewhere(name, f"another run is at it ({who})")
                continue
            self._elsewhere.pop(name, None)
            self.board.away.discard(name)
            self.books.started(name, step)
            try:
                process = Process(name, step, command(step, name, self.asked), not renders, self.environment)
            except OSError as error:  # no memory for another process, or too many of them
                self.claims.give_back(name)
                self._elsewhere[name] = now + BUSY_ELSEWHERE
                self.log.warn(f"{name}: {step} could not be started ({error.strerror}); it is tried again")
                continue
            self._tries[name, step] = self._tries.get((name, step), 0) + 1
            self.running.append(process)
            self.board.start(name, step)
            self.books.changed()
            return True
        return False

    def _look(self) -> None:
        """Pass on output, count pictures, collect ended steps and kill hanging ones."""
        now = time.monotonic()
        passed, self._looked = min(now - self._looked, LONGEST_TICK), now
        for process in list(self.running):
            code = process.code()
            said = process.lines()
            for line in said:
                self.log.relay(line if process.name in line else f"{process.name}: {line}")
            renders = self.steps[process.step].renders
            alive = self.books.new_picture(process.name) if renders else bool(said)
            process.live(passed, alive)
            if code is not None:
                self._ended(process)
            elif not process.hung:
                making = renders and not self.books.is_complete(process.name)
                longest = limit(making, self.books.each(process.name), process.signs)
                if process.silence > longest:
                    process.hung = True
                    self.log.warn(f"{process.name}: {process.step} was silent for {duration(longest)}")
                    self._kill(process)
        self.books.write_if_due()

    def _kill(self, process: Process) -> None:
        process.end()
        process.wait()

    def _ended(self, process: Process) -> None:
        name, step = process.name, process.step
        self.running.remove(process)
        process.close()
        self.claims.give_back(name)
        self.books.ended(name, step, time.monotonic() - process.started)
        if process.code() == 0 and not process.hung:
            self.board.finish(name, step)
        elif process.code() == BUSY:
            self._tries[name, step] -= 1
            self._elsewhere[name] = time.monotonic() + BUSY_ELSEWHERE
            self.board.away.add(name)
            self.board.wait(name, step)
            self.books.elsewhere(name, "another process renders it")
        else:
            why = ending(process)
            again = is_tried_again(process, self._tries[name, step])
            self.books.error(name, f"{step}: {why}")
            if again:
                self.log.warn(f"{name}: {step}: {why}; it is started again")
                self.board.wait(name, step)
            else:
                self.log.fail(f"{name}: {step} failed: {why}")
                self.board.fail(name, step)
        self.books.moved()

    def _stop_after_frame(self) -> None:
        """End the steps beside the render at once, the render after its next picture."""
        self.log.say("stop requested; the run ends after the current frame")
        for process in self._others():
            process.end()
        while self.running:
            time.sleep(TICK)
            for process in list(self.running):
                for line in process.lines():
                    self.log.relay(line if process.name in line else f"{process.name}: {line}")
                renders = self.steps[process.step].renders
                framed = renders and self.books.new_picture(process.name)
                if framed and not (process.step == FILM and self.books.frames[process.name].left == 0):
                    process.end()  # the last picture is followed by the film, which takes a moment
                if process.code() is not None:
                    self.running.remove(process)
                    process.close()
                    self.claims.give_back(process.name)
                    good = process.code() == 0
                    (self.board.finish if good else self.board.wait)(process.name, process.step)
            self.books.write_if_due()

    def _end_all(self) -> None:
        """End all running steps after an internal error or a signal."""
        for process in self.running:
            process.end()
        for process in self.running:
            process.wait()
            self.board.wait(process.name, process.step)
            with suppress(OSError):
                process.close()
        self.running.clear()
