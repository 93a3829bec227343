"""The files that cross a process: data.json (the motion) and parts.json (the solids). shot.json is in shot.py.

Metres, seconds, kilograms, radians, newtons everywhere; x right, y up, angles counter-clockwise and never wrapped.
A body's x, y, theta place the frame its author drew it in, not its centre of mass.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec

from shared import consistency, jsonfile
from shared.errors import UserError

UNITS = {
    "length": "m",
    "angle": "rad",
    "time": "s",
    "mass": "kg",
    "inertia": "kg m^2",
    "force": "N",
    "torque": "N m",
    "power": "W",
    "energy": "J",
}
PARTS_UNITS = UNITS | {"stl, step": "mm"}
CONVENTIONS = {
    "axes": "x right, y up, angles counter-clockwise and never wrapped",
    "body_frame": "x, y, theta and their rates place the frame the author drew the body in",
    "com": "centre of mass in the body frame; inertia is about it",
    "reaction": "fx, fy, torque: what the joint does to its second body, at the second marker, world axes",
    "effort": "generalised force of the driver along its value; power = effort * rate of value",
    "z": "height of the body's layer above the base; the motion is planar",
}

NonNegative = Annotated[float, msgspec.Meta(ge=0)]
Positive = Annotated[float, msgspec.Meta(gt=0)]
Count = Annotated[int, msgspec.Meta(ge=0)]
Series = list[float]


class _Strict(msgspec.Struct, forbid_unknown_fields=True, kw_only=True):
    """Unknown and missing fields are refused."""


class Provenance(_Strict, kw_only=True):
    """What the file was made from. Nothing here depends on when or where it was made."""

    inputs: str
    """SHA-256 over every input: the mechanism's file, the solver's sources, the masses."""
    versions: dict[str, str]


class BodyMotion(_Strict, kw_only=True):
    """One body over time: its frame (m, rad), rates and accelerations; constants of the body."""

    x: Series
    y: Series
    theta: Series
    vx: Series
    vy: Series
    omega: Series
    ax: Series
    ay: Series
    alpha: Series
    z: float | None
    """Height of its layer (m); null where there are no parts yet."""
    mass: NonNegative
    com: tuple[float, float]
    inertia: NonNegative


class JointMotion(_Strict, kw_only=True):
    """One joint over time: where its second marker is, and the reaction on the second body."""

    kind: str
    bodies: tuple[str, str]
    x: Series
    y: Series
    fx: Series
    fy: Series
    torque: Series


class DriverMotion(_Strict, kw_only=True):
    """One driver over time: its value (m or rad), effort (N or N m) and power (W)."""

    kind: str
    value: Series
    effort: Series
    power: Series


class PointMotion(_Strict, kw_only=True):
    """One traced point over time."""

    body: str
    x: Series
    y: Series
    vx: Series
    vy: Series
    ax: Series
    ay: Series


class Energy(_Strict, kw_only=True):
    """Energy of the whole mechanism (J)."""

    kinetic: Series
    potential: Series


class EventMark(_Strict, kw_only=True):
    """Something that happened at one moment of a simulation: an impact, a contact that opens, an event of the user."""

    time: float
    name: str
    what: str
    """event, end, impact, closes, opens, sticks, slides."""
    energy: float
    """Kinetic energy after less before (J), of all that happens at this time; told with the first."""


class Diagnostics(_Strict, kw_only=True):
    """How good the numbers are."""

    position_residual: NonNegative
    """Largest constraint residual (m or rad) over the motion."""
    velocity_residual: NonNegative
    acceleration_residual: NonNegative
    power_residual: NonNegative
    """Largest |d(T+V)/dt - power of the drivers| (W)."""
    dof: int
    redundant: list[str]
    """Joints whose rows repeat what others already hold: one removable set."""
    singularity_margin: Series
    """Smallest over largest singular value of the scaled Jacobian, 0 at a singular pose; per time."""


class Motion(_Strict, kw_only=True):
    """data.json: the motion of one mechanism."""

    schema: Literal["mbsd.motion"] = "mbsd.motion"
    schema_version: Literal[1] = 1
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(UNITS))
    conventions: dict[str, str] = msgspec.field(default_factory=lambda: dict(CONVENTIONS))
    provenance: Provenance
    gravity: tuple[float, float]
    period: Positive | None
    """Every pose repeats after this time (s), and ``time`` spans it exactly, both ends included; else null."""
    time: Series
    """Rises; rows right before and right after an event share its time: poses agree there, rates may differ."""
    bodies: dict[str, BodyMotion]
    joints: dict[str, JointMotion]
    drivers: dict[str, DriverMotion]
    points: dict[str, PointMotion]
    energy: Energy
    events: list[EventMark] = []
    """In the order of their times."""
    diagnostics: Diagnostics


class Mass(_Strict, kw_only=True):
    """Mass properties: kg, centre of mass (m, body frame), inertia about it (kg m^2), volume (m^3)."""

    mass: NonNegative
    com: tuple[float, float]
    inertia: NonNegative
    volume: NonNegative


class Piece(_Strict, kw_only=True):
    """One printable solid of a body, in the body's frame; its files stand beside parts.json (millimetres)."""

    material: str
    stl: str
    step: str
    mass: Mass
    z_range: tuple[float, float]
    """Lowest and highest point (m)."""
    triangles: Count
    stl_sha256: str


class BodyParts(_Strict, kw_only=True):
    """All pieces that move with one body, and their mass together. ``ground`` is the frame."""

    pieces: dict[str, Piece]
    mass: Mass
    z: float
    """Middle height of the body's main piece (m)."""


class Parts(_Strict, kw_only=True):
    """parts.json: the solids of one mechanism."""

    schema: Literal["mbsd.parts"] = "mbsd.parts"
    schema_version: Literal[1] = 1
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(PARTS_UNITS))
    provenance: Provenance
    bodies: dict[str, BodyParts]


def read_motion(path: Path, mechanism: str | None = None) -> Motion:
    """Read data.json; raises UserError if it does not hold together, or if it is of another ``mechanism``."""
    motion = jsonfile.read(path, Motion)
    _refuse_inconsistent(motion, path)
    _refuse_other_mechanism(motion.mechanism, mechanism, path)
    return motion


def write_motion(path: Path, motion: Motion) -> None:
    """Check and write data.json, whole."""
    _refuse_inconsistent(motion, path)
    jsonfile.write(path, motion)


def read_parts(path: Path, mechanism: str | None = None) -> Parts:
    """Read parts.json and see that its STL files stand beside it; raises UserError as :func:`read_motion`."""
    parts = jsonfile.read(path, Parts)
    _refuse_inconsistent(parts, path)
    _refuse_other_mechanism(parts.mechanism, mechanism, path)
    for body, solids in parts.bodies.items():
        for name, piece in solids.pieces.items():
            if not (path.parent / piece.stl).is_file():
                raise UserError(
                    f"{path}: bodies.{body}.pieces.{name}.stl names {piece.stl}, which is missing; "
                    f"run make parts-{parts.mechanism.replace('_', '-')}"
                )
    return parts


def write_parts(path: Path, parts: Parts) -> None:
    """Check and write parts.json, whole."""
    _refuse_inconsistent(parts, path)
    jsonfile.write(path, parts)


def _refuse_other_mechanism(found: str, expected: str | None, path: Path) -> None:
    if expected is not None and found != expected:
        raise UserError(
            f"{path} is of the mechanism '{found}', but stands among the results of '{expected}'; make it again"
        )


def _refuse_inconsistent(document: Motion | Parts, path: Path) -> None:
    """Raise UserError for what the types cannot say."""
    if isinstance(document, Motion):
        consistency.refuse_other_words("units", document.units, UNITS, path)
        consistency.refuse_other_words("conventions", document.conventions, CONVENTIONS, path)
        consistency.refuse_inconsistent_motion(document, path)
    else:
        consistency.refuse_other_words("units", document.units, PARTS_UNITS, path)
        consistency.refuse_inconsistent_parts(document, path)
