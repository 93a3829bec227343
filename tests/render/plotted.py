"""Plots of motions for the tests that look at them, and the texts on them."""

from __future__ import annotations

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


def overlaps(drawn: Figure) -> list[tuple[str, str]]:
    """Pairs of labels that cover each other."""
    drawn.canvas.draw()
    texts = [t for axes in drawn.axes for t in axes.texts if t.get_text()]
    boxes = [(t.get_text(), t.get_window_extent()) for t in texts]
    return [(a, b) for i, (a, box) in enumerate(boxes) for b, other in boxes[i + 1 :] if box.overlaps(other)]
