"""The door from results to their pictures: a solution draws and animates itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mbsd.drawing.animation.animate import Animation, animate
from mbsd.drawing.picture import Picture
from mbsd.drawing.pose import pose_of
from mbsd.drawing.skeleton import draw
from mbsd.drawing.view.page import View, view

if TYPE_CHECKING:
    from mbsd.results.solution import Solution

__all__ = ["Animation", "Picture", "View", "animate", "draw_at", "view"]


def draw_at(sol: Solution, t: float | None, step: int | None, ax: Any, frames: bool, names: bool) -> Picture:
    """See :meth:`mbsd.results.solution.Solution.draw`."""
    return draw(sol.mechanism, pose_of(sol, t, step), ax, frames, names)
