"""Word that kernels are being compiled, for who waits for the first solution on a machine."""

from __future__ import annotations

import logging
import threading

from numba.core.event import Event, Listener, register

LOG = logging.getLogger("mbsd")
PATIENCE = 3.0
"""s of one kernel before a word is said."""


class CompileNotice(Listener):
    """Logs a warning, once, when a kernel of this package takes longer than ``patience`` (s) to compile."""

    def __init__(self, patience: float = PATIENCE) -> None:
        self.patience = patience
        self._depth = 0
        self._timer: threading.Timer | None = None

    def on_start(self, event: Event) -> None:
        """A kernel begins to compile, perhaps for another one."""
        if not _ours(event):
            return
        self._depth += 1
        if self._timer is None:
            self._timer = threading.Timer(self.patience, self._tell)
            self._timer.daemon = True
            self._timer.start()

    def on_end(self, event: Event) -> None:
        """It is compiled."""
        if not _ours(event):
            return
        self._depth -= 1
        if self._depth == 0 and self._timer is not None and self._timer.is_alive():
            self._timer.cancel()
            self._timer = None

    def _tell(self) -> None:
        LOG.warning("mbsd: compiling for this machine, which is done once and takes a minute or more")


def _ours(event: Event) -> bool:
    assert event.data is not None
    return event.data["dispatcher"].py_func.__module__.split(".")[0] == __name__.split(".")[0]


def give_notice() -> None:
    """From now on, in this process."""
    register("numba:compile", CompileNotice())
