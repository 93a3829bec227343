"""What is to be made and what is to be bought, for people (Markdown) and for tables (CSV)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.csv_text import csv_text
from mechanisms.stages.print.flat import Sheet
from mechanisms.stages.print.laying import Laid
from shared.contract.quantity import written

HEADER = (
    "do", "name", "count", "material", "x_mm", "y_mm", "z_mm", "mass_g", "plates", "bed_mm", "outline", "sheet_mm",
    "above_mm", "pieces",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Made:
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


def markdown(title: str, bed: str, made: Sequence[Made], bought: Sequence[Bought]) -> str:
    """The lists as a page."""
    count = sum(len(part.names) for part in made)
    mass = sum(len(part.names) * part.mass for part in made)
    lines = [f"# Pieces of {title}", "", f"## To make: {count}, {written(mass, 'kg')}", ""]
    lines += [
        "Sizes as it lies on the bed, masses in the material that is named. Plates are "
        f"{bed} mm. Where a DXF is named, the piece can be cut from a sheet of this thickness: eased edges, pockets, "
        "counterbores and engraving are not in it, and what stands above the sheet is listed.",
        "",
        "| piece | count | material | x x y x z (mm) | mass | plate | outline |",
        "|---|--:|---|---|--:|---|---|",
    ]
    lines += [f"| {' | '.join(_cells(part))} |" for part in made]
    lines += ["", f"## To buy: {sum(len(item.names) for item in bought)}", ""]
    if bought:
        lines += ["| what | count | for |", "|---|--:|---|"]
        lines += [f"| {item.what} | {len(item.names)} | {', '.join(item.names)} |" for item in bought]
    else:
        lines += ["Nothing: no piece has the sizes of a standard."]
    return "\n".join(lines) + "\n"


def table(made: Sequence[Made], bought: Sequence[Bought]) -> str:
    """The lists as CSV: a row for each kind of piece, ``do`` is make or buy."""
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


def _cells(part: Made) -> list[str]:
    size = " x ".join(f"{length:.2f}" for length in part.piece.size)
    plates = ", ".join(
        f"{plate} ({times})" if times > 1 and len(set(part.plates)) > 1 else f"{plate}"
        for plate, times in sorted(Counter(part.plates).items())
    )
    where = plates or f"none: needs a bed of {part.bed} mm"
    return [part.name, str(len(part.names)), part.material, size, written(part.mass, "kg"), where, _outline(part)]


def _outline(part: Made) -> str:
    if part.sheet is None:
        return ""
    words = f"[{part.outline}]({part.outline})"
    return f"{words}, without {part.sheet.above:.2f} mm above the sheet" if part.sheet.above else words


def _grams(mass: float) -> str:
    """Return a mass (kg) in grams with four digits and without an exponent, as tables read it."""
    return np.format_float_positional(1000 * mass, 4, unique=False, fractional=False, trim="-")
