"""The memory of the stage: Params that parts.py used, files that it read, and pieces kept."""

from __future__ import annotations

import ast
import dataclasses
import enum
import hashlib
import importlib
import io
import os
import shutil
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any

import msgspec

from mbsd.dependencies.imported import absolute_name
from mbsd.dependencies.inputs import DYNAMIC
from mbsd.dependencies.recorder import Recorder
from mechanisms.stages.loading.inputs import Inputs, observed
from shared.contract import Piece
from shared.stage.errors import BUSY, UserError
from shared.stage.face import said, to_run
from shared.stage.paths import Out, refuse_links
from shared.stage.stages import Stage, key_of


def traced(params: Any) -> tuple[Any, set[str]]:
    """Return a stand-in for a frozen dataclass instance, and the set that collects names read from it."""
    kind = type(params)
    seen: set[str] = set()

    def read(self: Any, name: str) -> Any:
        if not name.startswith("__"):
            seen.add(name)
        elif name in ("__dict__", "__dataclass_fields__"):  # vars(), asdict(), replace() read everything
            seen.update(field.name for field in dataclasses.fields(kind))
        return object.__getattribute__(self, name)

    stand_in = object.__new__(type(kind.__name__, (kind,), {"__getattribute__": read}))
    for field in dataclasses.fields(kind):
        object.__setattr__(stand_in, field.name, getattr(params, field.name))
    return stand_in, seen


def fields_of(params: Any) -> dict[str, Any]:
    """Return every field by name."""
    return {field.name: getattr(params, field.name) for field in dataclasses.fields(params)}


# Writes a parameter's value as text for keys: equal values have equal texts in every run.


def plain_text(value: Any) -> str | None:
    """Return the text, or None for a value that has none.

    Functions have none, and objects of a class that is no dataclass.

    ``repr`` would not do: it shortens arrays and shows addresses of objects.
    """
    if isinstance(value, enum.Enum):
        return f"{type(value).__qualname__}.{value.name}"
    if value is None or isinstance(value, bool | int | float | complex | str | bytes):
        return f"{type(value).__name__} {value!r}"
    if isinstance(value, PurePath):
        return f"path {value.as_posix()!r}"
    if isinstance(value, list | tuple):
        return _joined(type(value).__name__, list(value))
    if isinstance(value, dict):
        return _joined("dict", [item for pair in value.items() for item in pair])
    if isinstance(value, set | frozenset):
        texts = [plain_text(item) for item in value]
        return None if None in texts else f"set {sorted(text for text in texts if text)}"
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = dataclasses.fields(value)
        return _joined(type(value).__qualname__, [getattr(value, field.name) for field in fields])
    if type(value).__module__ == "numpy" and hasattr(value, "tobytes") and not value.dtype.hasobject:
        return f"array {value.dtype} {value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    return None


def _joined(kind: str, values: list[Any]) -> str | None:
    texts = [plain_text(value) for value in values]
    return None if None in texts else f"{kind} {texts}"


# Finds whether parts.py uses more of mechanism.py than the class Params for its annotations.
#
# If nothing more, the solids follow from mechanism.py only through the parameters that ``parts()`` reads, and an edit
# of anything else there leaves them alone.


def only_annotates(files: Iterable[tuple[Path, str]], module: str) -> bool:
    """Return True if these files use of ``module`` nothing but ``Params``, and that in annotations.

    Each file comes with its package.
    """
    return all(_file_only_annotates(file, package, module) for file, package in files)


def _file_only_annotates(file: Path, package: str, module: str) -> bool:
    text = file.read_text(errors="replace")
    if any(word in text for word in DYNAMIC):
        return False
    tree = ast.parse(text)
    folder, _, stem = module.rpartition(".")
    local: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import) and any(f"{alias.name}.".startswith(f"{folder}.") for alias in node.names):
            if any(alias.name in (folder, module) for alias in node.names):
                return False
        elif isinstance(node, ast.ImportFrom):
            base = absolute_name(node, package)
            if base == folder and any(alias.name in (stem, "*") for alias in node.names):
                return False
            if base == module:
                if any(alias.name != "Params" for alias in node.names):
                    return False
                local.update(alias.asname or alias.name for alias in node.names)
    uses = _Uses(local)
    uses.visit(tree)
    return not uses.used


class _Uses(ast.NodeVisitor):
    """Looks for names outside of annotations."""

    def __init__(self, names: set[str]) -> None:
        self.names = names
        self.used = False

    def visit_Name(self, node: ast.Name) -> None:
        """A name that is used."""
        self.used |= node.id in self.names

    def visit_arg(self, node: ast.arg) -> None:
        """A parameter of a function; its annotation is not looked into."""

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        """A variable with an annotation; only its value is looked into."""
        if node.value is not None:
            self.visit(node.value)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        for child in (node.args, *node.decorator_list, *node.body):
            self.visit(child)

    visit_FunctionDef = _function
    visit_AsyncFunctionDef = _function


# A refusal that took long to find, remembered by the content that it follows from: it is not looked for again.

LONG = 5.0
"""Seconds; what is refused sooner is looked at again."""
STAGE = "parts_refused"
OF_THE_DISK = "free some disk space"

type KeyOf = Callable[[list[str], Inputs], str]
"""Key of parts that read these parameters and were made of these inputs."""


def refuse_again(out: Out, key_of: KeyOf) -> None:
    """Raise the UserError that was remembered, if nothing has changed that it follows from."""
    stage = Stage(out, STAGE, "", [])
    notes = stage.notes()
    reads, inputs, words = notes.get("parameters"), observed(notes.get("inputs")), notes.get("words")
    if not isinstance(reads, list) or not inputs or not isinstance(words, str):
        return
    if Stage(out, STAGE, key_of(reads, inputs), []).is_fresh():
        again = f"{to_run('parts', out.name)} {said(anyway='1').replace(' 1', '')}"
        raise UserError(f"{words} (nothing has changed since this was found; {again} looks for it anew)")


def is_worth_it(error: UserError, seconds: float) -> bool:
    """Return True if a refusal took long to find, and will not be gone next time.

    One of the disk or of another process may be.
    """
    passing = error.code == BUSY or isinstance(error.__cause__, OSError) or OF_THE_DISK in str(error)
    return seconds >= LONG and not passing


def remember(out: Out, error: UserError, key: str, reads: list[str], inputs: Inputs) -> None:
    """Remember that parts with this key were refused."""
    notes: dict[str, Any] = {"parameters": reads, "inputs": inputs.names(), "words": str(error)}
    Stage(out, STAGE, key, []).record(**notes)


def forget(out: Out) -> None:
    """Parts were made, so that nothing is refused any more."""
    Stage(out, STAGE, "", []).stamp.unlink(missing_ok=True)


# Pieces that are meshed, weighed and written, kept while the stage has not ended: what was stopped goes on from there.
#
# A piece is known by the bytes of its shape and all else that its files follow from. The folder is removed when the
# stage ends. Of a stage that ends soon nothing is written.

SOON = 10.0
"""Seconds after which pieces are written; those before are written then, too."""


class Kept(msgspec.Struct):
    """A piece with the bytes of its files."""

    piece: Piece
    stl: bytes
    step: bytes


class KeptPieces:
    """Pieces in ``folder`` that were made by the same program, whose hash is ``program``."""

    def __init__(self, folder: Path, program: str, soon: float = SOON) -> None:
        self.folder, self.program = folder, program
        self._begins = time.monotonic() + soon
        self._waiting: dict[str, Kept] = {}

    def key(self, shape: Any, solid: Any, along: Sequence[bool]) -> str:
        """Return the key of the piece of ``solid``.

        ``shape`` is its ``cadquery.Solid``, as yet without a mesh.
        """
        stream = io.BytesIO()
        shape.exportBin(stream)
        return key_of(self.program, stream.getvalue(), replace(solid, shape=None), along)

    def get(self, key: str) -> Kept | None:
        """Return the piece, if it is there whole."""
        try:
            return msgspec.msgpack.decode((self.folder / key).read_bytes(), type=Kept)
        except (OSError, msgspec.MsgspecError):
            return None

    def add(self, key: str, kept: Kept) -> None:
        """Keep a piece; a disk that takes none is left to who writes the files themselves."""
        self._waiting[key] = kept
        if time.monotonic() < self._begins:
            return
        with suppress(OSError):
            refuse_links(self.folder)
            self.folder.mkdir(parents=True, exist_ok=True)
            for name, waiting in self._waiting.items():
                self._write(name, msgspec.msgpack.encode(waiting))
        self._waiting = {}

    def _write(self, key: str, content: bytes) -> None:
        new = self.folder / f"{key}.{os.getpid()}"
        new.write_bytes(content)
        new.replace(self.folder / key)

    def clear(self) -> None:
        """Forget them all."""
        refuse_links(self.folder)
        shutil.rmtree(self.folder, ignore_errors=True)


# Files that the CAD kernel opens on its own: STEP, IGES, BREP, STL and fonts. It is compiled, so Python does not notice
# these; its reading functions are replaced while parts.py runs.

READERS = (
    ("STEPControl", "STEPControl_Reader", "ReadFile"),
    ("STEPCAFControl", "STEPCAFControl_Reader", "ReadFile"),
    ("IGESControl", "IGESControl_Reader", "ReadFile"),
    ("BRepTools", "BRepTools", "Read_s"),
    ("BinTools", "BinTools", "Read_s"),
    ("RWStl", "RWStl", "ReadFile_s"),
    ("StlAPI", "StlAPI", "Read_s"),
    ("StlAPI", "StlAPI_Reader", "Read"),
    ("RWGltf", "RWGltf_CafReader", "Perform"),
    ("VrmlAPI", "VrmlAPI_CafReader", "Perform"),
    ("Font", "Font_FontMgr", "CheckFont"),
)
"""Module, class and function of OCP; a name that ends in ``_s`` is static."""


@contextmanager
def reported_cad_files(recorder: Recorder) -> Iterator[None]:
    """Count as read every file whose name the kernel's reading functions get in this block."""
    replaced: list[tuple[Any, str, Any]] = []
    try:
        for module, kind, function in READERS:
            owner = getattr(importlib.import_module(f"OCP.{module}"), kind)
            plain = getattr(owner, function)
            reporting = _reporting(plain, recorder)
            replaced.append((owner, function, vars(owner).get(function)))
            setattr(owner, function, staticmethod(reporting) if function.endswith("_s") else reporting)
        yield
    finally:
        for owner, function, plain in replaced:
            if plain is None:
                delattr(owner, function)
            else:
                setattr(owner, function, plain)


def _reporting(plain: Callable[..., Any], recorder: Recorder) -> Callable[..., Any]:
    def reporting(*arguments: Any, **options: Any) -> Any:
        for value in (*arguments, *options.values()):
            if hasattr(value, "ToCString"):
                value = value.ToCString()
            if isinstance(value, str):
                recorder.read(value)
        return plain(*arguments, **options)

    return reporting
