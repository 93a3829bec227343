"""Frames drawn by the workers of a cluster."""

from __future__ import annotations

import atexit
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from mbsd.dealing.report import WrongAnswer, printable
from render.blender.child import KeptBlender
from render.blender.job import Answer, Job
from render.blender.picture_file import fault_of, most_bytes, name_of
from render.blender.process import START, Patience
from render.frames.store import FrameStore
from shared.cluster.address import connected
from shared.cluster.deal import Deal, Work, content_hash
from shared.cluster.preload import FRAMES
from shared.stage.console import say
from shared.stage.signals import terminable

if TYPE_CHECKING:
    from distributed import Client


# Frames on a worker of a cluster: one Blender, kept from frame to frame of a film; pictures as bytes.

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
        """Return the process that has this film's scene."""
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
        """Stop if nothing was asked for a while; called a while after each picture."""
        if self.busy.acquire(blocking=False):
            try:
                if time.monotonic() - self.used >= IDLE:
                    self.stop()
            finally:
                self.busy.release()


_workers: dict[str, _Kept] = {}
"""By address: several workers may be one process."""


def picture(files: Mapping[str, Path], common: str, order: tuple[int, str, str, int]) -> bytes:
    """Return one frame: number of its state, key, what messages call it, index of its plate; :class:`Made` as
    MessagePack.

    Raises UserError if Blender cannot make it.
    """
    from distributed import get_worker

    kept = _workers.setdefault(get_worker().address, _Kept())
    with kept.busy:
        state, key, name, plate = order
        blender = kept.for_film(files, common)
        answer = blender.make(state, key, name, plate)
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


# Frames by the workers of a cluster: the same Blender process as here, inputs by content, pictures as bytes.

AROUND = 10_000
"""Bytes of an answer beside its picture."""
SLOWEST = 1e7
"""Seconds that a picture may take."""


@contextmanager
def workers(job: Job, store: FrameStore) -> Iterator[Iterator[Answer]]:
    """Deal the pictures of the job out; yields answers as they are in the store, as a Blender process here does.

    Raises UserError if no scheduler answers, no worker is fit, or a picture fails on several of them.
    """
    with terminable(), connected() as client:
        yield _answers(client, job, store)


def dealt(client: Client, job: Job) -> Deal:
    """Return the pictures of the job as orders for workers."""
    needed: dict[str, Callable[[], bytes]] = {piece.sha256: Path(piece.stl).read_bytes for piece in job.scene.pieces}
    pieces = [msgspec.structs.replace(piece, stl="") for piece in job.scene.pieces]
    scene = msgspec.structs.replace(job.scene, pieces=pieces)
    content = msgspec.json.encode(msgspec.structs.replace(job, scene=scene, pictures=[], plates_folder=""))
    common = content_hash(content)
    needed[common] = lambda: content
    orders = {picture.key: (picture.state, picture.key, picture.name, picture.plate) for picture in job.pictures}
    work = Work(picture, reader(job), most_bytes(job.width, job.height) + AROUND)
    return Deal(client, work, common, needed, orders, FRAMES, Patience().scaled(START))


def reader(job: Job) -> Callable[[str, bytes], Made]:
    """Reads what a worker sends of a picture of this job: it has the name that its key and its bytes give, is a whole
    picture of the size that was ordered, and its text can be printed. Raises WrongAnswer for anything else.
    """
    names = {picture.key: picture.name for picture in job.pictures}

    def read(key: str, content: bytes) -> Made:
        try:
            made = msgspec.msgpack.decode(content, type=Made)
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
            raise WrongAnswer(f"{names[key]} cannot be read ({printable(str(error))})") from error
        if made.name != name_of(key, made.content):
            raise WrongAnswer(f"{names[key]} is called '{printable(made.name, 80)}', which is not its name")
        wrong = fault_of(made.content, job.width, job.height)
        if wrong:
            raise WrongAnswer(f"{names[key]} {wrong}")
        if not 0.0 <= made.cycles <= SLOWEST:
            raise WrongAnswer(f"{names[key]} took {made.cycles} s")
        return msgspec.structs.replace(made, device=printable(made.device, 80))

    return read


def _answers(client: Client, job: Job, store: FrameStore) -> Iterator[Answer]:
    work, name = dealt(client, job), job.scene.mechanism
    made: Counter[str] = Counter()
    for key, picture, worker in work.results():
        if not made[worker]:
            say("frames", f"{name}: worker {worker}: {picture.device}")
        if not made:
            yield Answer(device="cluster")
        store.keep(picture.name, picture.content)
        made[worker] += 1
        yield Answer(path=str(store.folder / picture.name), key=key, cycles=picture.cycles)
    shares = ", ".join(f"{worker} {count}" for worker, count in sorted(made.items()))
    say("frames", f"{name}: made by {shares}" + (f"; {work.late} came late and were dropped" if work.late else ""))
