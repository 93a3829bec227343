"""clearance.json: the least distances of a mechanism's parts over its motion. Metres and seconds."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import msgspec

from shared.contract import UNITS, Provenance
from shared.contract.consistency import refuse_other_words
from shared.stage import jsonfile

CLEARANCE_UNITS = {"length": UNITS["length"], "time": UNITS["time"]}
Proof = Literal["layers", "turn", "slide", "motion"]
"""``layers``: the pieces lie at different heights, whatever moves. ``turn``: holds at every angle of the joint between
the two bodies, in space in every pose that it allows. ``slide``: holds at every place along the line of that joint.
``motion``: holds over the motion in data.json."""


class PairClearance(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Two pieces of different bodies that come near each other."""

    bodies: tuple[str, str]
    pieces: tuple[str, str]
    gap: float
    """Least gap that was found (m), at most the search distance; for layers, the height between the two."""
    proven: float
    """The gap is never below this (m)."""
    time: float | None
    """Time at which the least gap occurs (s); null if it does not depend on the pose."""
    proof: Proof
    poses: int
    """Number of poses that were measured."""


class Clearance(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Outcome of a check that found no two parts touching: clearance.json."""

    schema: Literal["mbsd.clearance"] = "mbsd.clearance"
    schema_version: Literal[2] = 2
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(CLEARANCE_UNITS))
    provenance: Provenance
    limit: float
    """Smaller gaps are refused (m)."""
    resolution: float
    """Over a motion, ``proven`` is at most this below ``gap`` (m), where the motion is exact between its samples."""
    interpolation_error: float
    """How far two parts may be from what was checked between two samples of data.json, at most (m); taken off
    ``proven`` where it matters."""
    pairs: list[PairClearance]
    """Nearest first."""
    apart: int
    """Pairs that never come within the search distance."""
    may_touch: list[tuple[str, str]] = []
    """Pairs of bodies that touch by design; their pieces were not compared with each other."""
    pieces_may_touch: list[tuple[str, str]] = []
    """Pairs of pieces that touch by design and were not compared with each other."""


def read_clearance(path: Path) -> Clearance:
    """Read clearance.json; raises UserError if it is inconsistent."""
    clearance = jsonfile.read(path, Clearance)
    refuse_other_words("units", clearance.units, CLEARANCE_UNITS, path)
    return clearance


def write_clearance(path: Path, clearance: Clearance) -> None:
    """Check and write clearance.json, whole."""
    jsonfile.write(path, clearance)
