"""data.json of a mechanism in space: version 4 of the motion, as structs. The package reads and writes them.

A body's place is that of the frame its author drew it in. Its orientation is the unit quaternion (w, x, y, z) from body
to world, a series for each entry, whose signs go on from row to row; after a period it may be the negative one, which
is the same pose. The planar file is motion.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import msgspec

from shared.contract.base import UNITS, NonNegative, Positive, Provenance, Series, Strict
from shared.contract.loads import EffortUnit, Look, ValueUnit
from shared.contract.motion import Colour, Diagnostics, Energy, EventMark
from shared.stage.errors import UserError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

type Vector3 = tuple[float, float, float]
type Quaternion = tuple[float, float, float, float]
"""(w, x, y, z)"""
UNIT_TOLERANCE = 1e-9
"""Tolerance of the length of a unit vector or quaternion of a file."""

CONVENTIONS3 = {
    "axes": "right-handed axes of the world; angles of joints are counted and never wrapped",
    "body_frame": "x, y, z and the unit quaternion qw, qx, qy, qz (body to world) place the frame the author drew; its "
    "signs go on from row to row",
    "rates": "vx, vy, vz and ax, ay, az of that frame; wx, wy, wz and alphax, alphay, alphaz of the body, world axes",
    "com": "centre of mass in the body frame; inertia (xx, yy, zz, xy, xz, yz) is about it, in axes of that frame",
    "reaction": "fx, fy, fz, mx, my, mz: what the joint does to its second body, at (x, y, z), world axes",
    "axis": "ux, uy, uz: the joint's axis, fixed to its first body; turn and slide are about and along it",
    "markers": "frames on both bodies of a joint or force: place, axis and a direction across it, in the body's frame",
    "effort": "generalised force of the driver along its value; power = effort * rate of value",
}


class Marker3(Strict, kw_only=True):
    """A frame fixed to a body, in the body's frame: its z axis is ``axis``, its x axis ``across``."""

    place: Vector3
    axis: Vector3
    across: Vector3


class BodyMotion3(Strict, kw_only=True):
    """One body over time: its frame (m, quaternion), rates and accelerations; constants of the body."""

    x: Series
    y: Series
    z: Series
    qw: Series
    qx: Series
    qy: Series
    qz: Series
    vx: Series
    vy: Series
    vz: Series
    wx: Series
    wy: Series
    wz: Series
    ax: Series
    ay: Series
    az: Series
    alphax: Series
    alphay: Series
    alphaz: Series
    mass: NonNegative
    mass_from: Literal["mechanism", "parts"]
    com: Vector3
    inertia: tuple[float, float, float, float, float, float]
    """xx, yy, zz, xy, xz, yz."""
    colour: Colour
    """Its ink on light paper."""
    colour_on_dark: Colour

    @property
    def place(self) -> Array:
        """(T, 3) m"""
        return columns(self, "x", "y", "z")

    @property
    def quaternion(self) -> Array:
        """(T, 4)"""
        return columns(self, "qw", "qx", "qy", "qz")

    @property
    def changes(self) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]:
        """Place (T, 3) and quaternion (T, 4), each with its first and second derivative.

        q' = w q / 2 and q'' = (w' q + w q') / 2, with the angular velocity w in the world.
        """
        import numpy as np

        from shared.contract.quaternions import product

        q, zero = self.quaternion, np.zeros((len(self.x), 1))
        w, alpha = (np.hstack([zero, columns(self, *(f"{name}{axis}" for axis in "xyz"))]) for name in ("w", "alpha"))
        rate = 0.5 * product(w, q)
        bend = 0.5 * (product(alpha, q) + product(w, rate))
        return (self.place, columns(self, "vx", "vy", "vz"), columns(self, "ax", "ay", "az")), (q, rate, bend)


class JointMotion3(Strict, kw_only=True):
    """One joint over time: the place of its second marker, its axis, and the reaction on the second body."""

    kind: str
    bodies: tuple[str, str]
    markers: tuple[Marker3, Marker3]
    x: Series
    y: Series
    z: Series
    ux: Series
    uy: Series
    uz: Series
    fx: Series
    fy: Series
    fz: Series
    mx: Series
    my: Series
    mz: Series
    turn: Series | None = None
    """rad; null of joints without one."""
    slide: Series | None = None
    """m; null of joints without one."""


class DriverMotion3(Strict, kw_only=True):
    """One driver over time: its value (m or rad), effort (N or N m) and power (W)."""

    kind: str
    bodies: tuple[str, str]
    joint: str | None
    """Joint whose turn or slide it imposes; null of a distance."""
    unit: ValueUnit
    effort_unit: EffortUnit
    value: Series
    effort: Series
    power: Series


class Row3(Strict, kw_only=True):
    """One measure of a force (m or rad), its rate, and the push along it (N or N m)."""

    value: Series
    rate: Series
    effort: Series


class ForceMotion3(Strict, kw_only=True):
    """One force over time."""

    kind: str
    bodies: tuple[str, str]
    markers: tuple[Marker3, Marker3]
    unit: ValueUnit
    effort_unit: EffortUnit
    look: Look = ""
    rows: list[Row3]
    """Empty of forces that are functions of frames."""
    fx: Series | None = None
    """fx, fy, fz (N), mx, my, mz (N m) on the second body, world axes; null of forces with rows."""
    fy: Series | None = None
    fz: Series | None = None
    mx: Series | None = None
    my: Series | None = None
    mz: Series | None = None
    power: Series


class PointMotion3(Strict, kw_only=True):
    """One traced point over time."""

    body: str
    x: Series
    y: Series
    z: Series
    vx: Series
    vy: Series
    vz: Series
    ax: Series
    ay: Series
    az: Series


class Motion3(Strict, kw_only=True):
    """Motion of one mechanism in space: its data.json."""

    schema: Literal["mbsd.motion"] = "mbsd.motion"
    schema_version: Literal[4] = 4
    space: Literal[3] = 3
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(UNITS))
    conventions: dict[str, str] = msgspec.field(default_factory=lambda: dict(CONVENTIONS3))
    provenance: Provenance
    gravity: Vector3
    analysis: Literal["sweep", "simulation"]
    period: Positive | None
    """Every pose repeats after this time (s), and ``time`` spans it exactly, both ends included; else null."""
    time: Series
    bodies: dict[str, BodyMotion3]
    joints: dict[str, JointMotion3]
    drivers: dict[str, DriverMotion3]
    points: dict[str, PointMotion3]
    forces: dict[str, ForceMotion3] = {}
    energy: Energy
    events: list[EventMark] = []
    start_changes: list[str] = []
    notes: list[str] = []
    diagnostics: Diagnostics


def columns(struct: msgspec.Struct, *names: str) -> Array:
    """Return the series of these names by column (T, n)."""
    import numpy as np

    return np.stack([np.asarray(getattr(struct, name), float) for name in names], axis=1)


def refuse_unsound_space(motion: Motion3, path: Path | str) -> None:
    """Raise UserError for quaternions and axes that are no units, and quaternions whose signs jump."""
    import numpy as np

    for name, body in motion.bodies.items():
        q = body.quaternion
        _refuse_not_unit(q, f"{path}: bodies.{name}: the quaternion (qw, qx, qy, qz)")
        jumps = np.flatnonzero((q[1:] * q[:-1]).sum(axis=1) < 0.0)
        if len(jumps):
            raise UserError(
                f"{path}: bodies.{name}: the quaternion changes its sign or turns by more than half a turn between "
                f"rows {jumps[0]} and {jumps[0] + 1}; signs go on from row to row, and rows lie closer together"
            )
        xx, yy, zz, xy, xz, yz = body.inertia
        moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        if moments[0] < -UNIT_TOLERANCE * max(abs(moments)):
            raise UserError(f"{path}: bodies.{name}.inertia has a negative principal moment ({moments[0]:.4g} kg m^2)")
    for name, force in motion.forces.items():
        if not force.rows and None in (force.fx, force.fy, force.fz, force.mx, force.my, force.mz):
            raise UserError(f"{path}: forces.{name}.rows is empty, and there is no wrench (fx to mz) in its place")
    for name, joint in motion.joints.items():
        _refuse_not_unit(columns(joint, "ux", "uy", "uz"), f"{path}: joints.{name}: the axis (ux, uy, uz)")
    for field, element in _with_markers(motion):
        for index, marker in enumerate(element.markers):
            where = f"{path}: {field}.markers[{index}]"
            _refuse_not_unit(np.array([marker.axis]), f"{where}.axis")
            _refuse_not_unit(np.array([marker.across]), f"{where}.across")
            lean = math.sumprod(marker.axis, marker.across)
            if abs(lean) > UNIT_TOLERANCE:
                raise UserError(f"{where}: axis and across are at a cosine of {lean:.3g}; they must be perpendicular")


def _with_markers(motion: Motion3) -> Iterator[tuple[str, JointMotion3 | ForceMotion3]]:
    yield from ((f"joints.{name}", joint) for name, joint in motion.joints.items())
    yield from ((f"forces.{name}", force) for name, force in motion.forces.items())


def _refuse_not_unit(vectors: Array, what: str) -> None:
    import numpy as np

    lengths = np.linalg.norm(vectors, axis=1)
    worst = int(np.argmax(np.abs(lengths - 1.0)))
    if not abs(lengths[worst] - 1.0) <= UNIT_TOLERANCE:
        row = f" in row {worst}" if len(vectors) > 1 else ""
        raise UserError(f"{what} has the length {lengths[worst]:.9g}{row}; it must be 1")
