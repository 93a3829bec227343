"""Access to the server: only pages of its own address that know its token may speak to it.

The server listens on loopback alone, but every page that a browser shows can send requests there. So a request needs
the token in its path, a Host that is this machine's (a foreign name that was pointed at 127.0.0.1 is refused), and
where the browser says which page sent it (Origin, Sec-Fetch-Site), that must be one of this server. So it is
for HTTP and websockets alike.
"""

from __future__ import annotations

import hmac
from typing import Any

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
