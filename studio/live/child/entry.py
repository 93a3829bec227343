"""Where a child begins: it loads nothing by itself, for the warm process has, and the server need not."""

from __future__ import annotations

from multiprocessing.connection import Connection


def main(pipe: Connection, name: str, server: int, most_bytes: int) -> None:
    """See studio/live/child/main.py."""
    from studio.live.child.main import main as serve

    serve(pipe, name, server, most_bytes)


def nothing() -> None:
    """The first child: when it has ended, the warm process is ready."""
