"""A scene in plain data: solids, materials and lights. No Blender here; render/blender/ translates it.

Metres and radians. A Scene is what stays the same over the film, a State is what one frame changes.
"""

from __future__ import annotations

from typing import Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.framing import CameraPose
from render.looks import Look
from shared.contract.parts import Z
from shared.contract.signals import Head

Colour = tuple[float, float, float]
Point = tuple[float, float, float]
Pose = tuple[float, float, float, float, float, float, float]
"""x, y, z (m) of a body's frame, and its unit quaternion (w, x, y, z) from body to world."""
Plane = tuple[float, float, float, float]
"""A unit normal, and how far along it the plane is (m)."""
Hidden = Literal["", "trails", "all"]


class SurfaceSpec(msgspec.Struct, kw_only=True, frozen=True):
    """How a piece looks.

    ``finish`` names a shader of render/blender/scene/materials.py; ``flat`` emits its colour alone.
    """

    colour: Colour
    finish: str
    roughness: float
    turned: tuple[float, float] | None = None
    """Axis (x, y of the body's frame, m) round which streaks of brushed metal go; null if they go lengthwise."""


class PieceSpec(msgspec.Struct, kw_only=True, frozen=True):
    """One solid of a body; the STL is in millimetres, in the body's frame."""

    body: str
    name: str
    stl: str
    sha256: str
    surface: SurfaceSpec
    turns_about: tuple[float, float] | None = None
    """x, y of the axis (m) about which it turns against its body; the States have its pose as ``body/name``."""
    cut: tuple[Plane, ...] = ()
    """Planes of the body's frame beyond all of which a section has cut it away."""
    fixed: bool = False
    """True if these are planes of the world instead, through which the piece moves."""


class TrailSpec(msgspec.Struct, kw_only=True, frozen=True):
    """A fading tube of so many rings.

    Its path is in every State, from the point back to the end of the tail.
    """

    name: str
    colour: Colour
    strength: float
    """Strength of the light, times the colour."""
    radius: float
    rings: int


class LabelSpec(msgspec.Struct, kw_only=True, frozen=True):
    """A text that faces the camera; its place is in every State."""

    text: str
    size: float
    colour: Colour


class TubeSpec(msgspec.Struct, kw_only=True, frozen=True):
    """A round wire, rod or rope along a path of so many points, which is in every State."""

    name: str
    surface: SurfaceSpec
    radius: float
    points: int
    cut: tuple[Plane, ...] = ()
    """Planes of the world beyond all of which a section has cut it away."""


class ArrowSpec(msgspec.Struct, kw_only=True, frozen=True):
    """A vector that changes: a thin shaft with a cone, drawn over the parts.

    Tail and tip are in every State. ``colour`` is what the picture has (sRGB 0..1), ``shaft`` and ``head`` are radii,
    ``point`` the cone's length.
    """

    name: str
    colour: Colour
    shaft: float
    head: float
    point: float
    tip: Head = "solid"


class ArcSpec(msgspec.Struct, kw_only=True, frozen=True):
    """A torque that changes: a curved arrow about its centre.

    The centre is in every State with its sweep (rad) and its axis. ``colour`` as of an arrow; ``radius`` is that of
    the arc, ``shaft`` and ``head`` radii of the tube and its cone, ``point`` the cone's length.
    """

    name: str
    colour: Colour
    radius: float
    shaft: float
    head: float
    point: float


STEEP = 0.98
"""Cosine to the y axis above which an axis takes the x axis for its plane."""


def across_axes(axes: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return x and y axes (n, 3) of planes normal to unit vectors (n, 3): of z those of the world.

    The y axis points away from a camera in front, as far as it can.
    """
    away = np.array([0.0, 1.0, 0.0]) - axes[:, 1, None] * axes
    steep = np.abs(axes[:, 1]) > STEEP
    away[steep] = np.array([1.0, 0.0, 0.0]) - axes[steep, 0, None] * axes[steep]
    y = away / np.linalg.norm(away, axis=1, keepdims=True)
    return np.cross(y, axes), y


class LegendRow(msgspec.Struct, kw_only=True, frozen=True):
    """A reference arrow: meaning of ``number``, and its tip, in parts of the picture's width.

    The tip may be an arc (rad).
    """

    number: str
    words: str
    colour: Colour
    length: float = 0.0
    point: float = 0.0
    sweep: float = 0.0
    tip: Head = "solid"


ARC = 0.6
"""Radius of an arc of the legend, in heights of its letters."""


class LineSpec(msgspec.Struct, kw_only=True, frozen=True):
    """A line of words, or of a number that is in every State.

    Its upper left corner, its width and the height of its letters are in parts of the picture's shorter side.
    """

    words: str
    x: float
    y: float
    width: float
    size: float
    bold: bool = False
    quiet: bool = False


class Card(msgspec.Struct, kw_only=True, frozen=True):
    """The card of a legend, in parts of the picture's shorter side.

    It has its upper left corner, width and height, the height of its letters; from its edges the first row, the end of
    the arrows, the start of numbers and of words; and the distance from row to row.
    """

    left: float
    top: float
    wide: float
    high: float
    size: float
    pad: float
    row: float
    arrows: float
    numbers: float
    words: float


class Writing(msgspec.Struct, kw_only=True, frozen=True):
    """Text over the picture: lines at the upper left, a legend on its card."""

    lines: list[LineSpec] = []
    legend: list[LegendRow] = []
    card: Card | None = None
    on_bright: bool = False
    """Lines are dark on what is bright, instead of bright on what is dark."""


class StudioSpec(msgspec.Struct, kw_only=True, frozen=True):
    """Backdrop and lights, sized by the swept motion: its middle, its radius, the floor's height.

    They are in the studio's axes (right, away, up); ``up`` is the unit vector of the world that points up.
    """

    look: Look
    centre: Point
    radius: float
    floor: float
    azimuth: float
    reach: tuple[float, float] = (0.0, 0.0)
    """Reach of everything from the middle, to right and left and away, as the camera stands (m)."""
    wall: float | None = None
    """Distance, in the studio's axes, of the wall at which the machine hangs; null if it hangs at none."""
    up: Point = Z


class Scene(msgspec.Struct, kw_only=True, frozen=True):
    """The scene: all that stays the same over the film."""

    mechanism: str
    fps: int
    pieces: list[PieceSpec]
    trails: list[TrailSpec]
    labels: list[LabelSpec]
    studio: StudioSpec
    tubes: list[TubeSpec] = []
    arrows: list[ArrowSpec] = []
    arcs: list[ArcSpec] = []
    writing: Writing = Writing()


class State(msgspec.Struct, kw_only=True, frozen=True):
    """The state of one frame: poses of all bodies; paths, places, arrows, the camera."""

    bodies: dict[str, Pose]
    trails: list[list[Point]]
    labels: list[Point]
    camera: CameraPose
    tubes: list[list[Point]] = []
    arrows: list[tuple[Point, Point]] = []
    arcs: list[tuple[Point, float, Point]] = []
    number: str = ""
    """The number that lives, beside the title."""
    lifts: dict[str, float] = {}
    """Lift along z (m) by ``body/piece``; pieces that are not named are where they belong."""
    hidden: Hidden = ""
    """Hidden objects: trails, or all but the solids (trails, tubes, labels)."""
