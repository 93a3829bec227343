"""Plots of motions for the tests that look at them, and the texts on them."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from render.plots import figures
from shared.contract import Motion, write_motion
from shared.contract.skeleton import write_skeleton
from shared.stage.paths import Out
from tools.models.motions import four_bar_motion, plain_skeleton

MOTION = four_bar_motion(steps=72)
NAMES = ["bodies", "energy", "hodographs", "path", "point-P", "reactions"]


def figure(plot: str, motion: Motion) -> Figure:
    return figures.figure(plot, motion, plain_skeleton(motion))


def write(out: Out, motion: Motion) -> None:
    write_motion(out.motion, motion)
    write_skeleton(out.skeleton, plain_skeleton(motion))


def shown(drawn: Figure) -> set[str]:
    """Every text on the page."""
    drawn.canvas.draw()
    return {text.get_text() for text in drawn.findobj(Text) if isinstance(text, Text)}


def _titles(axes: Axes) -> list[Text]:
    """Titles of axes, wherever they stand."""
    words = {axes.get_title(side) for side in ("left", "center", "right")}
    return [text for text in axes.get_children() if isinstance(text, Text) and text.get_text() in words]


def overlaps(drawn: Figure) -> list[tuple[str, str]]:
    """Pairs of labels, titles and names of axes that cover each other."""
    drawn.canvas.draw()
    texts = [
        text
        for axes in drawn.axes
        if axes.get_visible()
        for text in (*axes.texts, *_titles(axes), axes.xaxis.label, axes.yaxis.label)
        if text.get_text()
    ]
    boxes = [(t.get_text(), t.get_window_extent()) for t in texts]
    return [(a, b) for i, (a, box) in enumerate(boxes) for b, other in boxes[i + 1 :] if box.overlaps(other)]
