"""Answers that a worker gives in place of the ones that were ordered."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from mbsd.dealing.report import Report, encoded
from shared.cluster.deal import perform


def _report(keys: Sequence[str], content: Any = b"x") -> bytes:
    return encoded(Report(done=[(key, content) for key in keys], seconds=0.001))


def _header(done: list[Any]) -> dict[str, Any]:
    return {"lacking": [], "done": done, "failed": None, "note": 0, "seconds": 0.1}


def _with_header(header: Any) -> bytes:
    text = json.dumps(header).encode()
    return len(text).to_bytes(4, "big") + text


LIES = {
    "None": lambda keys: None,
    "a dictionary": lambda keys: dict.fromkeys(keys, b"x"),
    "text": lambda keys: "all done",
    "no bytes": lambda keys: b"",
    "a report cut short": lambda keys: _report(keys)[:-1],
    "a report with a tail": lambda keys: _report(keys) + b"x",
    "nested without end": lambda keys: (90_000).to_bytes(4, "big") + b"[" * 90_000,
    "another kind of report": lambda keys: _with_header({"code": "x"}),
    "no text": lambda keys: (2).to_bytes(4, "big") + b"\xff\xfe",
    "results of no length": lambda keys: _with_header(_header([[key, None] for key in keys])),
    "results of a negative length": lambda keys: _with_header(_header([[key, -1] for key in keys])),
    "results that are not there": lambda keys: _with_header(_header([[key, 8] for key in keys])),
    "a header of MessagePack": lambda keys: msgspec.msgpack.encode({"done": keys}),
    "another order": lambda keys: _report(["another"]),
    "an order of a folder above": lambda keys: _report(["../../x"]),
    "an order twice": lambda keys: _report([*keys, *keys]),
    "nothing": lambda keys: _report([]),
    "a failure of another order": lambda keys: encoded(Report(failed=("another", "no"))),
    "a wish for other files": lambda keys: encoded(Report(lacking=["/etc/passwd"])),
    "a time that is none": lambda keys: encoded(Report(done=[(key, b"x") for key in keys], seconds=math.nan)),
    "time that ran backwards": lambda keys: encoded(Report(done=[(key, b"x") for key in keys], seconds=-1.0)),
    "a large result": lambda keys: _report(keys, bytes(20_000)),
    "endless data": lambda keys: bytes(3_000_000),
    "a result that the reader refuses": lambda keys: _report(keys, b"rubbish"),
}
"""By name, what a worker answers for these orders."""


def lie(
    kind: str,
    liar: str,
    do: Any,
    common: str,
    needed: Sequence[str],
    orders: Sequence[tuple[str, Any]],
    sent: Mapping[str, bytes],
) -> Any:
    """The answer of this kind on the worker ``liar``, the right one on others; in place of ``perform``."""
    from distributed import get_worker

    if get_worker().address != liar:
        return perform(do, common, needed, orders, sent)
    return LIES[kind]([key for key, _ in orders])


def small(files: Mapping[str, Path], common: str, order: Any) -> bytes:
    """Do an order that takes little time."""
    time.sleep(0.03)
    return b"done"
