"""Shapes of bodies: plates round their eyes, rods, yokes, and bodies joined of several plates."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.items import Heights, Item, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan
from mechanisms.stages.automatic.layout.planar import Rounded, convex_hull
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.kernel import first_sound
from shared.shapes.link import Eye, link, plate_link, with_eyes
from shared.shapes.outline import Point, hull_holds, inset_corners
from shared.shapes.solid import placed

# The plate of a body: a bar between two eyes, a plate round more of them, by what outline its eyes have (rmm).

type PlacedEye = tuple[float, float, Eye]

EDGES = (0.8, 0.3, 0.0)
"""Radii of a plate's rounded edges; the largest that the CAD kernel manages is taken."""
SLIM = 2.0
"""A plate lower than this many radii of its eyes gets straight sides and no window."""
BANDS = (0.6, 0.7, 0.85, 1.0)
"""Widths of the band round a window, in radii of the largest eye; the first that leaves the eyes their wall is taken.
"""
WIDENINGS = 24
"""How often the sides at an eye may get wider for its wall."""
EYE_WALL = 0.85
"""Width of a plate that stays round an eye, in its radii."""
LEAST_WINDOW = 6.0
CORNER = 2.5


def body_shape(eyes: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """Return the plate from z = 0 up, in the body's frame, and its number of through holes."""
    points = np.array([[x, y] for x, y, _ in eyes])
    if len(eyes) == 1:
        return _round(eyes[0], [], thickness), int(eyes[0][2].bore > 0)
    bores = sum(eye.bore > 0 for _, _, eye in eyes)
    hull = convex_hull(points, 1e-4)
    corners = _outermost([int(np.argmin(np.linalg.norm(points - corner, axis=1))) for corner in hull], eyes)
    inner = [eye for k, eye in enumerate(eyes) if k not in corners]
    if len(corners) == 1:
        return _round(eyes[corners[0]], inner, thickness), bores
    if len(corners) == 2:
        return _bar([eyes[k] for k in corners], inner, thickness), bores
    shape, windows = _plate([eyes[k] for k in corners], inner, thickness)
    return shape, bores + windows


def _outermost(corners: list[int], eyes: list[PlacedEye]) -> list[int]:
    """Return the corners whose eyes lie in no other eye and not in the hull of the others, in order."""
    circles = {k: (eyes[k][0], eyes[k][1], eyes[k][2].radius) for k in corners}
    for k in corners:
        if any(hull_holds([circle], circles[k]) for other, circle in circles.items() if other != k):
            del circles[k]
    for k in list(circles):  # a hull is one of circles of which none holds another
        others = [circle for other, circle in circles.items() if other != k]
        if len(others) > 1 and hull_holds(others, circles[k]):
            del circles[k]
    return list(circles)


def _round(eye: PlacedEye, inner: list[PlacedEye], thickness: float) -> cq.Workplane:
    """Return a plate that one eye fills."""
    x, y, own = eye
    return plate_link([eye, (x, y + 0.5 * own.radius, Eye(own.radius, 0.0))], thickness, inner=inner)


def _bar(ends: list[PlacedEye], inner: list[PlacedEye], thickness: float) -> cq.Workplane:
    """Return a waisted bar with I section where it is long enough, else one with straight sides."""
    (x0, y0, start), (x1, y1, end) = ends
    length, turn = math.hypot(x1 - x0, y1 - y0), math.atan2(y1 - y0, x1 - x0)
    c, s = math.cos(turn), math.sin(turn)
    beside = [((x - x0) * c + (y - y0) * s, (y - y0) * c - (x - x0) * s, eye) for x, y, eye in inner]
    widths = 1.28 * start.radius, 1.28 * end.radius
    straight = [(0.0, 0.0, start), (length, 0.0, end)]
    ways: list[Callable[[], cq.Workplane]] = []
    if all(eye.bore > 0 for _, _, eye in beside):
        pockets = (2.2, 0.0) if length - start.radius - end.radius > 22.0 and not inner else (0.0,)
        for fillet, pocket in [(12.0, pocket) for pocket in pockets] + [(7.0, 0.0), (3.0, 0.0)]:
            ways.append(partial(link, length, thickness, start, end, widths, fillet, pocket=pocket, inner=beside))
    ways += [partial(plate_link, straight, thickness, inner=beside, edge=edge) for edge in EDGES]
    return placed(first_made(ways), x0, y0, turn=math.degrees(turn))


def first_made(ways: Sequence[Callable[[], cq.Workplane]]) -> cq.Workplane:
    """Return the first shape that has room and that the CAD kernel can make; the last one must."""
    made = first_sound(ways[:-1])
    return ways[-1]() if made is None else made


def _plate(corners: list[PlacedEye], inner: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """Return a plate with curved or straight sides, and its number of windows.

    Sides are curved, with a window, where it is wide.
    """
    points = np.array([[x, y] for x, y, _ in corners])
    sides = np.roll(points, -1, axis=0) - points
    lengths = np.linalg.norm(sides, axis=1)
    away = points[None] - points[:, None]
    heights = np.abs(sides[:, None, 0] * away[:, :, 1] - sides[:, None, 1] * away[:, :, 0]).max(axis=1) / lengths
    if inner or heights.min() < SLIM * max(eye.radius for _, _, eye in corners):
        return first_made([partial(plate_link, corners, thickness, inner=inner, edge=edge) for edge in EDGES]), 0
    waist = 2.0 * float(lengths.max())
    rims = _rims(corners, points, lengths, waist)
    curved = [partial(plate_link, corners, thickness, waist=waist, rims=rims, edge=edge) for edge in EDGES]
    straight = [partial(plate_link, corners, thickness, edge=edge) for edge in EDGES]
    made = first_sound(curved)
    if made is None:  # sides that curve inwards may cross each other
        return first_made(straight), 0
    return made, int(rims is not None)


def _rims(corners: list[PlacedEye], points: np.ndarray, lengths: np.ndarray, waist: float) -> list[float] | None:
    """Return insets of the window's sides that leave an even band round it and enough round each eye.

    None if it is too small.
    """
    radii = np.array([eye.radius for _, _, eye in corners])
    edge = (radii + np.roll(radii, -1)) / 2 - lengths**2 / (8 * waist)  # of the plate, from the line of two joints
    for band in BANDS:
        rims = np.maximum(band * radii.max() - edge, 0.15 * radii.max())
        for _ in range(WIDENINGS):
            tips = inset_corners([(float(x), float(y)) for x, y in points], (rims + CORNER).tolist())
            if tips is None or np.linalg.norm(np.roll(tips, -1, axis=0) - tips, axis=1).min() < LEAST_WINDOW:
                break
            apart = np.linalg.norm(tips[:, None] - points[None], axis=2) - CORNER - EYE_WALL * radii
            near = apart.min(axis=0) < 0
            if not near.any():
                return rims.tolist()
            rims = rims + 0.5 * (near | np.roll(near, -1))  # the two sides that meet at an eye
    return None


# The plate of a rod: a slim straight shaft between two eyes (rmm).

ROD_WIDTH = 0.85
"""Width of its shaft in radii of its eyes."""


def rod_shape(eyes: list[PlacedEye], thickness: float) -> tuple[cq.Workplane, int]:
    """Return a slim straight shaft between two eyes, from z = 0 up, and its number of through holes."""
    (_, _, start), (length, _, end) = sorted(eyes, key=lambda eye: eye[0])
    widths = ROD_WIDTH * start.radius, ROD_WIDTH * end.radius
    straight: list[tuple[float, float, Eye]] = [(0.0, 0.0, start), (length, 0.0, end)]
    ways = [partial(link, length, thickness, start, end, widths, fillet, edge=1.2) for fillet in (8.0, 4.0)]
    return first_made([*ways, *(partial(plate_link, straight, thickness, edge=edge) for edge in EDGES)]), 2


# The plate of a body with a slot and one or two more places beside it: a T, its corners filled by arcs (rmm).
#
# in its own axes: the slot's middle at (0, 0), the slot along y; the nearer of the other places at (h, e)
#
#              |  |
#              |   \________
#              |    ________(o==o)     an arm of half width w, arcs of radius up to FILLET where it meets the wall
#              |   /
#              |  |

ARM = 0.64
"""Half of the arm's width in radii of its eye."""
FILLET, END_FILLET = 24.0, 8.0
"""Radii where the arm meets the wall of the slot, and where it meets its eye."""
LONG = 2.4
"""The other places are so many radii of the slot's wall away at least; a nearer one gets a plate without an arm."""


@dataclass(frozen=True)
class _Yoke:
    """A slot's half travel and wall radius; the other eyes (x, y, radius), the nearest first (rmm)."""

    half: float
    wall: float
    others: list[tuple[float, float, float]]

    @property
    def arm(self) -> float:
        """Half of its width."""
        return ARM * self.others[0][2]

    @property
    def has_room(self) -> bool:
        """True if the arm meets the slot between its ends, and all other places are well away from it."""
        return self.others[0][0] >= LONG * self.wall and abs(self.others[0][1]) + self.arm <= self.half

    def flat(self, thickness: float, edge: float) -> cq.Workplane:
        """Return the wall of the slot, arm and filled corners, with rounded edges."""
        (h, e, end), w = self.others[0], self.arm
        shape = extruded(outline.hull([(0.0, -self.half, self.wall), (0.0, self.half, self.wall)]), thickness)
        arm = extruded(outline.bar(h, (self.wall, end), (2 * w, 2 * w), END_FILLET), thickness)
        shape = shape.union(placed(arm, 0.0, e))
        if len(self.others) == 2:
            shape = shape.union(extruded(outline.hull(self.others), thickness))
        for side in (1.0, -1.0):
            radius = min(FILLET, self.half - w - side * e, h - self.wall - end - END_FILLET)
            if radius > 0.5:
                shape = shape.union(self._corner(radius, side, thickness))
        return eased(shape.clean(), edge)

    def _corner(self, radius: float, side: float, thickness: float) -> cq.Workplane:
        """Return the fillet in the corner of wall and arm, above the arm (side 1) or below it (-1)."""
        e, w, far = self.others[0][1], self.arm, self.wall + radius
        low, high, inside = e + side * w, e + side * (w + radius), e + side * w / 2  # overlaps the arm
        middle = far - radius * math.sqrt(0.5), high - side * radius * math.sqrt(0.5)
        sketch = cq.Workplane().moveTo(0.0, inside).lineTo(0.0, high).lineTo(self.wall, high)
        sketch = sketch.threePointArc(middle, (far, low)).lineTo(far, inside).close()
        return sketch.extrude(thickness)


def yoke_shape(eyes: list[PlacedEye], ends: list[tuple[float, float]], thickness: float) -> cq.Workplane | None:
    """Return the plate from z = 0 up, in the body's frame.

    ``ends`` are the middles of the slot's ends, an eye at each.

    None where other eyes than one or two are beside the slot, or these lie so that a T is no better than a plate.
    """
    walls = [eye for eye in eyes if any(math.dist(eye[:2], end) < 0.01 for end in ends)]
    others = [eye for eye in eyes if eye not in walls]
    if len(walls) != 2 or len(others) not in (1, 2):
        return None
    first, second = np.array(walls[0][:2]), np.array(walls[1][:2])
    middle, along = (first + second) / 2, second - first
    half = float(np.hypot(*along)) / 2
    across = np.array([along[1], -along[0]]) / (2 * half)
    across *= math.copysign(1.0, float((np.array(others[0][:2]) - middle) @ across))
    up = np.array([-across[1], across[0]])
    local = [
        (float(away @ across), float(away @ up), eye) for x, y, eye in others for away in [np.array([x, y]) - middle]
    ]
    local.sort(key=lambda place: place[0])
    wall = min(walls[0][2].radius, walls[1][2].radius)
    yoke = _Yoke(half, wall, [(x, y, eye.radius) for x, y, eye in local])
    if not yoke.has_room:
        return None
    shape = with_eyes(first_made([partial(yoke.flat, thickness, edge) for edge in EDGES]), local, thickness, EDGES[0])
    return placed(shape, float(middle[0]), float(middle[1]), turn=math.degrees(math.atan2(across[1], across[0])))


# Outlines that an author joins to a body's plate: a leg, a chainring, a blade. They keep others away as plates do.

SAMPLES = 90
"""Points on an outline from which its convex hull is taken."""


@dataclass(frozen=True, eq=False)
class Joined(Feature):
    """One outline (mm, the body's frame)."""

    body: str
    outline: cq.Wire
    at: Point
    """The joint whose eye is within it (mm)."""
    holes: tuple[cq.Wire, ...]
    sharp: bool

    def items(self, layout: Layout) -> Iterable[Item]:
        """Return its convex hull at the height of the plate."""
        places = [self.outline.positionAt(k / SAMPLES) for k in range(SAMPLES)]
        points = np.array([(place.x, place.y) for place in places])
        shape = Rounded(convex_hull(points / layout.sizes.scale), 0.0)
        return [Item(f"the outline of {self.body}", self.body, shape, Reach((self.body,)), source=self)]

    def build(self, plan: Plan, heights: Heights) -> None:
        """Build a part of the plate."""
        scale = plan.layout.sizes.scale
        shape = extruded(self.outline, heights.thickness * scale, holes=self.holes)
        shape = shape.newObject([shape.val().scale(1 / scale)])
        x, y = (part / scale for part in self.at)
        shape = first_made([partial(eased, shape, edge) for edge in (EDGES[-1:] if self.sharp else EDGES)])
        plan.plate(self.body, shape, (x, y, plan.layout.sizes.eye), len(self.holes))
