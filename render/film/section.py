"""A section: what is beyond a plane, or beyond several at once, is cut away; a quarter has two.

Bodies of a planar machine turn about the normal of its plane alone, so a plane across that normal cuts each of them in
the same way at every moment. Other planes cut what stands still, as in a model of an engine in a museum; bodies that
are named are cut as they stand at the start of the motion, and carry their cut with them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render.film.scene import Plane
from render.film.solids import read_corners
from shared.contract import Motion, Parts, Piece
from shared.contract.shot import Section
from shared.stage.errors import UserError

Array = NDArray[np.float64]
Key = tuple[str, str]
"""Body and piece."""
WAYS: dict[str, tuple[float, float, float]] = {
    "front": (0.0, 0.0, 1.0),
    "right": (1.0, 0.0, 0.0),
    "left": (-1.0, 0.0, 0.0),
    "above": (0.0, 1.0, 0.0),
    "below": (0.0, -1.0, 0.0),
}
"""From the machine's inside to where a side of a Section is, in the axes of the motion."""


def section_of(section: Section | float) -> Section:
    """What a shot says as a Section; a number is a part of the depth, from the front."""
    return section if isinstance(section, Section) else Section(front=section)


def planes_of(
    parts: Parts, asked: Section | float, folder: Path, motion: Motion | None
) -> dict[Key, tuple[Plane, ...]]:
    """The planes beyond all of which a piece is cut away, in its body's frame, for each piece that is cut at all.

    ``motion`` is asked where bodies stand that are named. Raises UserError for a section that cuts no piece open.
    """
    section = section_of(asked)
    depths = {side: getattr(section, side) for side in WAYS if getattr(section, side)}
    if not depths:
        return {}
    solids = [_Solid(key, piece, folder, _pose(motion, key[0])) for key, piece in _cut(parts, section, depths)]
    planes = [_plane(WAYS[side], part, solids) for side, part in depths.items()]
    out = {solid.key: solid.own(planes) for solid in solids if all(solid.reach(n)[1] > d for n, d in planes)}
    opened = [solid for solid in solids if solid.key in out and not solid.is_beyond(planes)]
    if not opened:
        raise UserError(_nothing(parts.mechanism, asked, solids, depths))
    return out


def is_gone(piece: Piece, planes: tuple[Plane, ...], folder: Path) -> bool:
    """Whether all of a piece is beyond its planes."""
    corners = read_corners(folder / piece.stl) if any(x or y for x, y, _, _ in planes) else _heights(piece)
    return all(bool((corners @ np.array(plane[:3]) >= plane[3]).all()) for plane in planes)


class _Solid:
    """A piece where it stands at the start of the motion."""

    def __init__(self, key: Key, piece: Piece, folder: Path, pose: tuple[float, float, float]) -> None:
        self.key, self._piece, self._file = key, piece, folder / piece.stl
        self._x, self._y, self._theta = pose

    def reach(self, normal: tuple[float, float, float]) -> tuple[float, float]:
        """Least and largest place along a normal of the world (m)."""
        if normal == WAYS["front"]:
            return self._piece.z_range
        (x, y, z, _) = self._in_body(normal, 0.0)
        along = read_corners(self._file) @ np.array([x, y, z]) + normal[0] * self._x + normal[1] * self._y
        return float(along.min()), float(along.max())

    def is_beyond(self, planes: list[tuple[tuple[float, float, float], float]]) -> bool:
        """Whether all of it is beyond all planes."""
        return all(self.reach(normal)[0] >= place for normal, place in planes)

    def own(self, planes: list[tuple[tuple[float, float, float], float]]) -> tuple[Plane, ...]:
        """The planes in the frame of its body."""
        return tuple(self._in_body(normal, place) for normal, place in planes)

    def _in_body(self, normal: tuple[float, float, float], place: float) -> Plane:
        x, y, z = normal
        c, s = math.cos(self._theta), math.sin(self._theta)
        return c * x + s * y, c * y - s * x, z, place - x * self._x - y * self._y


def _cut(parts: Parts, section: Section, depths: dict[str, float]) -> Iterator[tuple[Key, Piece]]:
    """The pieces that are cut: those that are named; else all from the front, and from other sides what stands still.

    Raises UserError where nothing stands still.
    """
    every = [((body, name), piece) for body, solids in parts.bodies.items() for name, piece in solids.pieces.items()]
    if section.only:
        named = [(key, piece) for key, piece in every if {key[0], "/".join(key)} & set(section.only)]
        return iter(named)
    if set(depths) == {"front"}:
        return iter(every)
    still = [(key, piece) for key, piece in every if key[0] == "ground"]
    if not still:
        raise UserError(
            f"{parts.mechanism}: shot.section cuts from {' and '.join(depths)}, which is what stands still, and ground "
            f"has no solids; name bodies in section.only: {', '.join(parts.bodies)}"
        )
    return iter(still)


def _plane(
    normal: tuple[float, float, float], part: float, solids: list[_Solid]
) -> tuple[tuple[float, float, float], float]:
    """A plane with this normal, beyond which the ``part`` of the reach of all pieces is."""
    reaches = [solid.reach(normal) for solid in solids]
    low, high = min(low for low, _ in reaches), max(high for _, high in reaches)
    return normal, high - part * (high - low)


def _pose(motion: Motion | None, body: str) -> tuple[float, float, float]:
    if motion is None or body not in motion.bodies:
        return 0.0, 0.0, 0.0
    moved = motion.bodies[body]
    return moved.x[0], moved.y[0], moved.theta[0]


def _heights(piece: Piece) -> Array:
    return np.array([[0.0, 0.0, height] for height in piece.z_range])


def _nothing(mechanism: str, asked: Section | float, solids: list[_Solid], depths: dict[str, float]) -> str:
    """What is wrong, and where the middles of pieces are from each side."""
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
