"""The parts of a mechanism as a worker sends them, and the checks before they are believed.

Nothing here runs what came, and no file is written under a name that came: names are those that parts.json gives, each
a plain name beside it. The solids themselves are read by a process of their own (solids_check.py).
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any, NoReturn

import msgspec

from mbsd.dealing.report import WrongAnswer, printable
from mechanisms.stages.loading.inputs import Inputs
from shared.contract import PARTS_UNITS, Parts, consistency
from shared.stage import jsonfile
from shared.stage.errors import UserError

MOST = 1_000_000_000
"""Bytes of all parts of a mechanism."""
DOCUMENT = 50_000_000
"""Bytes of parts.json."""
NAMES, LONGEST_NAME = 10_000, 1000
"""Inputs of the parts, and letters of one of their names."""
PATIENCE = 600.0
"""Seconds in which the solids are read."""
PROJECT = Path(__file__).parents[4]


class Notes(msgspec.Struct, forbid_unknown_fields=True):
    """Notes in the stamp of the stage about its inputs."""

    parameters: list[str]
    inputs: dict[str, list[str]]
    machine: bool = True
    """True if parts of a model may follow from those of the machine."""


class WorkerParts(msgspec.Struct, forbid_unknown_fields=True):
    """The parts of a mechanism."""

    document: bytes = b""
    """parts.json."""
    files: dict[str, bytes] = {}
    """STL and STEP by name, in the order of the solids."""
    notes: dict[str, Any] = {}
    """The fields of :class:`Notes`."""
    refusal: str = ""
    """Reason why the stage built none."""


def read(name: str, content: bytes, own_file: str, program: Mapping[str, str]) -> WorkerParts:
    """Return the parts of the mechanism ``name`` from the bytes that a worker sent.

    ``own_file`` is the author's file that they must follow from, ``program`` has the versions of the packages here.
    Raises WrongAnswer unless everything holds together: document, names, hashes, solids with their meshes and masses.
    """
    try:
        made = msgspec.msgpack.decode(content, type=WorkerParts)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise WrongAnswer(f"the parts of {name} cannot be read ({printable(str(error))})") from error
    if made.refusal:
        return msgspec.structs.replace(made, refusal=printable(made.refusal, 2000))
    if len(made.document) > DOCUMENT:
        _refuse(name, f"parts.json has {len(made.document) / 1e6:.0f} MB")
    try:
        document = parts_from(made.document, f"parts.json of {name}")
    except UserError as error:
        raise WrongAnswer(printable(str(error))) from error
    if document.mechanism != name:
        _refuse(name, f"they are those of '{document.mechanism}'")
    versions = document.provenance.versions
    if not versions or any(program.get(package) != version for package, version in versions.items()):
        _refuse(name, "parts.json tells of other packages")
    _refuse_other_files(name, document, made.files)
    _refuse_other_notes(name, made.notes, own_file)
    _refuse_other_solids(name, made)
    return made


def parts_from(content: bytes, where: str) -> Parts:
    """Return the parts.json with these bytes; raises UserError unless it holds together."""
    document = jsonfile.decode(content, Parts, where)
    consistency.refuse_other_words("units", document.units, PARTS_UNITS, where)
    consistency.refuse_inconsistent_parts(document, where)
    return document


def _refuse(name: str, what: str) -> NoReturn:
    raise WrongAnswer(f"the parts of {name}: {printable(what)}")


def _refuse_other_files(name: str, document: Parts, files: Mapping[str, bytes]) -> None:
    """Exactly the files that parts.json names, and the meshes with the hashes that it gives."""
    pieces = [piece for body in document.bodies.values() for piece in body.pieces.values()]
    named = {file for piece in pieces for file in (piece.stl, piece.step)}
    if named != set(files):
        odd = min(named ^ set(files))
        _refuse(name, f"file '{odd}' is {'missing' if odd in named else 'none that parts.json names'}")
    for key, piece in ((key, piece) for body in document.bodies.values() for key, piece in body.pieces.items()):
        if (piece.stl, piece.step) != (f"{key}.stl", f"{key}.step"):
            _refuse(name, f"the files of '{key}' are called '{piece.stl}' and '{piece.step}'")
        if hashlib.sha256(files[piece.stl]).hexdigest() != piece.stl_sha256:
            _refuse(name, f"{piece.stl} has another hash than parts.json tells")


def _refuse_other_notes(name: str, fields: Mapping[str, Any], own_file: str) -> None:
    """Names of inputs of all kinds, few enough to be looked at, the author's own file among them."""
    try:
        notes = msgspec.convert(fields, Notes)
    except msgspec.ValidationError as error:
        _refuse(name, f"it tells what they were made from in another form ({error})")
    if set(notes.inputs) != set(Inputs().names()):
        _refuse(name, "it does not tell what they were made from")
    names = [entry for kind in notes.inputs.values() for entry in kind] + notes.parameters
    if len(names) > NAMES or any(not entry or len(entry) > LONGEST_NAME or "\0" in entry for entry in names):
        _refuse(name, "what they were made from has names that are none")
    if own_file not in notes.inputs["modules"]:
        _refuse(name, f"they do not follow from {own_file}")
    for source in notes.inputs["sources"]:
        if PurePosixPath(source).is_absolute() or ".." in PurePosixPath(source).parts:
            _refuse(name, f"they follow from sources outside the project ('{source}')")


def _refuse_other_solids(name: str, made: WorkerParts) -> None:
    """Have a process read all meshes and solids: if the CAD kernel crashes, nothing else ends."""
    with tempfile.TemporaryDirectory(prefix="mbsd-parts-") as folder:
        (Path(folder) / "parts.json").write_bytes(made.document)
        for file, content in made.files.items():
            (Path(folder) / file).write_bytes(content)
        command = [sys.executable, "-m", "mechanisms.stages.parts.on_cluster.solids_check", folder]
        environment = os.environ | {"PYTHONPATH": str(PROJECT)}
        try:
            done = subprocess.run(
                command, cwd=PROJECT, env=environment, capture_output=True, timeout=PATIENCE, check=False
            )
        except subprocess.TimeoutExpired:
            _refuse(name, f"their solids could not be read within {PATIENCE:.0f} s")
    if done.returncode:
        said: Any = done.stderr.decode(errors="replace").strip().splitlines()
        _refuse(name, said[-1] if said and done.returncode > 0 else f"the CAD kernel ended on them ({done.returncode})")
