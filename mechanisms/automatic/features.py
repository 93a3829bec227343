"""What a kind of joint puts on its bodies, and the registry of kinds; the package's docstring says how to add one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.joint import Joint
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.items import Item, Levels
    from mechanisms.automatic.layout import Layout
    from mechanisms.automatic.plan import Plan


@dataclass(frozen=True)
class Anchor:
    """A place (rmm, body frame) that the outline of ``body`` goes round with ``radius``."""

    body: str
    x: float
    y: float
    radius: float


@dataclass(frozen=True)
class Need:
    """The gap above layer ``gap`` (-1: above the base) is at least ``height`` rmm."""

    gap: int
    height: float


class Feature(Protocol):
    """One joint, or several that are one thing such as links on a common pin."""

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Where outlines of bodies must reach."""
        ...

    def items(self, layout: Layout) -> Iterable[Item]:
        """What takes room besides the bodies' own plates."""
        ...

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """How high gaps must be, once the layers are known."""
        ...

    def build(self, plan: Plan, heights: Heights) -> None:
        """Give eyes to the bodies and solids to the plan."""
        ...


type Gather = Callable[[Mechanism, list[Joint], Layout], list[Feature]]
"""The features of all joints of one kind."""

KINDS: dict[str, Gather] = {}


def kind(name: str) -> Callable[[Gather], Gather]:
    """Enter the features of a kind of joint."""

    def enter(gather: Gather) -> Gather:
        if name in KINDS:
            raise ValueError(f"{name}: registered twice")
        KINDS[name] = gather
        return gather

    return enter
