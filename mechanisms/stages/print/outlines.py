"""Outlines of flat pieces as DXF, from the solid itself: lines, arcs and splines on one layer (mm)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mechanisms.stages.dxf_file import text_of, without_times
from mechanisms.stages.print.laying import Laid
from shared.stage.errors import UserError

LAYER = "CUT"


def section(step: Path, piece: Laid, height: float) -> Any:
    """A ``cadquery.Workplane`` with the solid's section at ``height`` above the bed, moved to z = 0, as it is laid.

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
    """The DXF (R2013) of a section; its layer says how thick the sheet is. No times and no random marks are in it."""
    from cadquery.occ_impl.exporters.dxf import DxfDocument

    with without_times():
        document = DxfDocument(approx=None)
    document.add_layer(layer_of(thickness))
    document.add_shape(cut, layer_of(thickness))
    return text_of(document.document).encode()


def layer_of(thickness: float) -> str:
    """The layer of what is cut from a sheet of this thickness (mm)."""
    return f"{LAYER}_{thickness:g}MM"


def file_of(name: str, thickness: float) -> str:
    """The name of a piece's outline."""
    return f"{name}_{thickness:g}mm.dxf"
