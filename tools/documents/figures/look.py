"""The common look of the pictures of docs/: style, colours, plain axes, words with a line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mbsd.drawing.look import FAINT, INK, MOVED, PALETTE, QUIET, WRONG

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLUE, GREEN, PURPLE, GOLD = PALETTE[:4]
__all__ = ["BLUE", "FAINT", "GOLD", "GREEN", "INK", "MOVED", "PURPLE", "QUIET", "STYLE", "WRONG", "note", "plain"]

STYLE: dict[str, Any] = {
    "svg.hashsalt": "mbsd",
    "svg.fonttype": "path",
    "figure.facecolor": "white",
    "font.size": 10,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.labelcolor": INK,
    "axes.edgecolor": QUIET,
    "axes.linewidth": 0.8,
    "xtick.color": INK,
    "ytick.color": INK,
    "text.color": INK,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "path.simplify": True,
    "path.simplify_threshold": 0.02,
}


def plain(ax: Axes, **labels: Any) -> Axes:
    """Axes without a box, with a faint grid; ``labels`` go to ``ax.set``."""
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_axisbelow(True)
    ax.grid(color=FAINT, linewidth=0.8)
    ax.set(**labels)
    return ax


def note(ax: Axes, text: str, xy: tuple[float, float], at: tuple[float, float], colour: str = INK) -> None:
    """Words at ``at`` (points from the place) with a thin line to the place ``xy`` (data)."""
    ax.annotate(
        text,
        xy=xy,
        xytext=at,
        textcoords="offset points",
        color=colour,
        fontsize=9,
        ha="center",
        va="center",
        arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8, "shrinkA": 2, "shrinkB": 3},
    )
