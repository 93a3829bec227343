"""A live server in a thread of the test, and a page that speaks with it."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import psutil
import pytest
import uvicorn
from websockets.sync.client import ClientConnection, connect

import mechanisms
from mechanisms.stages.loading import loading
from shared.stage import paths
from studio.live.__main__ import bound
from studio.live.messages import unframed
from studio.live.processes import nursery
from studio.live.processes.trees import MARK
from studio.live.server import LARGEST, Live
from studio.live.session import Session
from tests.studio.live import elsewhere
from tests.studio.live.arm import ARM

WAIT = 240.0
"""Seconds that a test waits at most; a machine may be busy."""

FOUR_BAR = '''"""A four-bar."""

from dataclasses import dataclass, field
from math import pi

from mbsd import Mechanism, constant_rate

STEPS = 48


@dataclass(frozen=True)
class Params:
    """m, rad/s."""

    ground: float = 0.120
    crank: float = field(default=0.040, metadata={"range": (0.02, 0.2)})
    coupler: float = 0.120
    rocker: float = 0.090
    tracer: tuple[float, float] = (0.060, 0.030)  # on the coupler
    teeth: int = 3
    speed: float = 2 * pi


def build(p: Params) -> Mechanism:
    """Pins A to D."""
    m = Mechanism("links")
    crank, coupler, rocker = m.bar("crank", p.crank), m.bar("coupler", p.coupler), m.bar("rocker", p.rocker)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(p.ground, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.trace("P", coupler.at(*p.tracer))
    m.start_near(crank=0, coupler=45, rocker=100)
    return m
'''


class Page:
    """Messages between the server and a browser's page."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._passed_over: list[dict[str, Any]] = []

    def say(self, **wish: Any) -> None:
        self._passed_over.clear()
        self._socket.send(json.dumps(wish))

    def hear(self, *kinds: str, wanted: Callable[[dict[str, Any]], bool] = lambda header: True) -> Any:
        """Return the next message of these kinds, with its payload under ``payload``."""
        ends = time.monotonic() + WAIT
        while True:
            frame = self._socket.recv(timeout=max(ends - time.monotonic(), 0.01))
            assert isinstance(frame, bytes)
            header, payload = unframed(frame)
            header["payload"] = payload
            if header["kind"] in kinds and wanted(header):
                return header
            self._passed_over.append(header)

    def heard(self, *kinds: str, wanted: Callable[[dict[str, Any]], bool] = lambda header: True) -> Any:
        """As :meth:`hear`, or a message of one of these kinds that was passed over since the page last said something.

        What a wish leads to by two ways, as an answer and as a file that is watched, comes in either order.
        """
        passed_over = (header for header in self._passed_over if header["kind"] in kinds and wanted(header))
        return next(passed_over, None) or self.hear(*kinds, wanted=wanted)


class Served:
    """A server, its folder of mechanisms, and doors for pages."""

    def __init__(self, live: Live, folder: Path) -> None:
        self.live, self.folder = live, folder

    @property
    def session(self) -> Session:
        assert self.live.session is not None
        return self.live.session

    @contextmanager
    def page(self, origin: str | None = None) -> Iterator[Page]:
        place = f"127.0.0.1:{self.live.port}"
        with connect(
            f"ws://{place}/{self.live.token}/socket",
            origin=origin or f"http://{place}",
            max_size=None,
            open_timeout=WAIT,
            close_timeout=1,
        ) as socket:
            yield Page(socket)

    def write(self, text: str | bytes, file: str = "mechanism.py") -> None:
        """Write a file as editors do: a new file replaces the old one."""
        folder = self.folder / self.session.name
        beside = folder / "unsaved"
        beside.write_bytes(text.encode() if isinstance(text, str) else text)
        beside.replace(folder / file)


def blank(_: Session) -> bytes:
    """Return a page for tests that look at none."""
    return b"<!doctype html>"


@contextmanager
def served(
    folder: Path,
    name: str,
    source: str,
    limit: float,
    parts: bool = False,
    show: Callable[[Session], bytes] = blank,
    files: Mapping[str, str] = MappingProxyType({}),
) -> Iterator[Served]:
    """Yield a server of one mechanism of a test's own."""
    (folder / name).mkdir(parents=True)
    for file, text in {"mechanism.py": source, **files}.items():
        (folder / name / file).write_text(text)
    patch = pytest.MonkeyPatch()
    patch.setenv(elsewhere.FOLDER, str(folder))
    patch.setattr(nursery, "WARM", "tests.studio.live.elsewhere")
    for module in (paths, loading):
        patch.setattr(module, "MECHANISMS", folder)
    patch.setattr(paths, "ROOT", folder.parent)
    patch.setattr(mechanisms, "__path__", [*mechanisms.__path__, str(folder)])
    listener = bound(0)
    live = Live(name, listener.getsockname()[1], show, limit, parts)
    config = uvicorn.Config(
        live.app, log_level="warning", lifespan="on", ws_max_size=LARGEST, server_header=False,
        ws_per_message_deflate=False,
    )  # fmt: skip
    server = uvicorn.Server(config)
    thread = threading.Thread(target=lambda: asyncio.run(server.serve(sockets=[listener])), daemon=True)
    thread.start()
    try:
        ends = time.monotonic() + WAIT
        while not server.started and time.monotonic() < ends:
            time.sleep(0.02)
        assert server.started
        yield Served(live, folder)
    finally:
        server.should_exit = True
        thread.join(WAIT)
        listener.close()
        patch.undo()
    assert not thread.is_alive()
    assert not processes_of(live.nursery.mark), "no process outlives the server"


def live_server(folder: str, name: str = "arm", source: str = ARM, limit: float = 30.0) -> Any:
    """Return a fixture of a test file: a server of one mechanism, once a page has its first motion."""

    @pytest.fixture(scope="module", name="live")
    def live(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
        with served(tmp_path_factory.mktemp(folder) / "mechanisms", name, source, limit) as server:
            with server.page() as page:
                page.hear("motion", "state", wanted=lambda header: bool(header["payload"]))
            yield server

    return live


def processes_of(mark: str) -> list[psutil.Process]:
    """Return running processes with this server's mark in their environment."""
    marked = []
    for process in psutil.process_iter():
        try:
            if process.status() != psutil.STATUS_ZOMBIE and process.environ().get(MARK) == mark:
                marked.append(process)
        except (psutil.Error, OSError):
            continue
    return marked
