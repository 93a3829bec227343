"""What a worker of a cluster does for frames: one Blender, kept from frame to frame of a film; pictures as bytes."""

from __future__ import annotations

import atexit
import threading
import time
from collections.abc import Mapping
from pathlib import Path

import msgspec

from render.blender.job import Job
from render.blender.kept import KeptBlender

IDLE = 60.0
"""Seconds without an order after which Blender is ended."""


class Made(msgspec.Struct, forbid_unknown_fields=True):
    """A picture: the name of its file, its bytes, Blender's own seconds, the device."""

    name: str
    content: bytes
    cycles: float
    device: str


class _Kept:
    """The Blender of one worker."""

    def __init__(self) -> None:
        self.busy = threading.Lock()
        self.common = ""
        self.blender: KeptBlender | None = None
        self.used = 0.0

    def for_film(self, files: Mapping[str, Path], common: str) -> KeptBlender:
        """The process that has this film's scene."""
        if self.blender is None or self.common != common:
            self.stop()
            job = msgspec.json.decode(files[common].read_bytes(), type=Job)
            pieces = [msgspec.structs.replace(piece, stl=str(files[piece.sha256])) for piece in job.scene.pieces]
            scene = msgspec.structs.replace(job.scene, pieces=pieces)
            self.common, self.blender = common, KeptBlender(msgspec.structs.replace(job, scene=scene))
        return self.blender

    def stop(self) -> None:
        if self.blender is not None:
            self.blender.stop()
            self.blender = None

    def stop_if_idle(self) -> None:
        """Called a while after each picture."""
        if self.busy.acquire(blocking=False):
            try:
                if time.monotonic() - self.used >= IDLE:
                    self.stop()
            finally:
                self.busy.release()


_workers: dict[str, _Kept] = {}
"""By address: several workers may be one process."""


def picture(files: Mapping[str, Path], common: str, order: tuple[int, str, str]) -> bytes:
    """One frame: number of its state, key, and what messages call it; :class:`Made` as MessagePack.

    Raises UserError if Blender cannot make it.
    """
    from distributed import get_worker

    kept = _workers.setdefault(get_worker().address, _Kept())
    with kept.busy:
        state, key, name = order
        blender = kept.for_film(files, common)
        answer = blender.make(state, key, name)
        path = Path(answer.path)
        made = Made(path.name, path.read_bytes(), answer.cycles, blender.device)
        kept.used = time.monotonic()
    timer = threading.Timer(IDLE + 1.0, kept.stop_if_idle)
    timer.daemon = True
    timer.start()
    return msgspec.msgpack.encode(made)


@atexit.register
def stop_all() -> None:
    """End the processes of all workers of this process."""
    for kept in _workers.values():
        kept.stop()
