"""Sizes of models at a scale, which are printed: pins and clearances in millimetres of the finished piece.

What goes with a pin of :data:`LEAST` mm is as thin as a nozzle allows: the wall of a bushing is 0.41 mm, its flange
0.45 mm, and washers and circlips of that size are bought (DIN 988, DIN 471).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.extents import Lengths
from mechanisms.stages.automatic.layout.sizes import LEAST_LINK, OVERALL, PIN, STANDARD, Sizes, of_pin, standard
from mechanisms.stages.loading.wished_scale import wished_scale
from shared.shapes.fit import Fit
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.face import said

if TYPE_CHECKING:
    from shared.stage.scale import Scale

LEAST = 3.0
"""Diameter of the thinnest pin (mm)."""
RUNNING, PRESS, AXIAL = 0.3, 0.1, 0.3
"""Least clearances of printed parts (mm)."""


def printed_sizes(
    name: str, lengths: Lengths, scale: Scale, thinnest: float, pin: float | None = None, fit: Fit | None = None
) -> list[Sizes]:
    """The most wanted first, then with thinner pins, the last ``thinnest`` times as thick at least.

    ``pin`` (mm of the machine) is what its author wishes there, ``fit`` (mm of the piece) what the printer does. Raises
    UserError naming the shortest link and the smallest scale that would do, if no pin fits it.
    """
    shortest, link, own = lengths.shortest
    room = mm(shortest) * scale.ratio / LEAST_LINK
    if room < LEAST * (1 - 1e-9):
        raise UserError(_too_short(name, shortest, link, own, scale))
    wished = mm(lengths.overall) * scale.ratio / OVERALL if pin is None else pin * scale.ratio
    thick = max(standard(min(room, wished)), LEAST)
    thinner = [d for d in reversed(STANDARD) if max(thinnest * thick, LEAST) <= d < thick]
    return [of_pin(d, fit or printed_fit(d), scale.ratio) for d in (thick, *thinner)]


def printed_fit(pin: float) -> Fit:
    """Clearances that printed parts with pins of this diameter need (mm)."""
    size = pin / PIN
    return Fit(
        min(max(0.2 * size, RUNNING), 0.6), max(Fit.press * size, PRESS), max(0.4 * size, AXIAL), Fit.seat * size
    )


def fit_at_scale(pin: float) -> Fit:
    """Return the clearances for a parts.py with pins of this diameter: ``Fit()``, or in a model at a scale what its
    printer needs. All in mm of the machine.
    """
    scale = wished_scale()
    if scale is None:
        return Fit()
    fit = printed_fit(pin * scale.ratio)
    return Fit(*(clearance / scale.ratio for clearance in (fit.running, fit.press, fit.axial, fit.seat)))


def _too_short(name: str, shortest: float, link: str, own: float, scale: Scale) -> str:
    needed = LEAST * LEAST_LINK
    times = mm(shortest) / needed
    least = f"1:{math.floor(times)}" if times >= 1 else f"{math.ceil(1 / times)}:1"
    return (
        f"{name} at {scale}: {link} becomes {mm(own) * scale.ratio:.3g} mm, and the thinnest pins that can be "
        f"printed, of {LEAST:g} mm, need {needed * own / shortest:.3g} mm; "
        f"{said(scale=least)} is the smallest that works"
    )
