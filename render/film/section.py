"""Sections: hatches, and the plane that cuts a machine."""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from render.film.scene import Colour, Plane, Point
from render.film.solids import prism, read_corners
from shared.contract import Motion, Parts, Piece
from shared.contract.shot import Section
from shared.stage.errors import UserError

# Hatches of cut faces: stripes in light and dark of a piece's colour, which lean otherwise than its neighbours'.

STRIPE = 0.05
"""Width of a light and a dark stripe, as a part of the machine's radius."""
LIGHT = 0.55
"""Part of that which is light."""
MATT = 0.7
"""Roughness of a cut face."""


class Hatch(NamedTuple):
    """Stripes across a ``way``: a point is in the light as long as (point . way / period) mod 1 < LIGHT."""

    way: Point
    period: float
    """In radii of the machine."""


def hatch_of(name: str, plane: Plane) -> Hatch:
    """Return the hatch of a piece, ``body/piece``, in a plane along z or across it.

    Slope and width follow its name.
    """
    x, y, z, _ = plane
    kind = zlib.crc32(name.encode()) % 4
    lean = -1.0 if kind % 2 else 1.0
    way = (1.0, lean, 0.0) if z else (-y, x, lean)  # in a face that stands up, along it and z
    return Hatch(way, STRIPE * (1 + kind // 2 / 3))


def light_of(colour: Colour) -> Colour:
    """Return the light tone of a cut face (linear RGB)."""
    red, green, blue = (0.5 * part + 0.32 for part in colour)
    return red, green, blue


def dark_of(colour: Colour) -> Colour:
    """Return the dark tone of a cut face (linear RGB)."""
    red, green, blue = (0.3 * part + 0.015 for part in colour)
    return red, green, blue


# A section: what is beyond a plane, or beyond several at once, is cut away; a quarter has two.
#
# Bodies of a planar machine turn about the normal of its plane alone, so a plane across that normal cuts each of them
# in the same way at every moment. Other planes cut what stands still, as in a model of an engine in a museum; bodies
# that are named are cut as they stand at the start of the motion, and carry their cut with them. Planes that are fixed
# stay where they are instead: what moves through them has another cut at every moment, what moves along them has the
# same. Springs, ropes and belts hang between bodies, and are cut where all that moves is.

Array = NDArray[np.float64]
Key = tuple[str, str]
"""Body and piece."""
Normal = tuple[float, float, float]
Pose = tuple[float, float, float]
"""x, y (m) and theta (rad) of a body."""
WAYS: dict[str, Normal] = {
    "front": (0.0, 0.0, 1.0),
    "right": (1.0, 0.0, 0.0),
    "left": (-1.0, 0.0, 0.0),
    "above": (0.0, 1.0, 0.0),
    "below": (0.0, -1.0, 0.0),
}
"""Direction from the machine's inside to a side of a Section, in the axes of the motion."""
ASIDE = 32.0
"""Azimuth (degrees) from which on a face that looks to the side is seen well."""
STILL = 1e-9
"""Bodies that move less than this along a plane's normal (m), and turn less (rad), have the same cut all the time."""


@dataclass(frozen=True)
class Cut:
    """The cut of a piece: beyond all ``planes`` of its body's frame, or where ``fixed`` of the world.

    ``gone`` is one of which nothing is ever left.
    """

    planes: tuple[Plane, ...] = ()
    fixed: bool = False
    gone: bool = False


WHOLE = Cut()


def section_of(section: Section | float) -> Section:
    """Return the wish of a shot as a Section; a number is a part of the depth, from the front."""
    return section if isinstance(section, Section) else Section(front=section)


def cuts_of(parts: Parts, asked: Section | float, folder: Path, motion: Motion | None) -> dict[Key, Cut]:
    """Return the cut of each piece that is cut at all.

    ``motion`` gives the poses of bodies and what they go through.

    Raises UserError for a section that cuts no piece open.
    """
    depths, solids, planes = _planned(parts, section_of(asked), folder, motion)
    if not depths:
        return {}
    out = {solid.key: solid.cut(planes) for solid in solids if all(solid.reach(n)[1] > d for n, d in planes)}
    if all(cut.gone for cut in out.values()):
        raise UserError(_nothing(parts.mechanism, asked, solids, depths))
    return out


def between_bodies(parts: Parts, asked: Section | float, folder: Path, motion: Motion | None) -> tuple[Plane, ...]:
    """Return the planes of the world beyond all of which springs, ropes and belts are cut away.

    They are those of a section that cuts everything that moves where it is, from the front or by fixed planes; there
    are none for one that names its pieces.
    """
    section = section_of(asked)
    if section.only or not (section.fixed or section == Section(front=section.front)):
        return ()
    _, _, planes = _planned(parts, section, folder, motion)
    return tuple((*normal, place) for normal, place in planes)


def _planned(
    parts: Parts, section: Section, folder: Path, motion: Motion | None
) -> tuple[dict[str, float], list[_Solid], list[tuple[Normal, float]]]:
    """Return sides with their parts, the solids that they may cut, and a plane for each."""
    depths = {side: getattr(section, side) for side in WAYS if getattr(section, side)}
    if not depths:
        return depths, [], []
    moves = section.fixed and set(depths) != {"front"}
    solids = [
        _Solid(key, piece, folder, _poses(motion, key[0], moves)) for key, piece in _cut(parts, section, depths, moves)
    ]
    return depths, solids, [_plane(WAYS[side], part, solids) for side, part in depths.items()]


def seen_from(section: Section | float, azimuth: float) -> float:
    """Return the azimuth (degrees) that shows the cut faces of a machine seen from another one."""
    asked = section_of(section)
    return max(azimuth, ASIDE) if asked.right else min(azimuth, -ASIDE) if asked.left else azimuth


def in_body(plane: Plane, pose: Pose) -> Plane:
    """Return a plane of the world in the frame of a body that stands there."""
    (x, y, z, place), (u, v, theta) = plane, pose
    c, s = math.cos(theta), math.sin(theta)
    return c * x + s * y, c * y - s * x, z, place - x * u - y * v


class _Solid:
    """A piece in some poses of its body (n, 3): where it stands at the start of the motion, or all of it."""

    def __init__(self, key: Key, piece: Piece, folder: Path, poses: Array) -> None:
        self.key, self._piece, self._file, self._poses = key, piece, folder / piece.stl, poses
        self._reach: dict[Normal, tuple[float, float]] = {}

    def reach(self, normal: Normal) -> tuple[float, float]:
        """Return the least and largest place along a normal of the world (m)."""
        if normal == WAYS["front"]:
            return self._piece.z_range
        if normal not in self._reach:
            self._reach[normal] = self._swept(normal)
        return self._reach[normal]

    def cut(self, planes: list[tuple[Normal, float]]) -> Cut:
        """Return the cut by these planes of the world, each a normal and how far along it."""
        gone = all(self.reach(normal)[0] >= place for normal, place in planes)
        world = tuple((*normal, place) for normal, place in planes)
        if self._goes_through(planes):
            return Cut(world, True, gone)
        u, v, theta = (float(value) for value in self._poses[0])
        return Cut(tuple(in_body(plane, (u, v, theta)) for plane in world), False, gone)

    def _swept(self, normal: Normal) -> tuple[float, float]:
        (u, v, theta), (x, y, _) = self._poses.T, normal
        c, s = np.cos(theta), np.sin(theta)
        least, most = self._extents(np.stack([c * x + s * y, c * y - s * x], axis=1))
        along = u * x + v * y
        return float((along + least).min()), float((along + most).max())

    def _extents(self, ways: Array) -> tuple[Array, Array]:
        """Return the least and largest place (n,) of its outline along ways (n, 2) of its body (m)."""
        rolls = self._piece.rolls
        if rolls is not None and len(self._poses) > 1:  # it turns against its body
            centre = np.array([rolls.x, rolls.y])
            radius = float(np.linalg.norm(self._outline - centre, axis=1).max())
            return ways @ centre - radius, ways @ centre + radius
        along = ways @ self._outline.T
        return along.min(axis=1), along.max(axis=1)

    @cached_property
    def _outline(self) -> Array:
        """Corners (n, 2) of its convex outline in the plane of the motion (m)."""
        corners = prism(read_corners(self._file))[:, :2]
        return corners[: len(corners) // 2]

    def _goes_through(self, planes: list[tuple[Normal, float]]) -> bool:
        """Return True if its cut is another one at other moments."""
        u, v, theta = self._poses.T
        if len(self._poses) == 1 or all(normal == WAYS["front"] for normal, _ in planes):
            return False
        turns = np.ptp(theta) > STILL or self._piece.rolls is not None
        return turns or any(np.ptp(u * x + v * y) > STILL for (x, y, _), _ in planes)


def _cut(parts: Parts, section: Section, depths: dict[str, float], moves: bool) -> Iterator[tuple[Key, Piece]]:
    """Return the pieces that are cut.

    They are those that are named; else all from the front, or by planes through which bodies move, and from other sides
    what stands still.

    Raises UserError where nothing stands still.
    """
    every = [((body, name), piece) for body, solids in parts.bodies.items() for name, piece in solids.pieces.items()]
    if section.only:
        named = [(key, piece) for key, piece in every if {key[0], "/".join(key)} & set(section.only)]
        return iter(named)
    if moves or set(depths) == {"front"}:
        return iter(every)
    still = [(key, piece) for key, piece in every if key[0] == "ground"]
    if not still:
        raise UserError(
            f"{parts.mechanism}: shot.section cuts from {' and '.join(depths)} what stands still; ground "
            f"has no solids; name bodies in section.only: {', '.join(parts.bodies)}, or say fixed=True"
        )
    return iter(still)


def _plane(normal: Normal, part: float, solids: list[_Solid]) -> tuple[Normal, float]:
    """Return a plane with this normal, beyond which the ``part`` of the reach of all pieces is."""
    reaches = [solid.reach(normal) for solid in solids]
    low, high = min(low for low, _ in reaches), max(high for _, high in reaches)
    return normal, high - part * (high - low)


def _poses(motion: Motion | None, body: str, whole: bool) -> Array:
    """Return where a body stands (n, 3): at the start, or over the ``whole`` motion."""
    if motion is None or body not in motion.bodies:
        return np.zeros((1, 3))
    moved = motion.bodies[body]
    poses = np.stack([np.asarray(part, float) for part in (moved.x, moved.y, moved.theta)], axis=1)
    return poses if whole else poses[:1]


def _nothing(mechanism: str, asked: Section | float, solids: list[_Solid], depths: dict[str, float]) -> str:
    """Return the error for a section that cuts nothing, with the middles of pieces from each side."""
    words = []
    for side in depths:
        reaches = [solid.reach(WAYS[side]) for solid in solids]
        low, high = min(low for low, _ in reaches), max(high for _, high in reaches)
        middles = sorted({round((high - (a + b) / 2) / max(high - low, 1e-12), 2) for a, b in reaches})
        said = ", ".join(f"{part:g}" for part in middles[:12])
        words.append(said if not isinstance(asked, Section) else f"{said} from {side}")
    value = f"{asked:g}" if not isinstance(asked, Section) else ", ".join(f"{k}={v:g}" for k, v in depths.items())
    return (
        f"{mechanism}: shot.section = {value} cuts no piece open; the middles of its pieces are at {'; '.join(words)}"
    )
