"""One mechanism as all open pages see it: its last good motion, its numbers, the current solve.

A save begins a new child with the files as they are now; until it has solved them the child of the last good motion
serves on, so a broken edit takes nothing away. Of many wishes of a slider the newest counts.
"""

from __future__ import annotations

import itertools
import time
from pathlib import Path
from typing import Any

from msgspec import to_builtins

from shared.stage.errors import UserError
from shared.stage.paths import mechanism_folder
from studio.live import messages
from studio.live.board import Board, Push, differing
from studio.live.fits import Fit
from studio.live.messages import Drag, Set, Wish, Write
from studio.live.processes.children import Child
from studio.live.processes.nursery import Nursery
from studio.live.processes.stages import Stages
from studio.live.watching import Watch
from studio.live.writing import Writer, Written


class Session:
    """State of a mechanism in the server."""

    def __init__(self, name: str, nursery: Nursery, push: Push, parts: bool = True) -> None:
        self.name, self._nursery, self._wants_parts = name, nursery, parts
        self.watch = Watch(mechanism_folder(name))
        self.board = Board(push)
        self.history = self.board.history
        self._count = itertools.count(1)
        self._good: Child | None = None
        self._new: Child | None = None
        self._wish: dict[str, Any] | None = None
        self._wished: dict[str, Any] | None = None
        self._parts_ready = self._solid_wanted = self._words_wanted = False
        self._wordless = False
        """True if the process of these files ended while it described its numbers: it is not asked again."""
        self._opened: dict[str, float] = {}
        """Numbers with which the files are being solved."""
        self._began = 0.0
        """Time at which the process that solves them was begun (s since the epoch)."""
        self.stages = Stages(name, nursery.mark, self.board.line, self._parts_made)
        self.writer = Writer(name, nursery)
        self.fit = Fit(name, nursery, self.board.tell, self._fitted, self._best_so_far)

    # -- files ----------------------------------------------------------------------------------------------------

    def changed(self, files: set[Path]) -> None:
        """React to changed files of the author, or to the start of the server."""
        self._wordless = False
        if files and all(file.name == "parts.py" and file.parent == self.watch.folder for file in files):
            self._make_parts()
            return
        self.reload()

    def reload(self, parts_ready: bool = False) -> None:
        """Load and solve the files as they are now; ``parts_ready`` if their parts are new."""
        if self.fit.running:
            self.fit.cancel()
        self.stages.end()
        self._parts_ready = parts_ready
        if self._new is not None:
            self._new.kill()
        self.board.begin(parts_ready)
        self._began = time.time()
        self._new, self._opened = self._nursery.child(self.name, self._heard_new), self.history.now
        self._new.ask(next(self._count), {"do": "open", "values": self._opened})

    def _heard_new(self, child: Child, header: dict[str, Any], payload: bytes) -> None:
        match header.get("kind"):
            case "files":
                self.watch.follow((Path(file) for file in header["files"]), self._began)
            case "line":
                self.board.line(header["text"])
            case "error" if child is self._new:
                child.kill()
                self._new = None
                if not self._without_changes(header["text"]):
                    self.board.fail(header["text"])
            case "motion" if child is self._new:
                self._new = None
                if self._good is not None:
                    self._good.kill()
                self._good, self._wish = child, None  # what waited for the old child is in the history, or was given up
                shown = self.board.solved(header["numbers"])
                self.board.motion(header, payload, self._opened)
                self._solid_wanted = shown or self._parts_ready
                if not self._parts_ready:
                    self._make_parts()
                self._parts_ready, self._words_wanted = False, not self._wordless
                if self.history.now != self._opened:  # numbers were set meanwhile
                    self._solve({"do": "set", "values": self.history.now, "final": True})
                else:
                    self._go_on()
            case _:
                self._heard(child, header, payload)

    def _without_changes(self, text: str) -> bool:
        """Solve the file once more as it stands if the sliders' numbers do not fit it.

        Returns False if there are no such numbers.
        """
        if not self.history.now:
            return False
        self.board.line(f"the numbers of the sliders do not fit this file, so they were dropped: {text}")
        self.history.add({})
        self.reload()
        return True

    # -- wishes of the page -----------------------------------------------------------------------------------------

    def ask(self, wish: Wish) -> None:
        """Carry out a page's request. Raises UserError if that is impossible."""
        match wish:
            case Set():
                self._set(wish)
            case Drag():
                self._solve({**to_builtins(wish), "values": self.history.now})
            case Write():
                self._write(wish)
            case messages.Fit():
                messages.known(wish.vary or (), self.board.numbers)
                self.fit.begin(wish, self.history.now)
            case messages.Undo():
                self._undo()
            case messages.Redo():
                self._solve({"do": "set", "values": self.history.redo(), "final": True})
                self.board.tell_values()
            case messages.Cancel():
                self.fit.cancel()

    def _set(self, wish: Set) -> None:
        messages.known(wish.values, self.board.numbers)
        values = differing(self.history.now | wish.values, self.board.file)
        if wish.final:
            self.history.add(values)
            self.board.tell_values()
        self._solve({**to_builtins(wish), "values": values})

    def _undo(self) -> None:
        # A drag that has ended but is not solved yet is what there is to undo.
        values = self.history.now if self._drop_drag() else self.history.undo()
        self._solve({"do": "set", "values": values, "final": True})
        self.board.tell_values()

    def _drop_drag(self) -> bool:
        """Forget a drag that is being solved or waits; return True if one had ended."""
        busy = self._wished if self._good is not None and self._good.busy else None
        drags = [wish for wish in (busy, self._wish) if wish is not None and wish["do"] == "drag" and wish.get("final")]
        for drag in drags:
            drag["final"] = False
        return bool(drags)

    def _write(self, wish: Write) -> None:
        if self.board.error is not None:
            raise UserError("mechanism.py has an error, so nothing is written into it; fix it first")
        messages.known(wish.names or (), self.board.numbers)
        now = self.history.now
        values = {name: now[name] for name in (now if wish.names is None else wish.names) if name in now}
        if not values:
            raise UserError("no number differs from the file, so there is nothing to write")
        whole = {number["name"] for number in self.board.numbers if number["whole"]}
        before = self.board.file

        def report(written: Written) -> None:
            self.history.written(values, before)
            self.board.tell_values()
            self.board.line(written.text)

        self.writer.begin(
            {name: round(value) if name in whole else value for name, value in values.items()},
            self.board.numbers,
            report,
            lambda text: self.board.tell({"kind": "refused", "text": text}),
        )

    def _best_so_far(self, values: dict[str, float] | None) -> None:
        """Show a fit's best linkage so far, outside the history; None: the fit ended without one."""
        request = {"do": "set", "values": self.history.now if values is None else values, "final": values is None}
        self._solve(request)

    def _fitted(self, values: dict[str, float]) -> None:
        self.history.add(differing(values, self.board.file))
        self.board.tell_values()
        self._solve({"do": "set", "values": self.history.now, "final": True})

    def _solve(self, request: dict[str, Any]) -> None:
        """Give this request to the good child when it is free; of several the newest counts."""
        if self._good is None or self._good.ended:
            return
        if self._good.busy:
            self._wish = request
            return
        self._wish, self._wished = None, request
        self._good.ask(next(self._count), request)

    def _heard(self, child: Child, header: dict[str, Any], payload: bytes) -> None:
        """Handle a message of the good child."""
        if child is not self._good:
            return
        kind, asked = header.get("kind"), self._wished
        if kind == "line":
            self.board.line(header["text"])
            return
        if kind not in ("motion", "error", "solid", "described"):
            return
        if kind == "solid":
            self.board.parts(payload)
        elif (asked or {}).get("do") == "describe":
            self._wordless = child.ended
            self.board.describe(header.get("words") or {})
        elif kind == "motion":
            values = header.get("values") or (asked or {}).get("values") or {}
            if asked and asked["do"] == "drag" and asked.get("final"):
                self.history.add(differing(header["values"], self.board.file))
                self.board.tell_values()
            self.board.motion(header, payload, values)
        elif (asked or {}).get("do") == "solid":
            self.board.line(header["text"])
        else:
            self.board.tell({"kind": "refused", "text": header["text"], "values": (asked or {}).get("values")})
        if child.ended:
            self._good = None
            self.reload()
        else:
            self._go_on()

    def _go_on(self) -> None:
        """Give the good child the request that waits."""
        if self._wish is not None:
            self._solve(self._wish)
        elif self._solid_wanted:
            self._solid_wanted = False
            self._solve({"do": "solid"})
        elif self._words_wanted:
            self._words_wanted = False
            self._solve({"do": "describe"})

    # -- the rest ---------------------------------------------------------------------------------------------------

    def greeting(self) -> list[bytes]:
        """Return the messages that bring a newly opened page up to date."""
        return self.board.greeting(name=self.name, solving=self._new is not None, making=self.stages.running)

    async def end(self) -> None:
        """End everything that runs for it."""
        self.fit.end()
        self.writer.end()
        for child in (self._good, self._new):
            if child is not None:
                child.kill()
        await self.stages.ended()

    def _make_parts(self) -> None:
        if self._wants_parts:
            self.stages.begin()
            self.board.tell({"kind": "parts", "state": "making"})

    def _parts_made(self, good: bool) -> None:
        self.board.tell({"kind": "parts", "state": "ready" if good else "failed"})
        if good and self._new is None:
            self.reload(parts_ready=True)
