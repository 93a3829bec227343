"""Children end without harm to each other: a descriptor is closed once, by the one who reads it."""

from __future__ import annotations

import asyncio
import os
import threading
from multiprocessing import get_context
from multiprocessing.connection import Connection

import pytest

from studio.live import children
from studio.live.child import entry
from studio.live.frames import framed

CONTEXT = get_context("fork")


def says(pipe: Connection, name: str, server: int, most_bytes: int) -> None:
    """Answer each request; ``name`` says how it ends."""
    while True:
        pipe.recv_bytes()
        if name == "dies":
            os._exit(3)
        if name == "closes":
            pipe.close()
            threading.Event().wait()
        if name == "leaves another" and os.fork() == 0:
            threading.Event().wait(0.5)
            os._exit(0)
        pipe.send_bytes(framed({"kind": "motion", "id": 1}))


def opened() -> int:
    return len(os.listdir("/proc/self/fd"))


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="counts descriptors in /proc")
def test_every_descriptor_is_closed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(entry, "main", says)
    heard: list[tuple[str, str]] = []

    async def run() -> None:
        def hear(child: children.Child, header: dict, _: bytes) -> None:
            heard.append((header["kind"], header.get("text", "")))
            if header["kind"] == "error":
                child.kill()  # as a session does

        for name, wanted in (
            ("dies", "exit code 3"),
            ("closes", "its pipe was closed"),
            ("leaves another", ""),
            ("answers", ""),
        ):
            for _ in range(4):
                heard.clear()
                child = children.Child(CONTEXT, name, hear, 0.0, 1 << 30)
                other = os.dup(0)  # takes the next descriptor, and whoever closes one too many closes this
                child.ask(1, {"do": "open"})
                while not heard:
                    await asyncio.sleep(0.002)
                assert wanted in heard[0][1], heard
                child.kill()
                child.kill()
                while child._pipe.closed is False:
                    await asyncio.sleep(0.002)
                os.close(other)
                assert len(heard) == 1, heard

    threads = threading.active_count()
    before = opened()
    asyncio.run(run())
    assert opened() <= before + 1
    assert threading.active_count() <= threads + 1
