"""The server of the live page: Starlette on loopback, a websocket for each page, one session for all of them."""

from __future__ import annotations

import asyncio
import json
import secrets
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from shared.stage.errors import UserError
from studio.live.children import Nursery
from studio.live.frames import framed
from studio.live.gate import Gate
from studio.live.mailbox import Mailbox
from studio.live.session import Session

LARGEST = 1 << 20
"""Bytes of a message from a page."""
WORDS = 32
"""Bytes of the token."""


class Pages:
    """The open pages: each gets all messages."""

    def __init__(self) -> None:
        self._boxes: set[Mailbox] = set()

    def push(self, frame: bytes, replaces: bool = False) -> None:
        """Send every page a frame; one that ``replaces`` makes an older such needless."""
        for box in self._boxes:
            box.put(frame, replaces)

    def open(self) -> Mailbox:
        """The messages of a page that has just opened."""
        box = Mailbox()
        self._boxes.add(box)
        return box

    def close(self, box: Mailbox) -> None:
        """It has gone."""
        self._boxes.discard(box)

    def __len__(self) -> int:
        return len(self._boxes)


class Live:
    """All of the server: ``app`` is what uvicorn serves."""

    def __init__(
        self, name: str, port: int, page: Callable[[Session], bytes], limit: float, parts: bool = True, token: str = ""
    ) -> None:
        self.token = token or secrets.token_urlsafe(WORDS)
        self.port = port
        self._page = page
        self.pages = Pages()
        self.nursery = Nursery(limit)
        self._name, self._parts = name, parts
        self.session: Session | None = None
        self._ended = False
        routes = [
            Route("/{token}/", self._show, methods=["GET"]),
            WebSocketRoute("/{token}/socket", self._socket),
        ]
        self.app = Gate(Starlette(routes=routes, lifespan=self._lifespan), self.token, port)

    @property
    def address(self) -> str:
        """What a browser opens."""
        return f"http://127.0.0.1:{self.port}/{self.token}/"

    @asynccontextmanager
    async def _lifespan(self, _: Starlette) -> AsyncIterator[None]:
        self.session = Session(self._name, self.nursery, self.pages.push, self._parts)
        watching = asyncio.create_task(self._watch(self.session))
        try:
            yield
        finally:
            self._ended = True
            watching.cancel()
            with suppress(asyncio.CancelledError):
                await watching
            self.session.end()

    async def _watch(self, session: Session) -> None:
        """Begin once the warm process is, and follow the files from then on; a page may open meanwhile."""
        await asyncio.get_running_loop().run_in_executor(None, self.nursery.warm)
        session.reload()
        async for files in session.watch.changes(lambda: self._ended):
            session.changed(files)

    async def _show(self, _: Request) -> Response:
        assert self.session is not None, "the server answers once it has begun"
        page = await asyncio.get_running_loop().run_in_executor(None, self._page, self.session)
        return Response(page, media_type="text/html; charset=utf-8")

    async def _socket(self, socket: WebSocket) -> None:
        session = self.session
        if session is None:
            await socket.close(1013)
            return
        await socket.accept()
        box = self.pages.open()
        for frame in session.greeting():
            box.put(frame)
        sending = asyncio.create_task(_send_all(socket, box))
        try:
            while True:
                self._take(session, await socket.receive_text(), box)
        except (WebSocketDisconnect, KeyError, RuntimeError):
            pass
        finally:
            self.pages.close(box)
            sending.cancel()

    def _take(self, session: Session, text: str, box: Mailbox) -> None:
        """Do what a page asks for; what cannot be done is reported to that page."""
        try:
            wish = json.loads(text)
            if not isinstance(wish, dict):
                raise UserError("a page asks by a JSON object")
            session.ask(wish)
        except UserError as error:
            box.put(framed({"kind": "refused", "text": str(error)}))
        except (ValueError, RecursionError) as error:
            box.put(framed({"kind": "refused", "text": f"the page's message is no JSON: {error}"}))


async def _send_all(socket: WebSocket, box: Mailbox) -> None:
    with suppress(WebSocketDisconnect, RuntimeError, OSError):
        while True:
            await socket.send_bytes(await box.get())
