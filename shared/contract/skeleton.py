"""skeleton.json: the mechanism as polylines with standard symbols, over its motion.

Metres and seconds.

The solve stage writes it, because the symbols belong to the kinds of joints that the solver knows; plots draw it.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

import msgspec

from shared.contract import UNITS, Provenance
from shared.stage import jsonfile
from shared.stage.errors import UserError

Unit = Annotated[float, msgspec.Meta(ge=0, le=1)]
NonNegative = Annotated[float, msgspec.Meta(ge=0)]
Positive = Annotated[float, msgspec.Meta(gt=0)]


_SIDE, _RISE = math.radians(-20.705), math.radians(19.471)
VIEW = (
    (math.cos(_SIDE), math.sin(_SIDE), 0.0),
    (-math.sin(_SIDE) * math.sin(_RISE), math.cos(_SIDE) * math.sin(_RISE), math.cos(_RISE)),
)
"""Directions right and up of the picture of a skeleton in space: the dimetric view of mbsd/spatial/drawing.py."""


class _Strict(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Struct that rejects unknown and missing fields."""


class Stroke(_Strict, kw_only=True, omit_defaults=True):
    """A polyline, or an outline that may be filled."""

    points: list[float]
    """x and y in turn (m)."""
    closed: bool
    ink: str
    """Colour of the line: ``body:<name>``, or ink, quiet, paper, faint, driver, load, wrong, x, y."""
    fill: str | None
    """Colour of the filling, by the same words; null: none."""
    alpha: Unit
    """Opacity of the filling, or of an open line."""
    width: NonNegative
    """Width of the line (points)."""
    order: float
    """Higher ones cover lower ones."""
    dash: list[Positive]
    """Lengths of strokes and gaps in line widths; empty: solid."""
    sign: Literal["centre of mass"] | None = None
    """Mark that pictures show on demand."""


class Name(_Strict, kw_only=True):
    """A name and what it belongs to."""

    text: str
    at: tuple[float, float]
    """m"""
    clearance: NonNegative
    """Kept free around ``at`` (m)."""
    ink: str


class Pose(_Strict, kw_only=True):
    """One moment."""

    time: float
    strokes: list[Stroke]


class End(_Strict, kw_only=True):
    """A point of a body or of ground, in its frame (m)."""

    body: str
    x: float = 0.0
    y: float = 0.0
    z: float | msgspec.UnsetType = msgspec.UNSET
    """Third coordinate, in space alone; such ends are seen in the view of the skeleton."""


class Carrier(_Strict, kw_only=True):
    """Carrier of a stroke or name, for any moment of the motion."""

    kind: Literal["ground", "body", "place", "line", "shapes"]
    """It stays; it moves with a body's frame; it moves with a point and does not turn; it moves with the line between
    two points, stretched along it and not across; it is recorded in many poses."""
    ends: list[End] = []
    """None of ground and shapes; the body; the point; the two ends of the line."""


class Carried(_Strict, kw_only=True):
    """Stroke at the start of the motion, and its carrier."""

    stroke: Stroke
    carrier: Carrier
    shapes: list[list[float]] = []
    """Outline of what nothing carries: its points (x and y in turn, m) at the times of the shapes; they correspond."""


class CarriedName(_Strict, kw_only=True):
    """Name at the start of the motion."""

    name: Name
    carrier: Carrier


class Moving(_Strict, kw_only=True):
    """The whole skeleton for any moment: symbols stay on one side, springs keep their turns."""

    unit: Positive
    """Size of the symbols (m)."""
    low: tuple[float, float]
    high: tuple[float, float]
    """Corners of the box that holds the machine over the whole motion (m)."""
    strokes: list[Carried]
    names: list[CarriedName]
    times: list[float]
    """Times of the shapes (s)."""


class Skeleton(_Strict, kw_only=True):
    """Skeleton of one mechanism: skeleton.json."""

    schema: Literal["mbsd.skeleton"] = "mbsd.skeleton"
    schema_version: Literal[1] = 1
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: {key: UNITS[key] for key in ("length", "time")})
    provenance: Provenance
    unit: Positive
    """Size of the symbols (m): about the radius of a pin."""
    names: list[Name]
    """In the first pose."""
    poses: Annotated[list[Pose], msgspec.Meta(min_length=1)]
    """In equal times. The first holds everything, the others only what is elsewhere."""
    moving: Moving | None = None
    """Null in files from before it was recorded."""


def read_skeleton(path: Path) -> Skeleton:
    """Read skeleton.json; raises UserError if it is inconsistent."""
    skeleton = jsonfile.read(path, Skeleton)
    for index, pose in enumerate(skeleton.poses):
        for number, stroke in enumerate(pose.strokes):
            if len(stroke.points) % 2 or len(stroke.points) < 4:
                raise UserError(
                    f"{path}: poses[{index}].strokes[{number}].points has {len(stroke.points)} numbers; "
                    "x and y in turn of two points or more"
                )
    if skeleton.moving is not None:
        _refuse_inconsistent(skeleton.moving, path)
    return skeleton


def write_skeleton(path: Path, skeleton: Skeleton) -> None:
    """Check and write skeleton.json, whole."""
    jsonfile.write(path, skeleton)


def _refuse_inconsistent(moving: Moving, path: Path) -> None:
    """Raise UserError unless carriers have ends, and recorded strokes a shape for every time."""
    ends = {"ground": 0, "shapes": 0, "body": 1, "place": 1, "line": 2}
    for number, stroke in enumerate(moving.strokes):
        where = f"{path}: moving.strokes[{number}]"
        if len(stroke.carrier.ends) != ends[stroke.carrier.kind]:
            raise UserError(
                f"{where}.carrier is a {stroke.carrier.kind} with {len(stroke.carrier.ends)} ends; make it again"
            )
        wanted = len(moving.times) if stroke.carrier.kind == "shapes" else 0
        if len(stroke.shapes) != wanted or len({len(shape) for shape in stroke.shapes}) > 1:
            raise UserError(f"{where}.shapes are {len(stroke.shapes)}, not {wanted} of one length; make it again")
