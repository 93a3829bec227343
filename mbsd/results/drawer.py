"""Requests of a solution to be drawn; whoever made the mechanism brings the drawer."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, runtime_checkable

from mbsd.base.errors import ModelError
from mbsd.model.mechanism import Model
from mbsd.pictures import Animation, Picture, View

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Motion = TypeVar("Motion", contravariant=True)
"""A solution."""


class Drawer(Protocol[Motion]):
    """Draws solutions; the arguments are those of the methods of :class:`mbsd.results.solution.Solution`."""

    def draw(
        self, sol: Motion, t: float | None, step: int | None, ax: Axes | None, frames: bool, names: bool
    ) -> Picture:
        """One pose."""
        ...

    def animate(
        self,
        sol: Motion,
        path: str | os.PathLike[str],
        show: str | Sequence[str],
        rate: float | None,
        fps: float,
        size: tuple[int, int] | None,
        names: bool | str,
        progress: Callable[[int, int], object] | None,
    ) -> Animation:
        """A film of the motion."""
        ...

    def view(self, sol: Motion, path: str | os.PathLike[str] | None, height: float) -> View:
        """A page with the motion."""
        ...


@runtime_checkable
class HasDrawer(Protocol):
    """A mechanism whose solutions can be drawn."""

    @property
    def drawer(self) -> Drawer[Any]:
        """The drawer of solutions."""
        ...


def drawer_of(mechanism: Model) -> Drawer[Any]:
    """Return the drawer of a mechanism's solutions. Raises ModelError where it brings none."""
    if not isinstance(mechanism, HasDrawer):
        kind = type(mechanism).__name__
        raise ModelError(f"{mechanism.name}: solutions of a {kind} are not drawn; build an mbsd.Mechanism")
    return mechanism.drawer
