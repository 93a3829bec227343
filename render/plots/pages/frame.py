"""What the frame feels of machines with bodies in different places along the normal: force, couple, centre of mass."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from render.plots.horizon import horizon
from render.plots.pages.rates import draw
from render.plots.style import PALETTE, page, rows
from render.shaking import couple_floor, force_floor, shaking
from shared.contract import Motion

STILL = 1e-9
"""A centre of mass that moves by less (m) is at rest."""


def frame(motion: Motion) -> Figure:
    """Force of inertia (N), couples about axes in the plane (N m), and the way of the centre of mass (m)."""
    over, shaken, vibration = horizon(motion), shaking(motion), motion.vibration
    assert vibration is not None
    assert shaken.mx is not None
    assert shaken.my is not None
    figure = page(motion.mechanism, "what the frame feels", f"inertia alone; moment about {shaken.about} in the report")
    force, couple, centre = rows(figure, 3)
    draw(
        force,
        over,
        "force",
        "N",
        [("x", shaken.fx, PALETTE[0]), ("y", shaken.fy, PALETTE[1])],
        floor=force_floor(motion),
    )
    lines = [("about x", shaken.mx, PALETTE[0]), ("about y", shaken.my, PALETTE[1])]
    draw(couple, over, "couple", "N m", lines, floor=couple_floor(motion))
    ways = [np.array(values) - np.mean(values) for values in (vibration.x, vibration.y)]
    lines = [("x", ways[0], PALETTE[0]), ("y", ways[1], PALETTE[1])]
    draw(centre, over, "centre of mass", "m", lines, floor=STILL)
    over.dress(centre)
    return figure
