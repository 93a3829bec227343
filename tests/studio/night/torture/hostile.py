"""Preloaded by a worker: it answers each order with rubbish, of the kind that the variable HOSTILE says."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from typing import Any

import msgspec

from mbsd.dealing.report import Report, encoded
from render.blender.picture_file import name_of
from render.frames.cluster import Made
from shared.cluster import deal
from tests.studio.night.torture.stage import STAMP

VARIABLE = "HOSTILE"


def _picture(width: int, height: int) -> bytes:
    from PIL import Image

    content = io.BytesIO()
    Image.effect_noise((width, height), 60.0).convert("RGB").save(content, "PNG")
    return content.getvalue()


def _sent(keys: Sequence[str], content: bytes, name: str = "") -> bytes:
    def piece(key: str) -> bytes:
        return msgspec.msgpack.encode(Made(name or name_of(key, content), content, 0.1, "CPU"))

    return encoded(Report(done=[(key, piece(key)) for key in keys], seconds=0.1))


KINDS: dict[str, Callable[[Sequence[str]], Any]] = {
    "None": lambda keys: None,
    "a dictionary": lambda keys: dict.fromkeys(keys, "done"),
    "no report": lambda keys: os.urandom(1000),
    "nothing": lambda keys: encoded(Report()),
    "another order": lambda keys: encoded(Report(done=[("../../other", b"")])),
    "endless data": lambda keys: bytes(300_000_000),
    "text for a picture": lambda keys: _sent(keys, b"this is no picture"),
    "a cut picture": lambda keys: _sent(keys, _picture(STAMP.width, STAMP.height)[:-40]),
    "a picture of 8x8": lambda keys: _sent(keys, _picture(8, 8)),
    "a name outside the folder": lambda keys: _sent(keys, _picture(STAMP.width, STAMP.height), "../../../x.png"),
}
"""Answers to orders with these keys."""


def dask_setup(_: object) -> None:
    """Called by Dask with the worker: from now on it lies."""
    kind = KINDS[os.environ[VARIABLE]]

    def perform(do: Any, common: str, needed: Any, orders: Sequence[tuple[str, Any]], sent: Any) -> Any:
        return kind([key for key, _ in orders])

    deal.perform = perform
