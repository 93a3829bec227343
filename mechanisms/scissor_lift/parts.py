"""The platform is a table: its top lies level over both hinges, as wide as the lift is at its lowest."""

from mechanisms.automatic import automatic
from mechanisms.scissor_lift.mechanism import Params, build
from shared.shapes.bodies import Bodies
from shared.shapes.outline import rounded_rectangle
from shared.shapes.units import mm

BEYOND = 45.0
"""Of the table beyond the hinge, and beyond where the shoe comes (mm)."""
TOP = (14.0, 42.0)
"""Its lower and upper side over the line of the hinges (mm)."""


def parts(p: Params) -> Bodies:
    """All but the top of the table comes by itself."""
    made = automatic(build(p))
    long = mm(p.mean + p.amplitude) + BEYOND
    made.material("platform", "aluminium_red")
    made.join("platform", rounded_rectangle(-BEYOND, TOP[0], long, TOP[1], 4.0), at=(long, TOP[1]))
    return made.solids()
