"""Where lengths move the point of a four-bar, what they do to its torque, and how a search went down."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GOLD, PURPLE, QUIET, plain

EVERY = 24
ARROW = 0.010
"""A change of a length (m) that the arrows are of."""


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    path, torque, search = figure.subplots(1, 3, width_ratios=(1.0, 1.25, 0.9))
    s, colours = page.s, {"crank": BLUE, "coupler": GOLD, "rocker": PURPLE}
    x, y = s.values["P.x"], s.values["P.y"]
    path.plot(1e3 * x, 1e3 * y, color=QUIET, lw=1.2)
    for name, colour in colours.items():
        dx, dy = (ARROW * s.of(axis, name) for axis in ("P.x", "P.y"))
        path.quiver(
            1e3 * x[::EVERY], 1e3 * y[::EVERY], 1e3 * dx[::EVERY], 1e3 * dy[::EVERY], color=colour, angles="xy",
            scale_units="xy", scale=1.0, width=0.008, label=name,
        )  # fmt: skip
        path.update_datalim(1e3 * np.stack([x + dx, y + dy], axis=1)[::EVERY])  # a quiver counts its tails alone
        torque.plot(s.t, 1e1 * page.m.bodies[name].length * s.of("motor.effort", name), color=colour, label=name)
    path.autoscale_view()
    path.set_aspect("equal", adjustable="datalim")
    plain(path, xlabel="x, mm", ylabel="y, mm", title=f"where {1e3 * ARROW:g} mm more move the point")
    torque.legend(loc="best")
    plain(torque, xlabel="time, s", ylabel="mN m", title="what one per cent adds to the torque")
    history = np.array(page.softest.history)
    search.plot(np.arange(1, len(history) + 1), history, "o-", color=BLUE)
    search.axhline(page.softest.objective, color=QUIET, lw=0.8)
    plain(search, xlabel="motions", ylabel="N m/rad", title="the closer of the clamp")
    return {"derivatives.svg": figure}
