"""Everything that is printed, cut and bought, with its lists."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.files import csv_text
from mechanisms.stages.print.laying import Bed, Laid, Sheet, fitting, groups, laid, sheet_of
from mechanisms.stages.print.plates import Placed, dxf, file_of, packed, section, stl, three_mf
from shared.contract import Piece
from shared.contract.quantity import written
from shared.stage.console import markdown_table
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import Out

if TYPE_CHECKING:
    from mechanisms.stages.clearance.pieces import MeshPiece


# Lists of pieces to make and to buy, for people (Markdown) and for tables (CSV).

HEADER = (
    "do", "name", "count", "material", "x_mm", "y_mm", "z_mm", "mass_g", "plates", "bed_mm", "outline", "sheet_mm",
    "above_mm", "pieces",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Product:
    """Equal pieces that are to be made."""

    names: tuple[str, ...]
    material: str
    mass: float
    """Mass of a single piece (kg)."""
    piece: Laid
    sheet: Sheet | None = None
    outline: str = ""
    """File of its DXF."""
    plates: tuple[int, ...] = ()
    """The plate of each, from 1; empty if the piece is larger than the bed."""
    bed: str = ""
    """The least bed that would do, if it is larger."""

    @property
    def name(self) -> str:
        """Name of the first piece."""
        return self.names[0]


@dataclass(frozen=True)
class Bought:
    """Equal pieces that are to be bought."""

    what: str
    names: tuple[str, ...]
    material: str


def markdown(title: str, bed: str, made: Sequence[Product], bought: Sequence[Bought]) -> str:
    """Return the lists as a page."""
    count = sum(len(part.names) for part in made)
    mass = sum(len(part.names) * part.mass for part in made)
    lines = [f"# Pieces of {title}", "", f"## To make: {count}, {written(mass, 'kg')}", ""]
    lines += [
        "Sizes as it lies on the bed, masses in the material that is named. Plates are "
        f"{bed} mm. Where a DXF is named, the piece can be cut from a sheet of this thickness: eased edges, pockets, "
        "counterbores and engraving are not in it, and what stands above the sheet is listed.",
        "",
    ]
    head = ("piece", "count", "material", "x x y x z (mm)", "mass", "plate", "outline")
    lines += markdown_table(head, map(_cells, made), numbers=[1, 4])
    lines += ["", f"## To buy: {sum(len(item.names) for item in bought)}", ""]
    if bought:
        items = [(item.what, str(len(item.names)), ", ".join(item.names)) for item in bought]
        lines += markdown_table(("what", "count", "for"), items, numbers=[1])
    else:
        lines += ["Nothing: no piece has the sizes of a standard."]
    return "\n".join(lines) + "\n"


def table(made: Sequence[Product], bought: Sequence[Bought]) -> str:
    """Return the lists as CSV: a row for each kind of piece, ``do`` is make or buy."""
    rows: list[list[object]] = []
    for part in made:
        size = [f"{length:.2f}" for length in part.piece.size]
        sheet = (f"{part.sheet.thickness:g}", f"{part.sheet.above:.2f}") if part.sheet else ("", "")
        plates = " ".join(str(plate) for plate in part.plates)
        row = ["make", part.name, len(part.names), part.material, *size, _grams(part.mass), plates, part.bed]
        rows.append([*row, part.outline, *sheet, " ".join(part.names)])
    for item in bought:
        row = ["buy", item.what, len(item.names), item.material]
        rows.append([*row, *[""] * (len(HEADER) - len(row) - 1), " ".join(item.names)])
    return csv_text(HEADER, rows)


def _cells(part: Product) -> list[str]:
    size = " x ".join(f"{length:.2f}" for length in part.piece.size)
    plates = ", ".join(
        f"{plate} ({times})" if times > 1 and len(set(part.plates)) > 1 else f"{plate}"
        for plate, times in sorted(Counter(part.plates).items())
    )
    where = plates or f"none: needs a bed of {part.bed} mm"
    return [part.name, str(len(part.names)), part.material, size, written(part.mass, "kg"), where, _outline(part)]


def _outline(part: Product) -> str:
    if part.sheet is None:
        return ""
    words = f"[{part.outline}]({part.outline})"
    return f"{words}, without {part.sheet.above:.2f} mm above the sheet" if part.sheet.above else words


def _grams(mass: float) -> str:
    """Return a mass (kg) in grams with four digits and without an exponent, as tables read it."""
    return np.format_float_positional(1000 * mass, 4, unique=False, fractional=False, trim="-")


# From the pieces of parts.json to plates, outlines and lists.


def bought_of(pieces: Mapping[str, Piece]) -> list[Bought]:
    """Return all pieces to buy, in the order of the alphabet."""
    kinds: dict[tuple[str, str], list[str]] = {}
    for name, piece in pieces.items():
        if piece.buy:
            kinds.setdefault((piece.buy, piece.material), []).append(name)
    return [Bought(what, tuple(kinds[what, material]), material) for what, material in sorted(kinds)]


def made_of(pieces: Mapping[str, Piece], meshes: Sequence[MeshPiece], bed: Bed) -> list[Product]:
    """Return all pieces to make, equal pieces together, each as it lies on the bed."""
    down = [laid(mesh.triangles) for mesh in meshes]
    names = [mesh.name for mesh in meshes]
    parts = []
    for group in groups([(pieces[name].material, piece) for name, piece in zip(names, down, strict=True)]):
        first, piece = pieces[names[group[0]]], down[group[0]]
        fits = fitting(piece, bed[:2]) if piece.size[2] <= bed[2] else None
        part = Product(tuple(names[k] for k in group), first.material, first.mass.mass, fits or piece)
        parts.append(part if fits else replace(part, bed=_bed_for(part, bed)))
    return parts


def _bed_for(part: Product, bed: Bed) -> str:
    """Return the bed that a piece needs, in whole millimetres."""
    x, y, z = (math.ceil(length - 1e-6) for length in part.piece.size)
    return f"{x} x {y}" + (f" x {z}" if math.isfinite(bed[2]) else "")


def outlined(out: Out, pieces: Mapping[str, Piece], made: Iterable[Product]) -> tuple[list[Product], dict[str, bytes]]:
    """Return the pieces with the outlines of those that can be cut from a sheet, and the DXF files."""
    parts: list[Product] = []
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
    title: str, made: Sequence[Product], bed: Bed, gap: float, stem: str = "plate"
) -> tuple[list[Product], dict[str, bytes]]:
    """Return the pieces with the plates that they lie on, and the files, named from ``stem``."""
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


# How thin the walls of a piece are: what a ray from its surface inwards meets first.

NOZZLE = 0.4
"""Width of a usual nozzle (mm); thinner walls are not printed."""
RAYS = 150
"""Number of rays, from the largest facets and from others."""
SQUARE = 0.94
"""A ray counts where it meets a face that looks the other way, within 20 degrees: a wall, no edge or wedge."""
NARROW = 0.35
"""Width (mm) of facets from which no ray starts if they are narrower: they are sides of engraved lines."""
SKIN = 1e-4
"""Rays start so far below the surface (mm)."""


def thinnest(triangles: np.ndarray) -> float:
    """Return the thinnest wall (mm) of a closed mesh (n, 3, 3) that its rays find.

    Infinite where they find none.
    """
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.linalg.norm(across, axis=1)
    sound = size > 1e-9
    triangles, across, size = triangles[sound], across[sound], size[sound]
    normals = across / size[:, None]
    edges = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    wide = np.flatnonzero(size / edges.max(axis=1) > NARROW)
    order = wide[np.argsort(-size[wide], kind="stable")]
    chosen = np.unique(np.concatenate([order[: RAYS // 2], order[:: max(1, len(order) // (RAYS // 2))]]))
    walls = (_inside(triangles, normals, triangles[k].mean(axis=0), -normals[k]) for k in chosen)
    return min(walls, default=np.inf)


def _inside(triangles: np.ndarray, normals: np.ndarray, start: np.ndarray, way: np.ndarray) -> float:
    """Return how far it is to the next face along a ray (Moeller and Trumbore 1997).

    Infinite where that leans.
    """
    first, second = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    aside = np.cross(way, second)
    volume = np.einsum("ij,ij->i", first, aside)
    with np.errstate(divide="ignore", invalid="ignore"):
        to = start - triangles[:, 0]
        u = np.einsum("ij,ij->i", to, aside) / volume
        over = np.cross(to, first)
        v = over @ way / volume
        far = np.einsum("ij,ij->i", second, over) / volume
        hit = (np.abs(volume) > 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (far > SKIN)
    if not hit.any():
        return np.inf
    at = int(np.argmin(np.where(hit, far, np.inf)))
    return float(far[at]) if float(normals[at] @ way) > SQUARE else np.inf
