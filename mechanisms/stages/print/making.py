"""From the pieces of parts.json to plates, outlines and lists."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from mechanisms.stages.print.alike import groups
from mechanisms.stages.print.flat import sheet_of
from mechanisms.stages.print.laying import fitting, laid
from mechanisms.stages.print.lists import Bought, Made
from mechanisms.stages.print.outlines import dxf, file_of, section
from mechanisms.stages.print.packing import packed
from mechanisms.stages.print.plate_files import Placed, stl, three_mf
from shared.stage.errors import UserError
from shared.stage.face import to_run

if TYPE_CHECKING:
    from mechanisms.stages.clearance.pieces import MeshPiece
    from mechanisms.stages.print.laying import Bed
    from shared.contract import Piece
    from shared.stage.paths import Out


def bought_of(pieces: Mapping[str, Piece]) -> list[Bought]:
    """What is to be bought, in the order of the alphabet."""
    kinds: dict[tuple[str, str], list[str]] = {}
    for name, piece in pieces.items():
        if piece.buy:
            kinds.setdefault((piece.buy, piece.material), []).append(name)
    return [Bought(what, tuple(kinds[what, material]), material) for what, material in sorted(kinds)]


def made_of(pieces: Mapping[str, Piece], meshes: Sequence[MeshPiece], bed: Bed) -> list[Made]:
    """What is to be made, equal pieces together, each as it lies on the bed."""
    down = [laid(mesh.triangles) for mesh in meshes]
    names = [mesh.name for mesh in meshes]
    parts = []
    for group in groups([(pieces[name].material, piece) for name, piece in zip(names, down, strict=True)]):
        first, piece = pieces[names[group[0]]], down[group[0]]
        fits = fitting(piece, bed[:2]) if piece.size[2] <= bed[2] else None
        part = Made(tuple(names[k] for k in group), first.material, first.mass.mass, fits or piece)
        parts.append(part if fits else replace(part, bed=_bed_for(part, bed)))
    return parts


def _bed_for(part: Made, bed: Bed) -> str:
    """The bed that a piece needs, in whole millimetres."""
    x, y, z = (math.ceil(length - 1e-6) for length in part.piece.size)
    return f"{x} x {y}" + (f" x {z}" if math.isfinite(bed[2]) else "")


def outlined(out: Out, pieces: Mapping[str, Piece], made: Iterable[Made]) -> tuple[list[Made], dict[str, bytes]]:
    """With the outlines of those that can be cut from a sheet, and the DXF files."""
    parts: list[Made] = []
    files: dict[str, bytes] = {}
    for part in made:
        sheet = sheet_of(part.piece)
        if sheet is None:
            parts.append(part)
            continue
        step = out.parts_folder / pieces[part.name].step
        if not step.is_file():
            raise UserError(f"{step} is missing; run {to_run('parts', out.name)}")
        file = file_of(part.name, sheet.thickness)
        files[file] = dxf(section(step, part.piece, sheet.thickness / 2), sheet.thickness)
        parts.append(replace(part, sheet=sheet, outline=file))
    return parts, files


def plates_of(
    title: str, made: Sequence[Made], bed: Bed, gap: float, stem: str = "plate"
) -> tuple[list[Made], dict[str, bytes]]:
    """With the plates that the pieces lie on, and the files of these, whose names begin with ``stem``."""
    items = [(k, name) for k, part in enumerate(made) if not part.bed for name in part.names]
    places = packed([made[k].piece.size[:2] for k, _ in items], bed[:2], gap)
    plates: dict[int, list[Placed]] = {}
    for (k, name), at in zip(items, places, strict=True):
        part = made[k]
        placed = Placed(name, part.name, part.material, part.piece, at.x, at.y, at.turned)
        plates.setdefault(at.plate, []).append(placed)
    files: dict[str, bytes] = {}
    for number, plate in sorted(plates.items()):
        files[f"{stem}_{number + 1}.3mf"] = three_mf(f"{title}: plate {number + 1}", plate)
        files[f"{stem}_{number + 1}.stl"] = stl(plate)
    on = [tuple(at.plate + 1 for (i, _), at in zip(items, places, strict=True) if i == k) for k in range(len(made))]
    return [replace(part, plates=plates) for part, plates in zip(made, on, strict=True)], files
