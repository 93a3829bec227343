"""Work on a worker: it requests the inputs it lacks, does its orders one by one, and reports."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mbsd.dealing.report import Report, encoded, printable
from shared.cluster.contents import Contents
from shared.stage.errors import UserError

LONGEST_REASON = 2000
"""Characters of a reason."""


class Work(NamedTuple):
    """One kind of work: how a worker does it, and how its answer is read."""

    do: Callable[[Mapping[str, Path], str, Any], bytes]
    """Does one order: the files of all needed contents by name, the name of what all orders have in common, the order.
    """
    read: Callable[[str, bytes], Any]
    """The result of the order with this key from the bytes that came. Raises WrongAnswer if they are not one."""
    most: int
    """Bytes of the largest result that there can be."""


_contents: dict[int, Contents] = {}
_one_at_a_time: dict[str, threading.Lock] = {}
"""A lock a worker: one with several threads has one Blender still."""


def perform(
    do: Callable[[Mapping[str, Path], str, Any], bytes],
    common: str,
    needed: Sequence[str],
    orders: Sequence[tuple[str, Any]],
    sent: Mapping[str, bytes],
) -> bytes:
    """Do the orders (key, order) by ``do``; ``sent`` are contents that this worker requested.

    Returns a :class:`Report` as bytes.
    """
    from distributed import get_worker

    kept = _contents.setdefault(os.getpid(), Contents())
    done: list[tuple[str, bytes]] = []
    key = orders[0][0]
    with _one_at_a_time.setdefault(get_worker().address, threading.Lock()):
        started = time.perf_counter()
        try:
            kept.keep(sent, needed)
            lacking = kept.lacking(needed)
            if lacking:
                return encoded(Report(lacking=lacking))
            files = {name: kept.folder / name for name in needed}
            for key, order in orders:
                done.append((key, do(files, common, order)))
        except Exception as error:  # whatever it is, others may do better
            said = str(error) if isinstance(error, UserError) else f"{type(error).__name__}: {error}"
            failed = key, printable(said, LONGEST_REASON)
            return encoded(Report(done=done, failed=failed, seconds=time.perf_counter() - started))
    return encoded(Report(done=done, seconds=time.perf_counter() - started))
