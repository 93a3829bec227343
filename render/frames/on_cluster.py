"""Frames by the workers of a cluster: the same Blender process as here, inputs by content, pictures as bytes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from render.blender.job import Answer, Job
from render.blender.patience import START, Patience
from render.frames import served
from render.frames.store import FrameStore
from shared.cluster.address import connected
from shared.cluster.contents import content_hash
from shared.cluster.deal import Deal
from shared.cluster.preload import FRAMES
from shared.stage.console import say
from shared.stage.signals import terminable

if TYPE_CHECKING:
    from distributed import Client


@contextmanager
def workers(job: Job, store: FrameStore) -> Iterator[Iterator[Answer]]:
    """Deal the pictures of the job out; yields answers as they are in the store, as a Blender process here does.

    Raises UserError if no scheduler answers, no worker is fit, or a picture fails on several of them.
    """
    with terminable(), connected() as client:
        yield _answers(client, job, store)


def dealt(client: Client, job: Job) -> Deal:
    """The pictures of the job as orders for workers."""
    needed: dict[str, Callable[[], bytes]] = {piece.sha256: Path(piece.stl).read_bytes for piece in job.scene.pieces}
    pieces = [msgspec.structs.replace(piece, stl="") for piece in job.scene.pieces]
    scene = msgspec.structs.replace(job.scene, pieces=pieces)
    content = msgspec.json.encode(msgspec.structs.replace(job, scene=scene, pictures=[]))
    common = content_hash(content)
    needed[common] = lambda: content
    orders = {picture.key: (picture.state, picture.key, picture.name) for picture in job.pictures}
    return Deal(client, served.picture, common, needed, orders, FRAMES, Patience().scaled(START))


def _answers(client: Client, job: Job, store: FrameStore) -> Iterator[Answer]:
    work, name = dealt(client, job), job.scene.mechanism
    made: Counter[str] = Counter()
    for key, picture, worker in work.results():
        if not made[worker]:
            say("frames", f"{name}: worker {worker}: {picture.device}")
        if not made:
            yield Answer(device="cluster")
        store.put(picture.name, picture.content)
        made[worker] += 1
        yield Answer(path=str(store.folder / picture.name), key=key, cycles=picture.cycles)
    shares = ", ".join(f"{worker} {count}" for worker, count in sorted(made.items()))
    say("frames", f"{name}: made by {shares}" + (f"; {work.late} came late and were dropped" if work.late else ""))
