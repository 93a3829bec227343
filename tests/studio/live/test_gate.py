"""Access to the server: the token, this machine's name, and pages of the server itself."""

from __future__ import annotations

import asyncio

import httpx
import pytest
from websockets.exceptions import InvalidStatus

from studio.live.server import Gate
from tests.studio.live.served import Served, live_server

TOKEN, PORT = "secret-word", 8123


def let_in(kind: str, path: str, *headers: tuple[str, str]) -> bool:
    gate = Gate(None, TOKEN, PORT)
    return gate.allows(
        {"type": kind, "path": path, "headers": [(name.encode(), value.encode()) for name, value in headers]}
    )


HOST, ORIGIN = ("host", f"127.0.0.1:{PORT}"), ("origin", f"http://127.0.0.1:{PORT}")


@pytest.mark.parametrize("host", [f"127.0.0.1:{PORT}", f"localhost:{PORT}", f"LOCALHOST:{PORT}", f"[::1]:{PORT}"])
def test_the_own_page_may_come_in(host: str) -> None:
    assert let_in("http", f"/{TOKEN}/", ("host", host))
    assert let_in("http", f"/{TOKEN}/", ("host", host), ("sec-fetch-site", "none"))
    assert let_in("websocket", f"/{TOKEN}/socket", ("host", host), ("origin", f"http://{host}"))


@pytest.mark.parametrize(
    "headers",
    [
        [],
        [("host", "127.0.0.1")],
        [("host", f"evil.example:{PORT}")],  # a name that was pointed at 127.0.0.1
        [("host", f"127.0.0.1:{PORT}.evil.example")],
        [("host", f"127.0.0.1:{PORT + 1}")],
        [HOST, HOST],
        [HOST, ("origin", "http://evil.example")],
        [HOST, ("origin", "null")],
        [HOST, ("origin", f"https://127.0.0.1:{PORT}")],
        [HOST, ("origin", f"http://127.0.0.1:{PORT + 1}")],
        [HOST, ORIGIN, ("origin", "http://evil.example")],
        [HOST, ("sec-fetch-site", "cross-site")],
        [HOST, ("sec-fetch-site", "same-site")],
    ],
)
def test_others_may_not(headers: list[tuple[str, str]]) -> None:
    assert not let_in("http", f"/{TOKEN}/", *headers)
    assert not let_in("websocket", f"/{TOKEN}/socket", *headers)


@pytest.mark.parametrize(
    "path", ["/", "", f"/{TOKEN[:-1]}/", f"/{TOKEN}x/", f"//{TOKEN}/", "/schlüssel/", f"/x/{TOKEN}/"]
)
def test_without_the_token_nothing_is_there(path: str) -> None:
    assert not let_in("http", path, HOST)
    assert not let_in("websocket", path, HOST, ORIGIN)


def test_a_websocket_names_its_origin() -> None:
    assert not let_in("websocket", f"/{TOKEN}/socket", HOST)


def test_other_scopes_pass() -> None:
    called = []

    async def app(scope: dict, receive: object, send: object) -> None:
        called.append(scope["type"])

    asyncio.run(Gate(app, TOKEN, PORT)({"type": "lifespan"}, None, None))
    assert called == ["lifespan"]


live = live_server("guarded")


def test_a_second_origin_is_refused_by_the_server_itself(live: Served) -> None:
    address = live.live.address
    with httpx.Client() as client:
        page = client.get(address)
        assert page.status_code == 200
        assert page.headers["cross-origin-resource-policy"] == "same-origin"
        assert page.headers["referrer-policy"] == "no-referrer"
        assert "server" not in page.headers or "uvicorn" not in page.headers["server"]
        for headers in ({"origin": "http://evil.example"}, {"host": "evil.example"}, {"sec-fetch-site": "cross-site"}):
            refused = client.get(address, headers=headers)
            assert refused.status_code == 403
            assert live.live.token not in refused.text
        assert client.get(f"http://127.0.0.1:{live.live.port}/").status_code == 403
        assert client.post(address).status_code == 405
    with live.page() as page:
        page.hear("state")
    with pytest.raises(InvalidStatus), live.page(origin="http://evil.example"):
        pass
    assert not len(live.live.pages)


def test_the_token_is_long_and_new_each_time(live: Served) -> None:
    assert len(live.live.token) >= 40
