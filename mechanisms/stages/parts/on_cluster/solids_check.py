"""``python -m mechanisms.stages.parts.on_cluster.solids_check FOLDER``: reads solids from elsewhere.

``python -m mechanisms.stages.parts.on_cluster.solids_check FOLDER`` reads them. It ends with code 1 and a sentence on
stderr unless every mesh and every STEP file beside parts.json is whole, is the same closed solid, and has the mass that
parts.json states.
"""

from __future__ import annotations

import resource
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from mechanisms.stages.parts.meshes import VOLUME_TOLERANCE, combined, mass_of
from mechanisms.stages.parts.on_cluster.answer import parts_from
from mechanisms.stages.parts_files import read_mesh
from shared.contract import BodyParts, Mass, Piece
from shared.contract.materials import MATERIALS
from shared.shapes.facets import volume_of
from shared.shapes.units import metres
from shared.stage.errors import UserError

MEMORY = 16_000_000_000
"""Bytes of addresses that reading may take."""
RELATIVE = 2e-3
"""Tolerance of masses: a solid read from STEP differs in the last digits, and integrals of splines are not exact."""
APART = 0.05
"""Largest distance (mm) between the box about a mesh and the box about its solid, with 1 % of its size."""
START, END = b"ISO-10303-21;", b"END-ISO-10303-21;"
RECORD, HEAD = 50, 84
"""Bytes of a triangle in a binary STL, and before the first."""


def refuse_wrong(folder: Path) -> None:
    """Raise UserError naming the first solid that is not what parts.json says of it."""
    document = parts_from((folder / "parts.json").read_bytes(), "parts.json")
    for body, solids in document.bodies.items():
        for name, piece in solids.pieces.items():
            _refuse_wrong_piece(folder, f"{body}: {name}", piece)
        _refuse_wrong_sums(body, solids)


def _refuse_wrong_piece(folder: Path, where: str, piece: Piece) -> None:
    stl = (folder / piece.stl).read_bytes()
    if len(stl) < HEAD or len(stl) != HEAD + RECORD * int.from_bytes(stl[80:HEAD], "little"):
        raise UserError(f"{where}: {piece.stl} is no whole binary STL ({len(stl)} bytes)")
    corners = np.frombuffer(stl, dtype=np.dtype([("floats", "<f4", 12), ("attribute", "<u2")]), offset=HEAD)["floats"]
    if not np.isfinite(corners).all():
        raise UserError(f"{where}: {piece.stl} has a coordinate that is no number")
    mesh = read_mesh(stl)
    if len(mesh.faces) != piece.triangles or not mesh.is_watertight:
        raise UserError(
            f"{where}: {piece.stl} has {len(mesh.faces)} triangles that do not close, or not as many as parts.json says"
        )
    heights = tuple(metres(float(height)) for height in mesh.bounds[:, 2])
    if not np.allclose(heights, piece.z_range, rtol=0.0, atol=1e-9):
        raise UserError(f"{where}: {piece.stl} has the heights {heights} m, parts.json {piece.z_range}")
    solid = _solid(folder / piece.step, where)
    if abs(mesh.volume / volume_of(solid) - 1) > VOLUME_TOLERANCE:
        raise UserError(f"{where}: the mesh has {mesh.volume:.1f} mm^3, the solid {volume_of(solid):.1f} mm^3")
    box = solid.BoundingBox()
    outer = np.array([[box.xmin, box.ymin, box.zmin], [box.xmax, box.ymax, box.zmax]])
    if np.abs(outer - mesh.bounds).max() > APART + 0.01 * box.DiagonalLength:
        raise UserError(f"{where}: mesh and solid are not at the same place")
    if piece.material not in MATERIALS:
        raise UserError(f"{where}: there is no material '{piece.material}'")
    size = metres(box.DiagonalLength)
    along = piece.mass.z is not None, piece.mass.tensor is not None
    if not _alike(mass_of(solid, MATERIALS[piece.material].density, *along), piece.mass, size, RELATIVE):
        raise UserError(f"{where}: the mass in parts.json is not that of its solid")


def _solid(path: Path, where: str) -> Any:
    """Return the one solid of a STEP file."""
    import cadquery

    content = path.read_bytes()
    if not content.startswith(START) or not content.rstrip().endswith(END):
        raise UserError(f"{where}: {path.name} is no whole STEP file ({len(content)} bytes)")
    try:
        solids = cadquery.importers.importStep(str(path)).solids().vals()
    except Exception as error:  # whatever the CAD kernel makes of bytes from elsewhere
        raise UserError(f"{where}: {path.name} cannot be read ({type(error).__name__}: {error})") from error
    if len(solids) != 1:
        raise UserError(f"{where}: {path.name} has {len(solids)} solids, not one")
    return solids[0]


def _refuse_wrong_sums(body: str, solids: BodyParts) -> None:
    if not solids.pieces:
        raise UserError(f"{body}: it has no pieces")
    pieces = list(solids.pieces.values())
    largest = max(abs(place) for piece in pieces for place in (*piece.mass.com, *piece.z_range))
    if not _alike(combined(piece.mass for piece in pieces if not piece.dressing), solids.mass, largest, 1e-6):
        raise UserError(f"{body}: its mass is not that of its pieces")
    if not any(abs(sum(piece.z_range) / 2 - solids.z) < 1e-9 for piece in pieces):
        raise UserError(f"{body}: its middle is not that of a piece")


def _alike(first: Mass, second: Mass, size: float, relative: float) -> bool:
    """Return True if two masses agree, ``size`` (m) being how large the solid is."""
    near = np.isclose([first.mass, first.volume], [second.mass, second.volume], rtol=relative, atol=1e-15).all()
    at = np.allclose(first.com, second.com, rtol=0.0, atol=relative * size + 1e-9)
    close = relative * (first.inertia + first.mass * size**2)
    if (first.z is None) != (second.z is None) or (first.products is None) != (second.products is None):
        return False
    if first.z is not None and second.z is not None:
        at = at and abs(first.z - second.z) <= relative * size + 1e-9
    if first.products is not None and second.products is not None:
        at = at and np.allclose(first.products, second.products, rtol=0.0, atol=close + 1e-15)
    return bool(near and at and abs(first.inertia - second.inertia) <= close)


if __name__ == "__main__":
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    try:
        refuse_wrong(Path(sys.argv[1]))
    except UserError as error:
        sys.exit(str(error))
