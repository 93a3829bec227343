"""Where a bistable lever comes to rest, over the angle and the speed of its start."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GOLD, plain

LEVELS = np.arange(0, 81, 10)


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    rests, fast = figure.subplots(1, 2)
    shape = len(page.speeds), len(page.angles)
    side = page.right.reshape(shape).astype(float)
    rests.contourf(page.angles, page.speeds, side, levels=(-0.5, 0.5, 1.5), cmap=ListedColormap([GOLD, BLUE]))
    for colour, word in ((BLUE, "right"), (GOLD, "left")):
        rests.plot([], [], "s", color=colour, label=f"it rests on the {word}")
    rests.legend(loc="upper center", ncols=2, bbox_to_anchor=(0.5, -0.16))
    drawn = fast.contourf(page.angles, page.speeds, page.many["fast"].reshape(shape), levels=LEVELS, cmap="viridis")
    figure.colorbar(drawn, ax=fast).set_label("fastest, rad/s")
    for ax, title in ((rests, "on which side it rests"), (fast, "how fast it becomes")):
        plain(ax, xlabel="angle at the start, degrees", ylabel="speed at the start, rad/s", title=title)
        ax.set(xlim=(page.angles[0], page.angles[-1]), ylim=(page.speeds[0], page.speeds[-1]))
    return {"batch_simulations.svg": figure}
