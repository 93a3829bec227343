"""parts.json: the solids of one mechanism, as structs. The package reads and writes them."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import msgspec

from shared.contract.base import UNITS, Count, NonNegative, Positive, Provenance, Strict
from shared.stage.errors import UserError

# Mount of a mechanism's ground: on a desk, on a stand, at a wall or on the ground.
#
# The parts stage decides it once and writes it into parts.json; film, page, GLB and prints read it there.


type Vector = tuple[float, float, float]
Kind = Literal["desk", "stand", "wall", "ground"]
"""How an author may have a mechanism in the plane stand."""
Z: Vector = (0.0, 0.0, 1.0)
Y: Vector = (0.0, 1.0, 0.0)
LEVEL = 1e-9
"""Sine of the angle below which a pull is along an axis."""


class Mount(msgspec.Struct, forbid_unknown_fields=True, kw_only=True, frozen=True):
    """Holder of the ground, and the direction up in every picture.

    ``desk``: its base lies on a desk, and ``up`` is the normal of the plane, (0, 0, 1). For the others ``up`` is in the
    plane, against gravity. ``stand``: its base is a back plate on a foot. ``wall``: the back plate hangs at a wall.
    ``ground``: the road, terrain or floor of the model is the ground on which it stands. ``bench``: a mechanism in
    space stands with its base on a bench, ``up`` against gravity.
    """

    kind: Literal["desk", "stand", "wall", "ground", "bench"] = "desk"
    up: Vector = Z
    """Unit vector of the world."""


def mounted(gravity: tuple[float, float], kind: Kind | None = None, runs_on_ground: bool = False) -> Mount:
    """Return the mount for this ``gravity`` in the plane (m/s^2); ``kind`` is the author's choice.

    By default a machine without gravity in the plane lies on a desk, one that ``runs_on_ground`` stands on that, and
    any other on a stand. Without gravity y points up where an author has it stand.
    """
    pull = math.hypot(*gravity)
    if kind is None:
        kind = "desk" if pull == 0.0 else "ground" if runs_on_ground else "stand"
    if kind == "desk":
        return Mount()
    if pull == 0.0:
        return Mount(kind=kind, up=Y)
    x, y = (0.0 - component / pull for component in gravity)
    return Mount(kind=kind, up=(x, y, 0.0))


def mounted_in_space(mechanism: str, gravity: Vector) -> Mount:
    """Return the mount of a mechanism in space under this ``gravity`` (m/s^2).

    Raises UserError for a pull that is neither along z nor across it.
    """
    x, y, z = (0.0 - component for component in gravity)
    pull = math.hypot(x, y, z)
    if pull == 0.0 or (math.hypot(x, y) < LEVEL * pull and z > 0.0):
        return Mount(kind="bench")
    if abs(z) > LEVEL * pull:
        raise UserError(
            f"{mechanism}: gravity pulls along ({-x:g}, {-y:g}, {-z:g}); pictures stand upright where it pulls along "
            "-z, or along a direction of the x-y plane. Turn the axes of mechanism.py"
        )
    flat = math.hypot(x, y)
    return Mount(kind="bench", up=(x / flat, y / flat, 0.0))


PARTS_UNITS = UNITS | {"stl, step": "mm"}


class Mass(Strict, kw_only=True, omit_defaults=True):
    """Mass properties: kg, centre of mass (m, body frame), inertia about it (kg m^2), volume (m^3).

    ``z`` and ``products`` are there where z of the solids is that of the model, ``tensor`` in space.
    """

    mass: NonNegative
    com: tuple[float, float]
    inertia: NonNegative
    volume: NonNegative
    z: float | None = None
    """Height of the centre of mass, along the normal of the plane (m)."""
    products: tuple[float, float] | None = None
    """Integrals of x z dm and y z dm about the centre of mass, in the body's frame (kg m^2)."""
    tensor: tuple[float, float, float, float, float, float] | None = None
    """xx, yy, zz, xy, xz, yz of the inertia about the centre of mass, in axes of the body's frame (kg m^2)."""


class Held(Strict, kw_only=True):
    """Place where the film draws a spring fixed to a piece (m): height of its axis, radius of its coil."""

    z: float
    radius: Positive


class Rolling(Strict, kw_only=True):
    """Roller about (x, y) of its body's frame (m) that rolls without slip in a joint."""

    joint: str
    x: float
    y: float
    radius: Positive
    marks: Annotated[int, msgspec.Meta(ge=1)]
    """It looks the same after a turn by one of so many."""


class Piece(Strict, kw_only=True):
    """One printable solid of a body, in the body's frame; its files stand beside parts.json (millimetres)."""

    material: str
    stl: str
    step: str
    mass: Mass
    z_range: tuple[float, float]
    """Lowest and highest point (m)."""
    triangles: Count
    stl_sha256: str
    holds: dict[str, Held] = {}
    """Studs by the names of forces: springs, dampers and actuators that have an end here."""
    buy: str = ""
    """Name in a shop, such as "circlip 8x0.8 DIN 471"; empty if the piece is to be made."""
    rolls: Rolling | None = None
    """Null of what does not turn against its body."""
    dressing: bool = False
    """True if it shows what the machine works on, and is none of the mass of its body."""


class End(Strict, kw_only=True):
    """Eye of a rod: a place (m) of a body of data.json, or of ground, in its frame."""

    body: str
    x: float
    y: float


class Link(Strict, kw_only=True):
    """Massless link of a joint in space.

    Its frame is at the place of the joint's first marker. The x axis of a rod goes to the second place, and its z axis
    is as near as can be to ``z`` of ``body``; x and y of a cross are the axes of both markers.
    """

    joint: str
    body: str
    z: Vector


class BodyParts(Strict, kw_only=True):
    """All pieces that move with one body, and their mass together. ``ground`` is the frame."""

    pieces: dict[str, Piece]
    mass: Mass
    z: float
    """Middle height of the body's main piece (m)."""
    spans: tuple[End, End] | None = None
    """Ends of a rod, which is no body of data.json: places of the bodies it joins. Its frame is at the first, its x
    axis goes to the second (shared/contract/parts.py). Null of bodies."""
    link: Link | msgspec.UnsetType = msgspec.UNSET
    """Joint in space whose massless link this is: a rod or a cross, no body of data.json. Left out of bodies."""


class Parts(Strict, kw_only=True):
    """Solids of one mechanism: parts.json."""

    schema: Literal["mbsd.parts"] = "mbsd.parts"
    schema_version: Literal[1] = 1
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(PARTS_UNITS))
    provenance: Provenance
    mount: Mount = Mount()
    """Stand of ground in the world; files without it lie on a desk."""
    schematic: str = ""
    """Sentence on glass plates that may overlap, which stand for what cannot be built; empty if all can be."""
    bodies: dict[str, BodyParts]
    without_solids: list[str] = []
    """Bodies of mechanism.py that are left out here."""
    may_touch: list[tuple[str, str]] = []
    """Pairs of bodies that touch by design: their pieces are not compared with each other."""
    pieces_may_touch: list[tuple[str, str]] = []
    """Pairs of pieces of different bodies that touch by design; all else of their bodies is compared."""
