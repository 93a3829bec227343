"""Deal of a stage: orders go to workers, which request missing files by content and report back."""

from __future__ import annotations

import hashlib
import os
import threading
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from mbsd.dealing import deal
from mbsd.dealing.identity import Trust, asker
from mbsd.dealing.manner import Kind, Manner
from mbsd.dealing.pools import Dask
from mbsd.dealing.report import Report, encoded, printable
from shared.cluster.address import stage_voice
from shared.cluster.preload import PACKAGES, identity
from shared.stage.errors import UserError
from shared.stage.files import file_hash, write_bytes
from shared.stage.paths import out_root

if TYPE_CHECKING:
    from distributed import Client


# Inputs on a worker: files named by the SHA-256 of their bytes.
#
# So none is sent twice and none is stale.


LIMIT = 2_000_000_000
"""Bytes that a worker keeps."""
VARIABLE = "CLUSTER_CACHE_MB"
"""Environment variable of a worker with another limit, in 1e6 bytes."""


def content_hash(content: bytes) -> str:
    """Return the name of these bytes."""
    return hashlib.sha256(content).hexdigest()


class Contents:
    """Folder of contents on a machine; several workers may share it."""

    def __init__(self, folder: Path | None = None, limit: int | None = None) -> None:
        self.folder = folder or out_root() / ".cluster" / "contents"
        given = os.environ.get(VARIABLE, "")
        self.limit = limit if limit is not None else int(float(given) * 1e6) if given else LIMIT
        self._whole: dict[str, tuple[int, int]] = {}

    def find(self, name: str) -> Path | None:
        """Return the file with this content; a damaged one is removed.

        It is checked once in a process and again when it changes.
        """
        path = self.folder / name
        try:
            stat = path.stat()
            seen = stat.st_size, stat.st_ino
            if self._whole.get(name) != seen:
                if file_hash(path) != name:
                    path.unlink(missing_ok=True)
                    return None
                self._whole[name] = seen
            os.utime(path)
        except OSError:
            return None
        return path

    def lacking(self, names: Collection[str]) -> list[str]:
        """Return the contents that are missing here."""
        return [name for name in names if self.find(name) is None]

    def keep(self, contents: Mapping[str, bytes], needed: Collection[str] = ()) -> None:
        """Keep these contents; the longest unused others are removed if there is too much.

        Raises UserError if the disk has no room.
        """
        if not contents:
            return
        self._make_room(sum(map(len, contents.values())), {*needed, *contents})
        for name, content in contents.items():
            if content_hash(content) == name:
                write_bytes(self.folder / name, content)

    def _make_room(self, size: int, needed: Collection[str]) -> None:
        files = []
        for path in self.folder.glob("[0-9a-f]*"):
            with suppress(OSError):
                stat = path.stat()
                files.append((stat.st_mtime, stat.st_size, path))
        much = size + sum(entry[1] for entry in files)
        for _, bytes_, path in sorted(files):
            if much <= self.limit:
                return
            if path.name not in needed:
                path.unlink(missing_ok=True)
                much -= bytes_


# Work on a worker: it requests the inputs it lacks, does its orders one by one, and reports.


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


# Orders of a stage for the workers of a cluster: the files that they need are sent by content.


class Deal(deal.Deal):
    """One kind of work for all workers of a cluster.

    ``work`` says what a worker does and what its answer has to be, ``common`` is the name of the content that all
    orders share, ``needed`` all contents by name as functions that give their bytes, ``orders`` what is to be done by
    key. Workers whose sources of ``rooms`` differ are refused by name. ``patience`` (s) is a silence that is never too
    long; for ``grace`` (s) no worker whose pace is unknown is helped by others that have nothing to do.
    """

    def __init__(
        self,
        client: Client,
        work: Work,
        common: str,
        needed: Mapping[str, Callable[[], bytes]],
        orders: Mapping[str, Any],
        rooms: Sequence[str],
        patience: float = 300.0,
        packages: Sequence[str] = PACKAGES,
        grace: float = 0.0,
    ) -> None:
        which = tuple(rooms), tuple(packages)
        given = work.do, common, list(needed)
        super().__init__(
            Dask(client),
            Kind(perform, given, work.read, work.most, needed=needed, salt=common),
            orders,
            stage_voice(),
            Manner(patience=patience, grace=grace),
            Trust(identity(*which), asker("shared.cluster.preload", "identity", *which)),
        )
