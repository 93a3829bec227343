"""``python -m studio.live NAME``: serve a page that follows the editor, on this machine alone."""

from __future__ import annotations

import argparse
import asyncio
import socket
import webbrowser

from shared.stage.console import run_cli, say
from shared.stage.errors import UserError
from shared.stage.paths import imports_space, known_name, mechanism_file, owner_of

LIMIT = 30.0
"""Seconds that mechanism.py may take to be solved, if nothing else is said."""
GRACE = 2
"""Seconds that open pages get when the server ends."""


def main() -> int:
    """Serve until Ctrl-C or a signal ends it."""
    parser = argparse.ArgumentParser(prog="python -m studio.live", description="A page that follows the editor.")
    parser.add_argument("name", help="mechanism or variant; four-bar and four_bar are one")
    parser.add_argument("--port", type=int, default=0, help="of 127.0.0.1; any free one if not given")
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds that solving may take; 30 if not given")
    parser.add_argument("--no-parts", action="store_true", help="make no parts in the background")
    parser.add_argument("--open", action="store_true", help="open the page in the browser")
    arguments = parser.parse_args()
    name = known_name(arguments.name)
    file = mechanism_file(owner_of(name))
    if file.is_file() and imports_space(file):
        raise UserError(
            f"{name} is a mechanism in space, for which there are no sliders yet; `mbsd view {name}` shows it"
        )
    if not arguments.limit > 0:
        raise UserError(f"live: --limit {arguments.limit:g} is not a time; give seconds above 0")
    with bound(arguments.port) as listener:
        try:
            asyncio.run(_serve(name, listener, arguments))
        except KeyboardInterrupt:  # the usual way to end it
            say("live", f"{name}: ended")
    return 0


def bound(port: int) -> socket.socket:
    """Return a socket of loopback; raises UserError if the port is taken or invalid."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind(("127.0.0.1", port))
    except (OSError, OverflowError) as error:
        listener.close()
        raise UserError(
            f"live: port {port} of 127.0.0.1 cannot be used ({error}); leave --port out for a free one"
        ) from error
    return listener


async def _serve(name: str, listener: socket.socket, arguments: argparse.Namespace) -> None:
    import uvicorn

    from studio.live.page import page
    from studio.live.server import LARGEST, Live

    live = Live(name, listener.getsockname()[1], page, arguments.limit, not arguments.no_parts)
    say("live", f"{name}: {live.address} (Ctrl-C ends it)")
    if arguments.open:
        asyncio.get_running_loop().call_later(1.0, webbrowser.open, live.address)
    config = uvicorn.Config(
        live.app, log_level="warning", access_log=False, lifespan="on", ws_max_size=LARGEST, server_header=False,
        proxy_headers=False, timeout_graceful_shutdown=GRACE, ws_per_message_deflate=False,
    )  # fmt: skip
    await uvicorn.Server(config).serve(sockets=[listener])


if __name__ == "__main__":
    run_cli(main)
