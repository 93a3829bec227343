"""Solids of an author's own from STEP files, in place of the plate of a body.

The file's axes are the body's frame, its z axis the normal of the plane; millimetres, or what the file says. The solid
is put at the height of the plate. Where pins go through the plate, the solid must have holes for them: round ones along
z, right through. The number of its through holes follows from its faces, edges and vertices (Euler and Poincare):

    G = S - (V - E + 2 F - L) / 2        S shells, L loops of all faces
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cadquery as cq
import numpy as np
from scipy.spatial import ConvexHull

from mechanisms.stages.automatic.layout.plan import Plan
from shared.shapes.solid import Solid, placed
from shared.stage.errors import UserError
from shared.stage.paths import mechanism_folder

LARGEST = 200e6
"""Bytes of a file."""
BESIDE, SLANTED = 0.02, 1e-6
"""Largest distance of a hole from its joint (mm), and its largest lean (rad)."""
HEAD = b"ISO-10303-21"


@dataclass(frozen=True)
class Hole:
    """A round hole along z (mm)."""

    x: float
    y: float
    radius: float
    low: float
    high: float


@dataclass(frozen=True)
class OwnSolid:
    """The solid of a STEP file, its lowest point at z = 0 (mm)."""

    body: str
    file: str
    shape: cq.Workplane
    thickness: float
    holes: tuple[Hole, ...]
    through_holes: int

    @property
    def outline(self) -> cq.Wire:
        """Its convex hull in the plane."""
        points = np.array([(vertex.x, vertex.y) for vertex in self.shape.val().tessellate(0.2)[0]])  # pyright: ignore[reportAttributeAccessIssue]
        hull = points[ConvexHull(points).vertices]
        return cq.Wire.makePolygon([cq.Vector(x, y, 0.0) for x, y in hull.tolist()], close=True)

    def in_place(self, name: str, plan: Plan, plate: Solid, span: tuple[float, float]) -> Solid:
        """Return it in place of a plate. Raises UserError where it is too thick, or its holes do not meet the pins."""
        low, high = span
        if self.thickness > high - low + BESIDE:
            raise UserError(
                f"{name}: {self.file} is {self.thickness:.4g} mm thick along z, and the layer of '{self.body}' "
                f"{high - low:.4g} mm: the solid would reach into others. Make it thinner, or build with a larger pin"
            )
        scale = plan.layout.sizes.scale
        for x, y, eye in plan.eyes.get(self.body, []):
            if eye.bore > 0.0:
                self._refuse_missed(name, x * scale, y * scale, eye.bore * scale / 2)
        shape, tolerance = placed(self.shape, z=low), plate.tolerance
        return Solid(plate.name, shape, plate.material, self.through_holes, tolerance=tolerance, fitted=True)

    def _refuse_missed(self, name: str, x: float, y: float, radius: float) -> None:
        where = f"{name}: {self.file}: a pin of '{self.body}' goes through ({x:.4g}, {y:.4g}) mm"
        nearest = min(self.holes, key=lambda hole: math.dist((hole.x, hole.y), (x, y)), default=None)
        if nearest is None:
            raise UserError(f"{where}, but the solid has no round hole along z. Bore one of {2 * radius:.4g} mm")
        away = math.dist((nearest.x, nearest.y), (x, y))
        if away > BESIDE:
            raise UserError(
                f"{where}, but its nearest hole is at ({nearest.x:.4g}, {nearest.y:.4g}) mm, {away:.4g} mm beside it. "
                f"Move the hole, or the joint; the file's axes are the frame of '{self.body}'"
            )
        if nearest.radius < radius - BESIDE:
            raise UserError(
                f"{where} and needs a hole of {2 * radius:.4g} mm, but that of the solid has {2 * nearest.radius:.4g} "
                "mm. Widen it, or build with a thinner pin: automatic(..., pin=)"
            )


def read_solid(mechanism: str, body: str, file: str | Path) -> OwnSolid:
    """Return the solid of a STEP file, beside mechanism.py unless its path is absolute. Raises UserError."""
    path = Path(file)
    path = path if path.is_absolute() else mechanism_folder(mechanism) / path
    what = f"{mechanism}: the solid of '{body}', {path.name}"
    _refuse_unreadable(what, path)
    try:
        shape = cq.importers.importStep(str(path))
        solids = shape.solids().vals()
    except Exception as error:  # what the CAD kernel raises has no class of its own
        raise UserError(f"{what}, cannot be read: {error}. Export it again as STEP (AP214)") from None
    if not solids:
        raise UserError(f"{what}, has no solid, only faces or curves. Export a closed solid body")
    if len(solids) > 1:
        raise UserError(f"{what}, has {len(solids)} solids; a body's plate is one. Join them, or use made.replace(...)")
    [solid] = solids
    if not isinstance(solid, cq.Solid) or not solid.isValid() or not solid.Volume() > 0.0:
        raise UserError(f"{what}, has a solid that is not closed, or crosses itself. Repair it in its CAD program")
    box = solid.BoundingBox()
    if not 0.1 <= max(box.xlen, box.ylen) <= 1e4:
        raise UserError(
            f"{what}, is {max(box.xlen, box.ylen):.3g} mm long. Its units are wrong: export it in millimetres"
        )
    lowest = solid.translate(cq.Vector(0, 0, -box.zmin))
    holes = tuple(holes_of(lowest, box.zlen))
    return OwnSolid(body, path.name, cq.Workplane(obj=lowest), box.zlen, holes, through_holes(lowest))


def _refuse_unreadable(what: str, path: Path) -> None:
    """Raise UserError for a file that is missing, too large or no STEP file."""
    if not path.is_file():
        raise UserError(f"{what}, is not in {path.parent}; put the file beside mechanism.py, or give its whole path")
    if path.stat().st_size > LARGEST:
        raise UserError(f"{what}, has {path.stat().st_size / 1e6:.0f} MB; {LARGEST / 1e6:.0f} MB are the most")
    with path.open("rb") as stream:
        if HEAD not in stream.read(256):
            raise UserError(f"{what}, is not a STEP file: it does not begin with {HEAD.decode()}. Export it as STEP")


def holes_of(solid: cq.Solid, thickness: float) -> list[Hole]:
    """Return the round holes along z that go right through a solid which stands on z = 0 (mm)."""
    walls: dict[tuple[float, float, float], list[tuple[float, float, float]]] = {}
    for face in solid.Faces():
        if face.geomType() != "CYLINDER":
            continue
        cylinder = face._geomAdaptor().Cylinder()
        axis, place = cylinder.Axis().Direction(), cylinder.Axis().Location()
        if math.hypot(axis.X(), axis.Y()) > SLANTED or not _is_hollow(face, place.X(), place.Y()):
            continue
        box = face.BoundingBox()
        key = (round(place.X(), 4), round(place.Y(), 4), round(cylinder.Radius(), 4))
        walls.setdefault(key, []).append((box.zmin, box.zmax, face.Area()))
    out = []
    for (x, y, radius), faces in walls.items():
        low, high = min(face[0] for face in faces), max(face[1] for face in faces)
        whole = sum(face[2] for face in faces) > 0.999 * math.tau * radius * (high - low)
        if whole and low < BESIDE and high > thickness - BESIDE:
            out.append(Hole(x, y, radius, low, high))
    return sorted(out, key=lambda hole: (hole.x, hole.y))


def _is_hollow(face: cq.Face, x: float, y: float) -> bool:
    """Return True if a cylindrical face looks inwards, as that of a hole does."""
    centre = face.positionAt(0.5, 0.5)
    outwards = face.normalAt(centre)
    return outwards.x * (centre.x - x) + outwards.y * (centre.y - y) < 0.0


def through_holes(solid: cq.Solid) -> int:
    """Return how many holes go through a solid."""
    from OCP.BRep import BRep_Tool

    edges = [edge for edge in solid.Edges() if not BRep_Tool.Degenerated_s(edge.wrapped)]
    faces: Sequence[cq.Face] = solid.Faces()
    loops = sum(1 + len(face.innerWires()) for face in faces)
    characteristic = len(solid.Vertices()) - len(edges) + 2 * len(faces) - loops
    return len(solid.Shells()) - characteristic // 2
