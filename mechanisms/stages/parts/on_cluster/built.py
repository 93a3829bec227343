"""Parts on a worker of a cluster: the same stage in a copy of the program with the author's files in it.

The stage is a process of its own, so neither the author's code nor the CAD kernel can hurt the worker, and nothing of
one mechanism is left for the next.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

import msgspec

from mechanisms.stages.loading.inputs import WORKSHOP
from mechanisms.stages.parts.on_cluster.answer import Made
from mechanisms.stages.parts.on_cluster.author_files import Order
from shared.cluster.preload import PARTS, sources_of
from shared.stage import files, paths, signals
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT, SOLVER, out_root
from shared.stage.scale import scale_of

LONGEST = 3600.0
"""Seconds that the parts of a mechanism may take."""
LOCK = "lock"
RESULTS = "out"
"""Folder of results, beside the rooms."""
BEGUN = 60.0
"""Seconds after which a folder has its lock."""
LEAST = 50e6
"""Bytes that the disk has free after a stage whose error is the author's, and not the disk's."""


def parts(files: Mapping[str, Path], common: str, name: str) -> bytes:
    """Return the parts of the mechanism ``name`` from the contents ``files``, of which ``common`` is the
    :class:`Order`.

    They are :class:`Made` as MessagePack. Raises UserError where this worker, rather than the mechanism, is at fault:
    its sources have changed since it was started, its disk is full, or the system ended the stage.
    """
    order = msgspec.json.decode(files[common].read_bytes(), type=Order)
    place = out_root() / ".cluster" / "parts"
    place.mkdir(parents=True, exist_ok=True)
    _remove_leftovers(place)
    with _scratch(place) as tree:
        copy_program(tree)
        if any(order.program.get(f"sources of {room}") != sources_of(room, tree) for room in PARTS):
            raise UserError("its sources have changed since it was started; start it again")
        for path, content in order.files.items():
            _write_file(tree, path, files[content].read_bytes(), own_folder(tree, order.folder))
        if order.machine:
            write_bytes(tree / RESULTS / name / "parts" / "parts.json", files[order.machine].read_bytes())
        return msgspec.msgpack.encode(_stage(tree, order))


@contextmanager
def _scratch(place: Path) -> Iterator[Path]:
    """A folder of this worker's, with a lock beside it that tells others that it is at work."""
    with tempfile.TemporaryDirectory(prefix="made-", dir=place, ignore_cleanup_errors=True) as folder:
        new = Path(folder) / "new"
        with new.open("wb") as lock:
            files.try_lock(lock.fileno())
            new.rename(Path(folder) / LOCK)
            yield Path(folder) / "tree"


def copy_program(tree: Path) -> None:
    """The rooms that make parts, with their bytecode; of compiled kernels the worker's own are used."""
    for room in PARTS:
        source, target = SOLVER if room == "mbsd" else ROOT / room, tree / room
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("kernels", "rooms"))
        else:
            shutil.copy2(source, target)


def own_folder(tree: Path, called: str) -> Path | None:
    """Return the copy of a user's own folder, beside the program; None where the mechanism is not in one."""
    return tree.parent / "own" / Path(called).name if called else None


def _write_file(tree: Path, path: str, content: bytes, own: Path | None = None) -> None:
    """Write one of the author's files. Raises UserError for one that is not the author's."""
    place = tree / "mechanisms" if own is None else own
    target = Path(os.path.abspath(tree / path if own is None else own / path.removeprefix(WORKSHOP)))
    ours = any(target.is_relative_to(tree / room) for room in PARTS)
    if not target.is_relative_to(place) or target == place or ours:
        raise UserError(f"{path} is no file of an author's; it is not written")
    write_bytes(target, content)


def _stage(tree: Path, order: Order) -> Made:
    name, results = order.name, tree / RESULTS
    changed = {
        "PYTHONPATH": str(tree),
        "MBSD_OUT": str(results),
        "NUMBA_CACHE_DIR": os.environ.get("NUMBA_CACHE_DIR") or str(SOLVER / "__pycache__"),
        "CLUSTER": "",
        paths.WORKSHOP: str(own_folder(tree, order.folder) or ""),
        signals.VARIABLE: str(os.getpid()),
    }
    scale = ["--scale", order.scale] if order.scale else []
    command = [sys.executable, "-m", "mechanisms", "parts", name, *scale]
    try:
        ran = subprocess.run(
            command, cwd=tree, env=os.environ | changed, capture_output=True, text=True, timeout=LONGEST, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise UserError(f"{name}: its parts were not there after {LONGEST:.0f} s") from error
    if ran.returncode:
        lines = ran.stderr.strip().splitlines() or [f"exit code {ran.returncode}"]
        said = lines[-1].removeprefix("error: ")
        if ran.returncode != 1 or shutil.disk_usage(tree).free < LEAST or "memory ran out" in said:
            raise UserError(f"{name}: its parts could not be made here: {said} (exit code {ran.returncode})")
        return Made(refusal=said)
    scaled = scale_of(order.scale)
    folder = results / name / (scaled.slug if scaled else "")
    stamp = msgspec.json.decode((folder / ".stamps" / "parts.json").read_bytes())
    solids = {Path(output).name: (folder / output).read_bytes() for output in stamp["outputs"]}
    document = solids.pop("parts.json")
    return Made(document, solids, stamp["notes"])


def _remove_leftovers(place: Path) -> None:
    """Remove what a worker that was killed has left."""
    for left in place.glob("made-*"):
        with suppress(OSError):
            lock = left / LOCK
            old = time.time() - left.stat().st_mtime > BEGUN
            if files.is_abandoned(lock) if lock.exists() else old:
                shutil.rmtree(left, ignore_errors=True)
