"""What runs on a worker: it asks for the inputs it lacks, does its orders one by one, and reports."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from shared.cluster.contents import Contents
from shared.stage.errors import UserError

Work = Callable[[Mapping[str, Path], str, Any], bytes]
"""Does one order: the files of all needed contents by name, the name of what all orders have in common, the order."""


class Report(NamedTuple):
    """What a worker made of a group of orders."""

    lacking: list[str] = []
    """Contents that it needs first; then nothing was done."""
    done: list[tuple[str, Any]] = []
    """Key and result of each order that went well."""
    failed: tuple[str, str] | None = None
    """Key and reason of the one that did not, after which the group was given back."""
    seconds: float = 0.0


_contents: dict[int, Contents] = {}
_one_at_a_time: dict[str, threading.Lock] = {}
"""A lock a worker: one with several threads has one Blender still."""


def perform(
    work: Callable[..., Any],
    common: str,
    needed: Sequence[str],
    orders: Sequence[tuple[str, Any]],
    sent: Mapping[str, bytes],
) -> Report:
    """Do the orders (key, what to do) with ``work``; ``sent`` are contents that this worker asked for."""
    from distributed import get_worker

    kept = _contents.setdefault(os.getpid(), Contents())
    done: list[tuple[str, Any]] = []
    key = orders[0][0]
    with _one_at_a_time.setdefault(get_worker().address, threading.Lock()):
        started = time.perf_counter()
        try:
            kept.put(sent, needed)
            lacking = kept.lacking(needed)
            if lacking:
                return Report(lacking=lacking)
            files = {name: kept.folder / name for name in needed}
            for key, order in orders:
                done.append((key, work(files, common, order)))
        except Exception as error:  # whatever it is, others may do better
            said = str(error) if isinstance(error, UserError) else f"{type(error).__name__}: {error}"
            return Report(done=done, failed=(key, said), seconds=time.perf_counter() - started)
    return Report(done=done, seconds=time.perf_counter() - started)
