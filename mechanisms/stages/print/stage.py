"""The stage print: from parts.json to plates, outlines and lists."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from mechanisms.stages.clearance.stage import SCHEMATIC
from shared.contract import Parts, read_parts
from shared.contract.quantity import counted
from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.face import said
from shared.stage.files import sources_hash, write_bytes
from shared.stage.paths import ROOT, Out
from shared.stage.scale import scale_of
from shared.stage.stages import Stage, key_of, versions

if TYPE_CHECKING:
    from mechanisms.stages.clearance.pieces import MeshPiece
    from mechanisms.stages.print.laying import Bed
    from mechanisms.stages.print.making import Bought, Product


# The ``print`` stage: pieces of parts.json on plates to print, outlines to cut, lists of what to make and what to buy.
#
# It writes ``out/<name>/print/``: plate_1.3mf and plate_1.stl and so on, <piece>_<thickness>mm.dxf, pieces.md and
# pieces.csv. What a piece is called there is what it is called in parts.json; of equal pieces the first gives its name.

BED, GAP = "220x220", "5"
"""Size of a plate, and what pieces on it keep apart (mm), where nobody says."""
PACKAGES = ("cadquery", "cadquery-ocp", "ezdxf", "lib3mf", "manifold3d", "numpy", "scipy", "trimesh")
SOURCES = [
    *(
        ROOT / "mechanisms" / "stages" / name
        for name in ("print", "dxf_file.py", "parts_files.py", "clearance/pieces.py")
    ),
    *(ROOT / "shared" / "contract" / f"{name}.py" for name in ("parts", "materials")),
]
LISTED = 5
"""Number of thin pieces that are named."""
_LENGTH = re.compile(r"[0-9]+(\.[0-9]*)?")


def run(name: str, bed: str = "", gap: str = "", scale: str = "") -> None:
    """Lay out the pieces of mechanism ``name``.

    ``bed`` is like 220x220 or 220x220x250, ``gap`` like 5 (mm), ``scale`` like 1:20 for the pieces of a model.

    A piece that is larger than the bed is left out with a warning that names it and the bed it needs. Raises UserError
    for a bed or a gap that is none, and where the files of parts.json are not those that it describes.
    """
    at = scale_of(scale)
    out = Out(name, at)
    size, apart = bed_of(bed or BED), gap_of(gap or GAP)
    parts = read_parts(out.parts, out.name)
    if parts.schematic:
        raise UserError(f"{out.title}: {parts.schematic}; so there is nothing to print. {SCHEMATIC}")
    key = key_of(out.parts, sources_hash(*SOURCES), versions(*PACKAGES), size, apart)
    stage = Stage(out, "print", key, [out.print_folder / "pieces.md"])
    if stage.is_fresh():
        say("print", f"{out.title}: nothing to do")
        return
    from mechanisms.stages.clearance.pieces import read_pieces

    files, made, bought = laid_out(out, parts, read_pieces(parts, out.parts_folder), size, apart)
    for file, content in files.items():
        path = out.print_folder / file
        if not path.is_file() or path.read_bytes() != content:
            write_bytes(path, content)
    for path in sorted(out.print_folder.iterdir()):
        if path.suffix in (".3mf", ".stl", ".dxf") and path.name not in files:
            path.unlink()
    stage.outputs = [out.print_folder / file for file in files]
    stage.record(bed=bed or BED, gap=gap or GAP)
    _tell_large(out.title, [part for part in made if part.bed], size, at.ratio if at else 1.0)
    if at is not None:
        _tell_thin(out.title, made)
    say("print", _summary(out.title, files, made, bought, size))


def laid_out(
    out: Out, parts: Parts, meshes: list[MeshPiece], bed: Bed, gap: float
) -> tuple[dict[str, bytes], list[Product], list[Bought]]:
    """Return the files by their names, the lists last, and what is on these."""
    from mechanisms.stages.print.making import bought_of, made_of, markdown, outlined, plates_of, table

    pieces = {name: piece for body in parts.bodies.values() for name, piece in body.pieces.items()}
    bought = bought_of(pieces)
    made = made_of(pieces, [mesh for mesh in meshes if not pieces[mesh.name].buy], bed)
    made, files = outlined(out, pieces, made)
    made, plates = plates_of(out.title, made, bed, gap, out.plate)
    shown = "x".join(f"{length:g}" for length in bed if math.isfinite(length))
    lists = {"pieces.csv": table(made, bought), "pieces.md": markdown(out.title, shown, made, bought)}
    return files | plates | {file: text.encode() for file, text in lists.items()}, made, bought


def bed_of(text: str) -> Bed:
    """Return a bed from words like 220x220 or 220x220x250; raises UserError if it is none."""
    lengths = text.lower().split("x")
    if len(lengths) not in (2, 3) or not all(_LENGTH.fullmatch(length) and float(length) > 0 for length in lengths):
        example = said(bed="220x220")
        raise UserError(f"{said(bed=text)} is no size of a bed; write its length and width in mm, such as {example}")
    x, y, *z = (float(length) for length in lengths)
    return x, y, z[0] if z else math.inf


def gap_of(text: str) -> float:
    """Return a gap (mm); raises UserError if it is none."""
    if not _LENGTH.fullmatch(text):
        raise UserError(f"{said(gap=text)} is no gap; write the distance between pieces in mm, such as {said(gap='5')}")
    return float(text)


def _tell_large(name: str, parts: list[Product], bed: Bed, ratio: float) -> None:
    """Name the pieces larger than the bed, the largest first, and the scale that fits all."""
    if not parts:
        return
    times = {part.name: max(own / length for own, length in zip(part.piece.size, bed, strict=True)) for part in parts}
    parts = sorted(parts, key=lambda part: -times[part.name])
    listed = ", ".join(
        f"{part.name}{f' ({len(part.names)} of them)' if len(part.names) > 1 else ''} of {part.bed} mm"
        for part in parts[:LISTED]
    )
    others = f" and {len(parts) - LISTED} others" if len(parts) > LISTED else ""
    size = " x ".join(f"{length:.0f}" for length in bed if math.isfinite(length))
    scale = said(scale=f"1:{math.ceil(times[parts[0].name] / ratio)}")
    needed = zip(*(map(int, part.bed.split(" x ")) for part in parts), strict=True)
    larger = said(bed="x".join(str(max(lengths)) for lengths in needed))
    warn(
        "print",
        f"{name}: these pieces need a larger bed than {size} mm, so they are on no plate: {listed}{others}; "
        f"give {larger}, or print a model: {scale} fits all of them",
    )


def _tell_thin(name: str, made: list[Product]) -> None:
    """Name pieces that have walls thinner than a nozzle, the thinnest first."""

    from mechanisms.stages.print.making import NOZZLE, thinnest

    walls = sorted((thinnest(part.piece.triangles), part.name) for part in made)
    thin = [f"{piece} {wall:.2g} mm" for wall, piece in walls if wall < NOZZLE]
    if thin:
        others = f" and {len(thin) - LISTED} others" if len(thin) > LISTED else ""
        warn(
            "print",
            f"{name}: walls thinner than a nozzle of {NOZZLE:g} mm: {', '.join(thin[:LISTED])}{others}; print it at a "
            "larger scale, or make them thicker in parts.py",
        )


def _summary(name: str, files: dict[str, bytes], made: list[Product], bought: list[Bought], bed: Bed) -> str:
    def count(suffix: str, word: str) -> str:
        return counted(sum(file.endswith(suffix) for file in files), word)

    laid = sum(len(part.plates) for part in made)
    return (
        f"{name}: {counted(laid, 'piece')} on {count('.3mf', 'plate')} of {bed[0]:g} x {bed[1]:g} mm, "
        f"{count('.dxf', 'outline')} to cut, {counted(sum(len(item.names) for item in bought), 'piece')} to buy"
    )
