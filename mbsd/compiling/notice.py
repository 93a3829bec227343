"""A notice that kernels are being compiled, for a user who waits for the first solution on a machine."""

from __future__ import annotations

import logging
import threading

from numba.core.event import Event, Listener, register

LOG = logging.getLogger("mbsd")
PATIENCE = 3.0
"""s of one kernel before the notice."""
SUBJECTS = {
    "mbsd.dynamics.batch": ("batches of simulations", "20 s"),
    "mbsd.dynamics.events": ("simulations with contacts, stops and events", "20 s"),
    "mbsd.dynamics": ("simulations", "15 s"),
    "mbsd.derivatives": ("derivatives", "20 s"),
    "mbsd.kinematics": ("sweeps", "10 s"),
    "mbsd": ("this kind of model", "5 s"),
}
"""Subject of the kernels of a package, and the time they take to compile on two idle cores; the first match counts."""


class CompileNotice(Listener):
    """Logs a warning, once, when a kernel of this package takes longer than ``patience`` (s) to compile.

    The outermost kernel says what is being compiled: it calls the others.
    """

    def __init__(self, patience: float = PATIENCE) -> None:
        self.patience = patience
        self._depth = 0
        self._timer: threading.Timer | None = None

    def on_start(self, event: Event) -> None:
        """Start the timer: a kernel begins to compile, perhaps for another one."""
        if not _ours(event):
            return
        self._depth += 1
        if self._timer is None:
            self._timer = threading.Timer(self.patience, self._tell, [_module(event)])
            self._timer.daemon = True
            self._timer.start()

    def on_end(self, event: Event) -> None:
        """Stop the timer: a kernel is compiled."""
        if not _ours(event):
            return
        self._depth -= 1
        if self._depth == 0 and self._timer is not None and self._timer.is_alive():
            self._timer.cancel()
            self._timer = None

    def _tell(self, module: str) -> None:
        subject, seconds = next(words for package, words in SUBJECTS.items() if f"{module}.".startswith(f"{package}."))
        LOG.warning(
            "mbsd: compiling the solver for %s, which takes about %s on idle cores and is kept for later runs; "
            "'mbsd compile' compiles all of it at once",
            subject,
            seconds,
        )


def _ours(event: Event) -> bool:
    return _module(event).split(".")[0] == __name__.split(".")[0]


def _module(event: Event) -> str:
    assert event.data is not None
    return event.data["dispatcher"].py_func.__module__


def give_notice() -> None:
    """Give notice from now on, in this process."""
    register("numba:compile", CompileNotice())
