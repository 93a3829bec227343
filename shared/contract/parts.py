"""parts.json: the solids of one mechanism, as structs. The package reads and writes them."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import msgspec
import numpy as np

from shared.contract.base import UNITS, Count, NonNegative, Positive, Provenance, Strict
from shared.contract.motion import BodyMotion, Motion
from shared.stage.errors import UserError

# Mount of a mechanism's ground: on a desk, on a stand, at a wall or on the ground.
#
# The parts stage decides it once and writes it into parts.json; film, page, GLB and prints read it there.


type Vector = tuple[float, float, float]
Kind = Literal["desk", "stand", "wall", "ground"]
Z: Vector = (0.0, 0.0, 1.0)
Y: Vector = (0.0, 1.0, 0.0)


class Mount(msgspec.Struct, forbid_unknown_fields=True, kw_only=True, frozen=True):
    """Holder of the ground, and the direction up in every picture.

    ``desk``: its base lies on a desk, and ``up`` is the normal of the plane, (0, 0, 1). For the others ``up`` is in the
    plane, against gravity. ``stand``: its base is a back plate on a foot. ``wall``: the back plate hangs at a wall.
    ``ground``: the road, terrain or floor of the model is the ground on which it stands.
    """

    kind: Kind = "desk"
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


PARTS_UNITS = UNITS | {"stl, step": "mm"}


class Mass(Strict, kw_only=True, omit_defaults=True):
    """Mass properties: kg, centre of mass (m, body frame), inertia about it (kg m^2), volume (m^3).

    ``z`` and ``products`` are there where z of the solids is that of the model.
    """

    mass: NonNegative
    com: tuple[float, float]
    inertia: NonNegative
    volume: NonNegative
    z: float | None = None
    """Height of the centre of mass, along the normal of the plane (m)."""
    products: tuple[float, float] | None = None
    """Integrals of x z dm and y z dm about the centre of mass, in the body's frame (kg m^2)."""


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
    """By the names of forces: springs, dampers and actuators that have an end here."""
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


class BodyParts(Strict, kw_only=True):
    """All pieces that move with one body, and their mass together. ``ground`` is the frame."""

    pieces: dict[str, Piece]
    mass: Mass
    z: float
    """Middle height of the body's main piece (m)."""
    spans: tuple[End, End] | None = None
    """Ends of a rod, which is no body of data.json: places of the bodies it joins. Its frame is at the first, its x
    axis goes to the second (shared/contract/parts.py). Null of bodies."""


class Parts(Strict, kw_only=True):
    """Solids of one mechanism: parts.json."""

    schema: Literal["mbsd.parts"] = "mbsd.parts"
    schema_version: Literal[1] = 1
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(PARTS_UNITS))
    provenance: Provenance
    mount: Mount = Mount()
    """How ground stands in the world; files without it lie on a desk."""
    bodies: dict[str, BodyParts]
    without_solids: list[str] = []
    """Bodies of mechanism.py that are left out here."""
    may_touch: list[tuple[str, str]] = []
    """Pairs of bodies that touch by design: their pieces are not compared with each other."""
    pieces_may_touch: list[tuple[str, str]] = []
    """Pairs of pieces of different bodies that touch by design; all else of their bodies is compared."""


# Rods of parts.json, which join two places of bodies: their motion follows from these bodies.
#
#     p = second place - first place    l = |p|     u = p / l     n = u turned by a quarter, counter-clockwise
#     theta = angle of p                omega = p' . n / l        alpha = (p'' . n - 2 l' omega) / l     l' = p' . u
#
# The rod's frame is at the first place. It has no mass here: in the model it is a constraint. A rod that an event
# releases stays on the body of its first place as it is then.


def with_rods(motion: Motion, parts: Parts) -> Motion:
    """Return the motion with a body for each rod of the parts.

    Raises UserError if a rod ends on no body, or on itself.
    """
    rods = {name: body.spans for name, body in parts.bodies.items() if body.spans is not None}
    if not rods:
        return motion
    made = {name: _moved(name, ends, parts.bodies[name].z, motion) for name, ends in rods.items()}
    for name in set(rods) & set(motion.joints):
        rows = motion.joints[name].rows_held(motion.time)
        if 0 < rows < len(motion.time):
            _leave(made[name], motion.bodies.get(rods[name][0].body), rows)
    return msgspec.structs.replace(motion, bodies=motion.bodies | made)


def _moved(name: str, ends: tuple[End, End], z: float, motion: Motion) -> BodyMotion:
    if name in motion.bodies:
        raise UserError(
            f"{motion.mechanism}: parts.json has a rod '{name}', and data.json a body of that name; rename the joint"
        )
    (place, rate, change), second = (_place(name, end, motion) for end in ends)
    way, way_rate, way_change = (b - a for a, b in zip((place, rate, change), second, strict=True))
    length = np.hypot(*way.T)
    joint = motion.joints.get(name)
    rows = len(length) if joint is None else joint.rows_held(motion.time)
    if length[:rows].min() < 1e-9:
        at = motion.time[int(length[:rows].argmin())]
        raise UserError(
            f"{motion.mechanism}: both ends of the rod '{name}' are on one place at t={at:.4g} s; join others"
        )
    length = np.maximum(length, 1e-9)  # after a release the ends may meet
    along = way / length[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    omega = (way_rate * across).sum(axis=1) / length
    alpha = ((way_change * across).sum(axis=1) - 2 * (way_rate * along).sum(axis=1) * omega) / length
    theta = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
    if motion.period is not None:  # what repeats but for whole turns does so to the last digit
        theta += (theta[0] + np.round((theta[-1] - theta[0]) / np.pi / 2) * 2 * np.pi - theta[-1]) * (
            np.arange(len(theta)) == len(theta) - 1
        )
    series = (*place.T, theta, *rate.T, omega, *change.T, alpha)
    names = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
    values = {key: column.tolist() for key, column in zip(names, series, strict=True)}
    return BodyMotion(**values, z=z, mass=0.0, com=(0.0, 0.0), inertia=0.0)


def _leave(rod: BodyMotion, body: BodyMotion | None, rows: int) -> None:
    """Turn a rod with ``body``, which is ground if None, from the row after ``rows`` on."""
    at = rod.theta[rows - 1]
    count = len(rod.theta) - rows
    if body is None:
        rod.theta[rows:], rod.omega[rows:], rod.alpha[rows:] = [at] * count, [0.0] * count, [0.0] * count
        return
    rod.theta[rows:] = [at + angle - body.theta[rows - 1] for angle in body.theta[rows:]]
    rod.omega[rows:], rod.alpha[rows:] = body.omega[rows:], body.alpha[rows:]


def _place(name: str, end: End, motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the place of an end, its velocity and its acceleration, (T, 2) each."""
    if end.body == "ground":
        still = np.zeros((len(motion.time), 2))
        return still + np.array([end.x, end.y]), still, still
    if end.body not in motion.bodies:
        raise UserError(
            f"{motion.mechanism}: the rod '{name}' of parts.json ends on '{end.body}', which data.json does not move; "
            f"there is: ground, {', '.join(motion.bodies)}"
        )
    body = motion.bodies[end.body]
    theta, omega, alpha = (np.asarray(column)[:, None] for column in (body.theta, body.omega, body.alpha))
    arm = np.hstack([np.cos(theta) * end.x - np.sin(theta) * end.y, np.sin(theta) * end.x + np.cos(theta) * end.y])
    side = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    place = np.column_stack([body.x, body.y]) + arm
    rate = np.column_stack([body.vx, body.vy]) + omega * side
    return place, rate, np.column_stack([body.ax, body.ay]) + alpha * side - omega**2 * arm
