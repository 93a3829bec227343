"""Fit of the lengths to a drawn path, in a child of its own.

The sliders go on meanwhile, and the fit can be ended at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from msgspec import to_builtins

from studio.live.messages import Fit as Wanted
from studio.live.processes.children import Child
from studio.live.processes.nursery import Nursery

Tell = Callable[[dict[str, Any]], None]


class Fit:
    """One fit at most; a newer one ends it."""

    def __init__(
        self,
        name: str,
        nursery: Nursery,
        tell: Tell,
        fitted: Callable[[dict[str, float]], None],
        best: Callable[[dict[str, float] | None], None],
    ) -> None:
        """Prepare fits; ``best`` gets the numbers of the best linkage so far.

        It gets None if a fit ends without any.
        """
        self._name, self._nursery, self._tell, self._found, self._best = name, nursery, tell, fitted, best
        self._shown = False
        self._child: Child | None = None

    @property
    def running(self) -> bool:
        """True if a fit is under way."""
        return self._child is not None

    def begin(self, wish: Wanted, values: dict[str, float]) -> None:
        """Begin a fit from these numbers; it has no time limit."""
        self.end()
        self._shown = False
        self._child = self._nursery.child(self._name, self._heard, limit=0)
        self._child.ask(0, {**to_builtins(wish), "values": values})
        self._tell({"kind": "progress", "done": 0.0, "error": None})

    def cancel(self) -> None:
        """End the fit and report that none runs, also if it has ended already."""
        self.end()
        self._tell({"kind": "fitted", "cancelled": True})
        self._as_before()

    def end(self) -> None:
        """End the fit, if there is one."""
        if self._child is not None:
            self._child.kill()
            self._child = None

    def _heard(self, child: Child, header: dict[str, Any], _: bytes) -> None:
        if child is not self._child:
            return
        match header.get("kind"):
            case "progress":
                values = header.pop("values", None)
                self._tell(header)
                if values is not None:
                    self._shown = True
                    self._best(values)
            case "error":
                self.end()
                self._tell({"kind": "fitted", "error": header["text"]})
                self._as_before()
            case "fitted":
                self.end()
                self._tell(header)
                self._found(header["values"])

    def _as_before(self) -> None:
        if self._shown:
            self._shown = False
            self._best(None)
