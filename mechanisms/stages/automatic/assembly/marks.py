"""Words engraved into the upper face of a plate (rmm)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shared.stage.errors import UserError

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.layout.plan import Plan

DEPTH = 0.6
WIDTH = 0.2
"""Width of a stroke, in heights of the letters."""
LEAST = 0.99
"""How much of a word must be on the plate."""


@dataclass(frozen=True)
class Wish:
    """A word that is asked for, its middle ``at`` (x, y) in the frame of its body (mm)."""

    body: str
    word: str
    at: tuple[float, float]
    height: float | None


def place(wishes: Iterable[Wish], plan: Plan) -> None:
    """Enter the words; letters are half as high as an eye's radius where nobody says."""
    from mechanisms.stages.automatic.layout.plan import Mark

    sizes = plan.layout.sizes
    for wish in wishes:
        x, y = (length / sizes.scale for length in wish.at)
        height = wish.height / sizes.scale if wish.height else sizes.eye / 2
        plan.marks.setdefault(wish.body, []).append(Mark(wish.word, x, y, height))


def refuse_letters(name: str, word: str) -> None:
    """Raise UserError where a word cannot be engraved."""
    from shared.shapes.engraving import LETTERS

    unknown = [letter for letter in word if letter not in LETTERS]
    if unknown or not word:
        what = f"cannot engrave {unknown[0]!r}" if unknown else "there is no letter to engrave"
        raise UserError(f"{name}: {what}; there are strokes for {''.join(LETTERS)}")


def marked(shape: cq.Workplane, plan: Plan, body: str, thickness: float) -> cq.Workplane:
    """The plate of ``body``, z = 0 to ``thickness``, with its words.

    Raises UserError naming word, body and place where a word is not wholly on the plate.
    """
    import cadquery as cq

    from shared.shapes.engraving import engraved, text

    for mark in plan.marks.get(body, []):
        strokes = text(mark.word, mark.height, mark.x, mark.y, width=WIDTH * mark.height)
        slab = cq.Workplane(origin=(mark.x, mark.y, 0)).rect(1e3, 1e3).extrude(thickness)
        wanted = slab.val().Volume() - engraved(slab, strokes, thickness, DEPTH).val().Volume()
        before, shape = shape, engraved(shape, strokes, thickness, DEPTH)
        if before.val().Volume() - shape.val().Volume() < LEAST * wanted:
            scale = plan.layout.sizes.scale
            place = f"({mark.x * scale:g}, {mark.y * scale:g}) mm"
            raise UserError(
                f"{plan.layout.m.name}: '{mark.word}' at {place} is not all on the upper face of '{body}'; move it, or "
                "make it smaller with height="
            )
    return shape
