"""Word that kernels are being compiled: for long ones of this package, once."""

from __future__ import annotations

import time
from types import SimpleNamespace

import numba
import pytest
from numba.core.event import Event, EventStatus

from mbsd.compiling.notice import CompileNotice


def event(status: EventStatus, module: str) -> Event:
    dispatcher = SimpleNamespace(py_func=SimpleNamespace(__module__=module))
    return Event("numba:compile", status, {"dispatcher": dispatcher})


@pytest.mark.parametrize(
    ("module", "wait", "words"), [("mbsd.equations.loads", 0.2, 1), ("mbsd.equations.loads", 0.0, 0), ("my", 0.2, 0)]
)
def test_long_compilations_of_the_package_are_told(caplog, module: str, wait: float, words: int) -> None:
    notice = CompileNotice(patience=0.05)
    for _ in range(2):
        for status in (EventStatus.START, EventStatus.START):
            notice.notify(event(status, module))
        time.sleep(wait)
        for status in (EventStatus.END, EventStatus.END):
            notice.notify(event(status, module))
    time.sleep(0.1)
    assert [record.levelname for record in caplog.records] == ["WARNING"] * words
    assert all("compiling the solver for this kind of model" in record.getMessage() for record in caplog.records)


def test_every_package_with_kernels_is_named(caplog) -> None:
    for module in (
        "mbsd.dynamics.integrators.dop853.loop",
        "mbsd.dynamics.batch.rows",
        "mbsd.kinematics.sweep",
        "mbsd.x",
    ):
        notice = CompileNotice(patience=0.0)
        notice.notify(event(EventStatus.START, module))
        time.sleep(0.05)
        notice.notify(event(EventStatus.END, module))
    said = [record.getMessage().partition(" for ")[2].partition(",")[0] for record in caplog.records]
    assert said == ["simulations", "batches of simulations", "sweeps", "this kind of model"]


def test_numba_tells_of_each_compilation() -> None:
    """The events that the notice listens to carry the dispatcher."""
    seen = []

    class Seen(CompileNotice):
        def on_start(self, event: Event) -> None:
            seen.append(event.data["dispatcher"].py_func.__module__)  # type: ignore[index]

        def on_end(self, event: Event) -> None:
            pass

    from numba.core.event import register, unregister

    listener = Seen()
    register("numba:compile", listener)
    try:
        numba.njit(lambda x: x + 1.0)(2.0)
    finally:
        unregister("numba:compile", listener)
    assert seen == [__name__]
