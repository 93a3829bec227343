"""What a kind of joint, force or contact puts on its bodies, and the registries; the package's docstring says how."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import singledispatch
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mbsd import Mechanism
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Feature, Layout
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan


type Gather[Thing] = Callable[[Mechanism, list[Thing], Layout], Sequence[Feature]]
"""The features of all joints (forces, contacts) of one kind."""

KINDS: dict[str, Gather[Joint]] = {}
"""By the name of a joint's kind. A joint whose kind is not here has no automatic parts."""
FORCE_KINDS: dict[str, Gather[Force]] = {}
"""By the name of a force's kind. A force whose kind is not here needs no part."""
CONTACT_KINDS: dict[str, Gather[Joint]] = {}
"""By the name of a contact's kind. A contact whose kind is not here needs no part."""


DRIVER_KINDS: dict[str, Gather[Joint]] = {}
"""By the name of a driver's kind. A driver whose kind is not here needs no part: it is what turns a pin, or pushes."""


@singledispatch
def build(feature: Any, plan: Plan, heights: Heights) -> None:
    """Give eyes to the bodies and solids to the plan: as a file of solids has registered, else the feature itself."""
    feature.build(plan, heights)


def kind(name: str) -> Callable[[Gather[Joint]], Gather[Joint]]:
    """Enter the features of a kind of joint."""
    return _enter(KINDS, name)


def force_kind(name: str) -> Callable[[Gather[Force]], Gather[Force]]:
    """Enter the features of a kind of force."""
    return _enter(FORCE_KINDS, name)


def contact_kind(name: str) -> Callable[[Gather[Joint]], Gather[Joint]]:
    """Enter the features of a kind of contact."""
    return _enter(CONTACT_KINDS, name)


def driver_kind(name: str) -> Callable[[Gather[Joint]], Gather[Joint]]:
    """Enter the features of a kind of driver."""
    return _enter(DRIVER_KINDS, name)


def _enter[Thing](kinds: dict[str, Gather[Thing]], name: str) -> Callable[[Gather[Thing]], Gather[Thing]]:
    def enter(gather: Gather[Thing]) -> Gather[Thing]:
        if name in kinds:
            raise ValueError(f"{name}: registered twice")
        kinds[name] = gather
        return gather

    return enter
