"""Files that cross a process, and computations that both sides must share.

data.json (the motion) is motion.py and loads.py, in space space.py, parts.json (the solids) parts.py; base.py is in
both. shot.json, clearance.json and skeleton.json are files of their own. This module reads, checks and writes the first
two.
"""

from __future__ import annotations

import re
from pathlib import Path

from shared.contract import consistency
from shared.contract.base import UNITS, Provenance
from shared.contract.loads import Action, Acts, ContactMotion, ForceMotion, GasMotion, HydraulicMotion, Shape, State
from shared.contract.motion import (
    CONVENTIONS_OF,
    BodyMotion,
    Couple,
    Diagnostics,
    DriverMotion,
    Energy,
    EventMark,
    Harmonics,
    JointMotion,
    Motion,
    PointMotion,
    Vibration,
    completed,
)
from shared.contract.parts import PARTS_UNITS, BodyParts, End, Held, Mass, Mount, Parts, Piece, Rolling, mounted
from shared.contract.space import CONVENTIONS3, Motion3, refuse_unsound_space
from shared.stage import jsonfile
from shared.stage.errors import UserError
from shared.stage.face import to_run

__all__ = [
    "CONVENTIONS_OF",
    "PARTS_UNITS",
    "UNITS",
    "Action",
    "Acts",
    "AnyMotion",
    "BodyMotion",
    "BodyParts",
    "ContactMotion",
    "Couple",
    "Diagnostics",
    "DriverMotion",
    "End",
    "Energy",
    "EventMark",
    "ForceMotion",
    "GasMotion",
    "Harmonics",
    "Held",
    "HydraulicMotion",
    "JointMotion",
    "Mass",
    "Motion",
    "Motion3",
    "Mount",
    "Parts",
    "Piece",
    "PointMotion",
    "Provenance",
    "Rolling",
    "Shape",
    "State",
    "Vibration",
    "is_in_space",
    "mounted",
    "read_any_motion",
    "read_motion",
    "read_parts",
    "write_motion",
    "write_parts",
]


type AnyMotion = Motion | Motion3
"""Motion of a mechanism in the plane or in space."""


def read_motion(path: Path, mechanism: str | None = None) -> Motion:
    """Read data.json of a planar mechanism.

    Raises UserError if it is inconsistent, of another ``mechanism``, or of one in space.
    """
    motion = read_any_motion(path, mechanism)
    if isinstance(motion, Motion3):
        raise UserError(
            f"{path} is of '{motion.mechanism}', a mechanism in space; this needs one in the plane. docs/space.md "
            "lists what works in space"
        )
    return motion


def read_any_motion(path: Path, mechanism: str | None = None) -> Motion | Motion3:
    """Read data.json of a mechanism in the plane or in space; raises UserError as :func:`read_motion`."""
    motion = jsonfile.read(path, Motion3 if is_in_space(path) else Motion)
    _refuse_inconsistent(motion, path)
    _refuse_other_mechanism(motion.mechanism, mechanism, path)
    return completed(motion) if isinstance(motion, Motion) else motion


def is_in_space(path: Path) -> bool:
    """Return True for a data.json of a mechanism in space, by its field ``space``, whole or not."""
    try:
        return re.search(rb'"space"\s*:\s*[^{\s]', path.read_bytes()) is not None
    except OSError:
        return False  # the reader says what is wrong


def write_motion(path: Path, motion: Motion | Motion3) -> None:
    """Check and write data.json, whole."""
    _refuse_inconsistent(motion, path)
    jsonfile.write(path, motion)


def read_parts(path: Path, mechanism: str | None = None) -> Parts:
    """Read parts.json and check that its STL files exist; raises UserError as :func:`read_motion`."""
    parts = jsonfile.read(path, Parts)
    _refuse_inconsistent(parts, path)
    _refuse_other_mechanism(parts.mechanism, mechanism, path)
    for body, solids in parts.bodies.items():
        for name, piece in solids.pieces.items():
            if not (path.parent / piece.stl).is_file():
                raise UserError(
                    f"{path}: bodies.{body}.pieces.{name}.stl names {piece.stl}, which is missing; "
                    f"run {to_run('parts', parts.mechanism)}"
                )
    return parts


def write_parts(path: Path, parts: Parts) -> None:
    """Check and write parts.json, whole."""
    _refuse_inconsistent(parts, path)
    jsonfile.write(path, parts)


def _refuse_other_mechanism(mechanism: str, expected: str | None, path: Path) -> None:
    if expected is not None and mechanism != expected:
        raise UserError(
            f"{path} is of the mechanism '{mechanism}', but stands among the results of '{expected}'; make it again"
        )


def _refuse_inconsistent(document: Motion | Motion3 | Parts, path: Path) -> None:
    """Raise UserError for inconsistencies that types cannot express."""
    if isinstance(document, Motion3):
        consistency.refuse_other_words("units", document.units, UNITS, path)
        consistency.refuse_other_words("conventions", document.conventions, CONVENTIONS3, path)
        consistency.refuse_inconsistent_motion(document, path)
        refuse_unsound_space(document, path)
    elif isinstance(document, Motion):
        consistency.refuse_other_words("units", document.units, UNITS, path)
        consistency.refuse_other_words(
            "conventions", document.conventions, CONVENTIONS_OF[document.schema_version], path
        )
        consistency.refuse_inconsistent_motion(document, path)
    else:
        consistency.refuse_other_words("units", document.units, PARTS_UNITS, path)
        consistency.refuse_inconsistent_parts(document, path)
