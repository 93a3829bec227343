"""Server of the live page: Starlette on loopback, a websocket for each page, one session for all."""

from __future__ import annotations

import asyncio
import hmac
import secrets
import traceback
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from shared.stage.errors import UserError
from studio.live.messages import Mailbox, framed, wish_of
from studio.live.processes.nursery import Nursery
from studio.live.processes.warm_process import Failed
from studio.live.session import Session

# Access to the server: only pages of its own address that know its token may speak to it.
#
# The server listens on loopback alone, but every page that a browser shows can send requests there. So a request needs
# the token in its path, a Host that is this machine's (a foreign name that was pointed at 127.0.0.1 is refused), and
# where the browser says which page sent it (Origin, Sec-Fetch-Site), that must be one of this server. So it is
# for HTTP and websockets alike.


HOSTS = ("127.0.0.1", "localhost", "[::1]")
HEADERS = {
    "cache-control": "no-store",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "x-frame-options": "DENY",
}


class Gate:
    """ASGI middleware that answers 403 without a reason, and closes websockets before they open."""

    def __init__(self, app: Any, token: str, port: int) -> None:
        self.app, self.token = app, token
        self.hosts = {f"{host}:{port}" for host in HOSTS}
        self.origins = {f"http://{host}" for host in self.hosts}

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Pass on a request if it is allowed."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        if not self.allows(scope):
            await _refuse(scope, receive, send)
            return

        async def with_headers(message: Any) -> None:
            if message["type"] == "http.response.start":
                own = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
                message = {**message, "headers": [*message.get("headers", []), *own]}
            await send(message)

        await self.app(scope, receive, with_headers)

    def allows(self, scope: Any) -> bool:
        """Return True if a request is allowed."""
        given: dict[str, list[str]] = {}
        for name, value in scope["headers"]:
            given.setdefault(name.decode("latin-1").lower(), []).append(value.decode("latin-1"))
        if len(given.get("host", [])) != 1 or given["host"][0].lower() not in self.hosts:
            return False
        origins = given.get("origin", [])
        if any(origin.lower() not in self.origins for origin in origins):
            return False
        if scope["type"] == "websocket" and not origins:
            return False
        if not origins and given.get("sec-fetch-site", ["none"])[0] not in ("none", "same-origin"):
            return False
        first = scope["path"].split("/")[1:2]
        return bool(first) and hmac.compare_digest(first[0].encode(), self.token.encode())


async def _refuse(scope: Any, receive: Any, send: Any) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008})
        return
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"cache-control", b"no-store")]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": b"This address needs the token that the server printed.\n"})


LARGEST = 1 << 20
"""Bytes of a message from a page."""
AGAIN = 1.0
"""Seconds until files are followed again after an error."""
WORDS = 32
"""Bytes of the token."""


class Pages:
    """Open pages: each gets all messages."""

    def __init__(self) -> None:
        self._boxes: set[Mailbox] = set()

    def push(self, frame: bytes, replaces: bool = False) -> None:
        """Send every page a frame; with ``replaces`` it makes older such frames needless."""
        for box in self._boxes:
            box.add(frame, replaces)

    def open(self, greeting: Callable[[], list[bytes]]) -> Mailbox:
        """Return the messages of a new page; ``greeting`` brings it up to date."""
        box = Mailbox(greeting)
        self._boxes.add(box)
        return box

    def close(self, box: Mailbox) -> None:
        """Remove a page that has gone."""
        self._boxes.discard(box)

    def __len__(self) -> int:
        return len(self._boxes)


class Live:
    """Whole server: ``app`` is served by uvicorn."""

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
        routes = [Route("/{token}/", self._show, methods=["GET"]), WebSocketRoute("/{token}/socket", self._socket)]
        self.app = Gate(Starlette(routes=routes, lifespan=self._lifespan), self.token, port)

    @property
    def address(self) -> str:
        """Address that a browser opens."""
        return f"http://127.0.0.1:{self.port}/{self.token}/"

    @asynccontextmanager
    async def _lifespan(self, _: Starlette) -> AsyncIterator[None]:
        self.session = Session(self._name, self.nursery, self.pages.push, self._parts)
        self.nursery.say = self.session.board.line
        watching = asyncio.create_task(self._watch(self.session))
        try:
            yield
        finally:
            self._ended = True
            watching.cancel()
            with suppress(asyncio.CancelledError):
                await watching
            await self.session.end()
            await self.nursery.end()

    async def _watch(self, session: Session) -> None:
        """Begin when the warm process is ready, then follow the files; a page may open meanwhile.

        An error of ours is reported, and does not end it.
        """
        with suppress(Failed):  # the child says it
            await self.nursery.warm()
        session.reload()
        while not self._ended:
            try:
                async for files in session.watch.changes(lambda: self._ended):
                    session.changed(files)
            except Exception as error:
                traceback.print_exc()
                session.board.fail(f"the live page could not follow the files for a moment: {error}; save again")
                await asyncio.sleep(AGAIN)

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
        box = self.pages.open(session.greeting)
        for frame in session.greeting():
            box.add(frame)
        sending = asyncio.create_task(_send_all(socket, box))
        try:
            while True:
                message = await socket.receive()
                if message["type"] == "websocket.disconnect":
                    break
                self._carry_out(session, message.get("text") or message.get("bytes") or b"", box)
        except (WebSocketDisconnect, RuntimeError):
            pass
        finally:
            self.pages.close(box)
            sending.cancel()

    def _carry_out(self, session: Session, text: str | bytes, box: Mailbox) -> None:
        """Carry out a page's request; errors, also internal ones, are reported to that page."""
        try:
            session.ask(wish_of(text))
        except UserError as error:
            box.add(framed({"kind": "refused", "text": str(error)}))
        except Exception as error:
            traceback.print_exc()
            box.add(framed({"kind": "refused", "text": f"the live page has failed at this: {error}"}))


async def _send_all(socket: WebSocket, box: Mailbox) -> None:
    with suppress(WebSocketDisconnect, RuntimeError, OSError):
        while True:
            await socket.send_bytes(await box.get())
