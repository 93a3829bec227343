"""What is to be made and what is to be bought, for people (Markdown) and for tables (CSV)."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from mechanisms.stages.print.flat import Sheet
from mechanisms.stages.print.laying import Laid

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
    count = sum(len(one.names) for one in made)
    mass = sum(len(one.names) * one.mass for one in made)
    lines = [f"# Pieces of {title}", "", f"## To make: {count}, {_grams(mass)} g", ""]
    lines += [
        "Sizes as it lies on the bed, masses in the material that is named. Plates are "
        f"{bed} mm. Where a DXF is named, the piece can be cut from a sheet of this thickness: eased edges, pockets, "
        "counterbores and engraving are not in it, and what stands above the sheet is listed.",
        "",
        "| piece | count | material | x x y x z (mm) | mass (g) | plate | outline |",
        "|---|--:|---|---|--:|---|---|",
    ]
    lines += [f"| {' | '.join(_cells(one))} |" for one in made]
    lines += ["", f"## To buy: {sum(len(one.names) for one in bought)}", ""]
    if bought:
        lines += ["| what | count | for |", "|---|--:|---|"]
        lines += [f"| {one.what} | {len(one.names)} | {', '.join(one.names)} |" for one in bought]
    else:
        lines += ["Nothing: no piece has the sizes of a standard."]
    return "\n".join(lines) + "\n"


def table(made: Sequence[Made], bought: Sequence[Bought]) -> str:
    """The lists as CSV: a row for each kind of piece, ``do`` is make or buy."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    for one in made:
        size = [f"{length:.2f}" for length in one.piece.size]
        sheet = (f"{one.sheet.thickness:g}", f"{one.sheet.above:.2f}") if one.sheet else ("", "")
        plates = " ".join(str(plate) for plate in one.plates)
        row = ["make", one.name, len(one.names), one.material, *size, _grams(one.mass), plates, one.bed, one.outline]
        writer.writerow([*row, *sheet, " ".join(one.names)])
    for one in bought:
        row = ["buy", one.what, len(one.names), one.material]
        writer.writerow([*row, *[""] * (len(HEADER) - len(row) - 1), " ".join(one.names)])
    return text.getvalue()


def _cells(one: Made) -> list[str]:
    size = " x ".join(f"{length:.2f}" for length in one.piece.size)
    plates = ", ".join(
        f"{plate} ({times})" if times > 1 and len(set(one.plates)) > 1 else f"{plate}"
        for plate, times in sorted(Counter(one.plates).items())
    )
    where = plates or f"none: needs a bed of {one.bed} mm"
    return [one.name, str(len(one.names)), one.material, size, _grams(one.mass), where, _outline(one)]


def _outline(one: Made) -> str:
    if one.sheet is None:
        return ""
    words = f"[{one.outline}]({one.outline})"
    return f"{words}, without {one.sheet.above:.2f} mm above the sheet" if one.sheet.above else words


def _grams(mass: float) -> str:
    return f"{1000 * mass:.4g}"
