"""Solutions drawn, animated and shown as a page."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from mbsd.drawing.animation.animate import animate
from mbsd.drawing.pose import pose_of
from mbsd.drawing.skeleton import draw
from mbsd.drawing.web_page import view
from mbsd.pictures import Animation, Picture, View
from mbsd.results.solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class SkeletonDrawer:
    """Draws the skeleton of a solution; see :class:`mbsd.results.drawer.Drawer`."""

    def draw(
        self, sol: Solution, t: float | None, step: int | None, ax: Axes | None, frames: bool, names: bool
    ) -> Picture:
        """See :meth:`mbsd.results.solution.Solution.draw`."""
        return draw(sol.mechanism, pose_of(sol, t, step), ax, frames, names)

    def animate(
        self,
        sol: Solution,
        path: str | os.PathLike[str],
        show: str | Sequence[str],
        rate: float | None,
        fps: float,
        size: tuple[int, int] | None,
        names: bool | str,
        progress: Callable[[int, int], object] | None,
    ) -> Animation:
        """See :meth:`mbsd.results.solution.Solution.animate`."""
        return animate(sol, path, show, rate, fps, size, names, progress)

    def view(self, sol: Solution, path: str | os.PathLike[str] | None, height: float) -> View:
        """See :meth:`mbsd.results.solution.Solution.view`."""
        return view(sol, path, height)
