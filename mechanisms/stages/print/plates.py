"""Plates for the printer and outlines for the laser: packing, 3MF and DXF files."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mechanisms.stages.dxf_file import text_of, without_times
from mechanisms.stages.parts_files import binary_stl
from mechanisms.stages.print.laying import Laid
from shared.contract.materials import MATERIALS
from shared.stage.errors import UserError

# Packs rectangles on as few plates as trimesh's packing finds.

ORDERS = 20
"""Orders in which rectangles are tried, for each plate."""
DISTINCT = 1e-7
"""Rectangles get sizes that differ by this (mm): how equal ones are sorted would depend on the processor."""


@dataclass(frozen=True)
class Place:
    """Where a rectangle lies: its corner of least x and y (mm), and True if it is turned by 90 degrees."""

    plate: int
    x: float
    y: float
    turned: bool


def packed(rectangles: Sequence[tuple[float, float]], bed: tuple[float, float], gap: float) -> list[Place]:
    """Return a place for each rectangle (x, y in mm), at least ``gap`` apart.

    Raises ValueError if one is larger than the bed.
    """
    room = np.array(bed) + gap + len(rectangles) * DISTINCT
    sizes = np.array(rectangles, dtype=float).reshape(-1, 2) + gap
    sizes += DISTINCT * np.arange(len(sizes))[::-1, None]
    places: dict[int, Place] = {}
    waiting, plate = np.arange(len(sizes)), 0
    while len(waiting):
        bounds, taken = _fullest(sizes[waiting], room)
        if not taken.any():
            x, y = rectangles[int(waiting[0])]
            raise ValueError(f"a rectangle of {x:g} x {y:g} mm is larger than the bed of {bed[0]:g} x {bed[1]:g} mm")
        for index, ((x0, y0), (x1, y1)) in zip(waiting[taken].tolist(), bounds.tolist(), strict=True):
            as_it_is, across = sizes[index], np.array([x1 - x0, y1 - y0])
            turned = float(np.abs(across - as_it_is).max()) > float(np.abs(across - as_it_is[::-1]).max())
            places[index] = Place(plate, x0, y0, turned)
        waiting, plate = waiting[~taken], plate + 1
    return [places[index] for index in range(len(sizes))]


def _fullest(sizes: np.ndarray, room: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds (m, 2, 2) of the rectangles that fit a plate in the best order, and which they are."""
    from trimesh.path.packing import rectangles_single

    random, areas = np.random.default_rng(0), np.prod(sizes, axis=1)
    best = rectangles_single(sizes, size=room)
    for _ in range(ORDERS):
        if best[1].all():
            break
        other = rectangles_single(sizes, size=room, shuffle=True, random=random)
        best = max(best, other, key=lambda choice: float(areas[choice[1]].sum()))
    return best


# Outlines of flat pieces as DXF, from the solid itself: lines, arcs and splines on one layer (mm).

LAYER = "CUT"


def section(step: Path, piece: Laid, height: float) -> Any:
    """Return a ``cadquery.Workplane`` of the section at ``height`` above the bed, moved to z = 0.

    Raises UserError if the file cannot be read.
    """
    import cadquery as cq

    try:
        solid = cq.importers.importStep(str(step)).val()
    except Exception as error:
        raise UserError(f"cannot read {step} ({type(error).__name__}: {error}); make the parts again") from error
    rows = piece.turn
    origin = -rows.T @ piece.shift
    plane = cq.Plane(origin=tuple(origin), xDir=tuple(rows[0]), normal=tuple(rows[2]))
    laid = solid.moved(cq.Location(plane).inverse)
    return cq.Workplane(obj=laid).section(height).translate((0.0, 0.0, -height))


def dxf(cut: Any, thickness: float) -> bytes:
    """Return the DXF (R2013) of a section; its layer says how thick the sheet is.

    No times and no random marks are in it.
    """
    from cadquery.occ_impl.exporters.dxf import DxfDocument

    with without_times():
        document = DxfDocument(approx=None)
    document.add_layer(layer_of(thickness))
    document.add_shape(cut, layer_of(thickness))
    return text_of(document.document).encode()


def layer_of(thickness: float) -> str:
    """Return the layer of what is cut from a sheet of this thickness (mm)."""
    return f"{LAYER}_{thickness:g}MM"


def file_of(name: str, thickness: float) -> str:
    """Return the name of a piece's outline."""
    return f"{name}_{thickness:g}mm.dxf"


# Writes a plate as 3MF and as STL: equal pieces give equal bytes, whenever and wherever they are made.

OURS = uuid.UUID("6d627364-0000-5000-8000-7072696e7400")
"""The space that the names of a 3MF's objects are hashed in; the format asks for UUIDs."""


@dataclass(frozen=True, eq=False)
class Placed:
    """A piece on a plate: equal pieces share ``kind``, the name of the first of them."""

    name: str
    kind: str
    material: str
    piece: Laid
    x: float
    y: float
    turned: bool

    @property
    def transform(self) -> np.ndarray:
        """(3, 4): from the mesh of the piece to the plate, turned by 90 degrees or not (mm)."""
        if self.turned:  # a turn to the left brings the piece left of the y axis by its width
            return np.array(
                [[0.0, -1.0, 0.0, self.x + self.piece.size[1]], [1.0, 0.0, 0.0, self.y], [0.0, 0.0, 1.0, 0.0]]
            )
        return np.array([[1.0, 0.0, 0.0, self.x], [0.0, 1.0, 0.0, self.y], [0.0, 0.0, 1.0, 0.0]])

    @property
    def vertices(self) -> np.ndarray:
        """(n, 3): corners of the mesh on the plate."""
        return self.piece.vertices @ self.transform[:, :3].T + self.transform[:, 3]


def stl(plate: Sequence[Placed]) -> bytes:
    """Return all pieces of a plate in one binary STL (mm)."""
    return binary_stl(np.concatenate([part.vertices[part.piece.faces] for part in plate]).astype(np.float32))


def three_mf(title: str, plate: Sequence[Placed]) -> bytes:
    """Return a 3MF (mm): an object for each kind of piece, an item for each piece, names and colours."""
    import lib3mf

    model: Any = lib3mf.get_wrapper().CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    model.SetBuildUUID(_uuid(title, "build"))
    model.GetMetaDataGroup().AddMetaData("", "Title", title, "xs:string", True)
    palette = model.AddBaseMaterialGroup()
    colours = {name: palette.AddMaterial(name, _colour(lib3mf, name)) for name in sorted({p.material for p in plate})}
    objects: dict[str, Any] = {}
    for part in plate:
        if part.kind not in objects:
            mesh = objects[part.kind] = model.AddMeshObject()
            mesh.SetName(part.kind)
            mesh.SetUUID(_uuid(title, f"object {part.kind}"))
            mesh.SetGeometry(_positions(lib3mf, part.piece), _facets(lib3mf, part.piece))
            mesh.SetObjectLevelProperty(palette.GetUniqueResourceID(), colours[part.material])
        item = model.AddBuildItem(objects[part.kind], _transform(lib3mf, part.transform))
        item.SetPartNumber(part.name)
        item.SetUUID(_uuid(title, f"item {part.name}"))
    return bytes(model.QueryWriter("3mf").WriteToBuffer())


def _uuid(title: str, name: str) -> str:
    return str(uuid.uuid5(OURS, f"{title}: {name}"))


def _positions(lib3mf: Any, piece: Laid) -> Any:
    corners = np.ascontiguousarray(piece.vertices, dtype=np.float32)
    return (lib3mf.Position * len(corners)).from_buffer_copy(corners.tobytes())


def _facets(lib3mf: Any, piece: Laid) -> Any:
    faces = np.ascontiguousarray(piece.faces, dtype=np.uint32)
    return (lib3mf.Triangle * len(faces)).from_buffer_copy(faces.tobytes())


def _transform(lib3mf: Any, matrix: np.ndarray) -> Any:
    return lib3mf.Transform.from_buffer_copy(np.ascontiguousarray(matrix.T, dtype=np.float32).tobytes())


def _colour(lib3mf: Any, material: str) -> Any:
    """Return a material's colour, which is linear, in the curve of sRGB (IEC 61966-2-1)."""
    linear = np.array(MATERIALS[material].colour)
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return lib3mf.Color(*(round(255 * float(channel)) for channel in curve), 255)
