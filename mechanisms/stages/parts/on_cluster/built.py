"""Parts on a worker of a cluster: the same stage in a copy of the program with the author's files.

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
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

import msgspec

from mbsd.dependencies.imported import content_of, named_modules
from mechanisms.stages.loading.inputs import WORKSHOP, name_of, path_of
from mechanisms.stages.loading.loading import package_of
from mechanisms.stages.parts.on_cluster.answer import WorkerParts
from shared.cluster.deal import content_hash
from shared.cluster.preload import PARTS, sources_of
from shared.stage import paths, signals
from shared.stage.errors import UserError
from shared.stage.files import is_abandoned, try_lock, write_bytes
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

    They are :class:`WorkerParts` as MessagePack. Raises UserError where this worker, rather than the mechanism, is at
    fault: its sources have changed since it was started, its disk is full, or the system ended the stage.
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
            try_lock(lock.fileno())
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


def _stage(tree: Path, order: Order) -> WorkerParts:
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
        return WorkerParts(refusal=said)
    scaled = scale_of(order.scale)
    folder = results / name / (scaled.slug if scaled else "")
    stamp = msgspec.json.decode((folder / ".stamps" / "parts.json").read_bytes())
    solids = {Path(output).name: (folder / output).read_bytes() for output in stamp["outputs"]}
    document = solids.pop("parts.json")
    return WorkerParts(document, solids, stamp["notes"])


def _remove_leftovers(place: Path) -> None:
    """Remove what a worker that was killed has left."""
    for left in place.glob("made-*"):
        with suppress(OSError):
            lock = left / LOCK
            old = time.time() - left.stat().st_mtime > BEGUN
            if is_abandoned(lock) if lock.exists() else old:
                shutil.rmtree(left, ignore_errors=True)


# Files of authors, as contents by their hash, and as files again on a worker.
#
# Of ``mechanisms/`` every file of the mechanism whose parts are made travels, because parts.py may read any of them; of
# the others the Python files, which it may import. Of a user's own folder, which may hold anything, the files of the
# mechanism travel, what they import of the folder, and what was read when the parts were made before. The program
# itself does not travel: a worker has the same.

PROGRAM = ("stages",)
"""Folders of ``mechanisms/`` that are the program's."""


class Order(msgspec.Struct, frozen=True, kw_only=True):
    """An order for the parts of one mechanism, as a worker receives it."""

    name: str
    files: dict[str, str]
    """Hashes of the content of the authors' files, by name as inputs have it."""
    program: dict[str, str]
    """Versions and sources of who asks, as ``identity`` gives them."""
    folder: str = ""
    """Name of the user's own folder in which the mechanism is."""
    scale: str = ""
    """Scale of a model, such as 1:20; empty for the machine itself."""
    machine: str = ""
    """Hash of the parts.json of the machine itself, where the motion of its model follows from it."""


def collected(name: str, read: Iterable[str] = ()) -> dict[str, bytes]:
    """Return the authors' files, by the name that inputs have, for the mechanism or variant ``name``.

    The names are those that inputs have. ``read`` are names of files of a user's own folder that the parts were made
    from before. One that cannot be read, or goes meanwhile, stays here; that it is missing is reported from here.
    """
    contents: dict[str, bytes] = {}
    owner = paths.owner_of(name)
    for path in sorted(set(_own_paths(owner, read) if paths.in_workshop() else _paths(owner))):
        with suppress(OSError):
            contents[name_of(path)] = path.read_bytes()
    return contents


def by_content(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the same contents by their hash."""
    return {content_hash(content): content for content in files.values()}


def _paths(owner: str) -> Iterator[Path]:
    ours = {paths.ROOT / room for room in PARTS}
    for folder in paths.MECHANISMS.iterdir():
        if not folder.is_dir():
            if folder.suffix == ".py" and folder not in ours:
                yield folder
        elif folder.name not in (*PROGRAM, "__pycache__"):
            pattern = "*" if folder.name == owner else "*.py"
            yield from (path for path in folder.rglob(pattern) if path.is_file() and "__pycache__" not in path.parts)


def _own_paths(owner: str, read: Iterable[str]) -> Iterator[Path]:
    """Yield files of a user's own folder."""
    folder = paths.mechanism_folder(owner)
    if folder != paths.MECHANISMS:
        yield from (path for path in folder.rglob("*") if path.is_file() and not _is_hidden(path.relative_to(folder)))
    files = {paths.mechanism_file(owner, file) for file in ("mechanism", "parts", "shot")}
    yield from _imported([(file, package_of(owner)) for file in files if file.is_file()])
    yield from (path_of(name) for name in read if name.startswith(WORKSHOP) and path_of(name).is_file())


def _is_hidden(path: Path) -> bool:
    """Return True if it is of a tool rather than of the author."""
    return any(part == "__pycache__" or part.startswith(".") for part in path.parts)


def _imported(waiting: list[tuple[Path, str]]) -> Iterator[Path]:
    """Yield these files, each with its package, and those of the user's folder that they import."""
    seen: set[Path] = set()
    while waiting:
        file, package = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        yield file
        for module in named_modules(content_of(file), package):
            place = _place(module)
            both = (place.with_name(f"{place.name}.py"), module.rpartition(".")[0]), (place / "__init__.py", module)
            waiting += [(path, inside) for path, inside in both if path.is_file()]


def _place(module: str) -> Path:
    """Return where a module of the user's folder would be, without its suffix."""
    top, *rest = module.split(".")
    if top != "mechanisms" or not rest:
        return paths.MECHANISMS.joinpath(top, *rest)
    owner, *below = rest
    try:
        folder = paths.mechanism_folder(owner)
        return folder / owner if below == ["mechanism"] and paths.is_single_file(owner) else folder.joinpath(*below)
    except UserError:
        return paths.MECHANISMS.joinpath(*rest)
