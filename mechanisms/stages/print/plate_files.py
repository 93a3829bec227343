"""Writes a plate as 3MF and as STL: equal pieces give equal bytes, whenever and wherever they are made."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mechanisms.stages.parts_files import binary_stl
from mechanisms.stages.print.laying import Laid
from shared.contract.materials import MATERIALS

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
    """All pieces of a plate in one binary STL (mm)."""
    return binary_stl(np.concatenate([part.vertices[part.piece.faces] for part in plate]).astype(np.float32))


def three_mf(title: str, plate: Sequence[Placed]) -> bytes:
    """A 3MF (mm) with an object for each kind of piece, an item for each piece, both with names, and colours."""
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
    """A material's colour, which is linear, in the curve of sRGB (IEC 61966-2-1)."""
    linear = np.array(MATERIALS[material].colour)
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return lib3mf.Color(*(round(255 * float(channel)) for channel in curve), 255)
