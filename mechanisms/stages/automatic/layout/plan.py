"""The plan of the parts: the eyes, feet and solids that kinds of joints, forces and contacts add."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import singledispatch
from typing import Any, Protocol

import cadquery as cq

from mechanisms.stages.automatic.layout.items import Heights
from mechanisms.stages.automatic.layout.layout import Carrier, Feature, Layout
from mechanisms.stages.automatic.layout.sizes import Kinds
from shared.contract.parts import Mount
from shared.shapes.link import Eye
from shared.shapes.outline import Circle
from shared.shapes.solid import Solid

# Features of kinds of joints, forces and contacts, and the registries; the package's docstring says how.

KINDS: Kinds[Sequence[Feature]] = Kinds()
"""By the name of a joint's kind, what returns the features of all its joints. Without it a joint has no parts."""
FORCE_KINDS: Kinds[Sequence[Feature]] = Kinds()
"""By the name of a force's kind. A force whose kind is not here needs no part."""
CONTACT_KINDS: Kinds[Sequence[Feature]] = Kinds()
"""By the name of a contact's kind. A contact whose kind is not here needs no part."""
DRIVER_KINDS: Kinds[Sequence[Feature]] = Kinds()
"""By the name of a driver's kind. A driver whose kind is not here needs no part: it is what turns a pin, or pushes."""
kind, force_kind, contact_kind, driver_kind = KINDS.enter, FORCE_KINDS.enter, CONTACT_KINDS.enter, DRIVER_KINDS.enter
"""Decorators of functions (mechanism, joints, layout) that return features."""


@singledispatch
def build(feature: Any, plan: Plan, heights: Heights) -> None:
    """Give eyes to the bodies and solids to the plan.

    A file of solids has registered how, else the feature itself says so.
    """
    feature.build(plan, heights)


# The result of all features: eyes of every body, feet on the base, and solids, each with a name of its own.

BOLT_HOLE = 9.0
"""Depth of the holes in the base for the screws of its feet (rmm)."""


@dataclass(frozen=True)
class Foot:
    """Something that stands on the base plate (rmm)."""

    label: str
    x: float
    y: float
    radius: float
    holes: tuple[tuple[float, float], ...] = ()
    """Places of its screws."""
    dial: bool = False
    road: bool = False
    """True if it is of a road, which may be the ground itself."""


@dataclass(frozen=True)
class Plate:
    """A wheel, a cam, a shoe: part of a body's plate (rmm)."""

    shape: cq.Workplane
    holds: Circle
    """x, y, radius of a circle that is solid."""
    through_holes: int


@dataclass(frozen=True)
class Mark:
    """A word that is engraved, its middle at (x, y) in the frame of its body (rmm)."""

    word: str
    x: float
    y: float
    height: float


class Carried(Protocol):
    """A round part that runs on something."""

    body: str


@dataclass(eq=False)
class Plan:
    """Filled by the features, read by those who build bodies and base."""

    layout: Layout
    materials: dict[str, str]
    eyes: dict[str, list[tuple[float, float, Eye]]] = field(default_factory=dict)
    feet: list[Foot] = field(default_factory=list)
    solids: dict[str, list[Solid]] = field(default_factory=dict)
    cuts: dict[str, list[tuple[cq.Workplane, int]]] = field(default_factory=dict)
    wheels: dict[str, Carrier] = field(default_factory=dict)
    """By body: a wheel that is its plate, or a part of it."""
    slots: dict[str, list[list[tuple[float, float]]]] = field(default_factory=dict)
    """By body: middles of the two ends of each of its slots; a wall is round them."""
    plates: dict[str, list[Plate]] = field(default_factory=dict)
    marks: dict[str, list[Mark]] = field(default_factory=dict)
    """Words on the upper face of a body's plate."""
    outer: dict[Carried, str] = field(default_factory=dict)
    """By round part: the piece that touches what it runs on."""
    pressing: list[tuple[Carried, str, str]] = field(default_factory=list)
    """Round parts, and the bodies and pieces into which they press."""
    base_under: list[tuple[float, float]] = field(default_factory=list)
    """Places that the base plate has to reach."""
    mount: Mount = Mount()
    """How ground stands."""
    names: set[str] = field(default_factory=set)
    main: dict[str, str] = field(default_factory=dict)
    """Names of the main pieces."""

    def eye(self, body: str, x: float, y: float, eye: Eye) -> None:
        """An eye of a body's plate at (x, y) in its frame."""
        self.eyes.setdefault(body, []).append((x, y, eye))

    def plate(self, body: str, shape: cq.Workplane, holds: Circle, through_holes: int = 0) -> None:
        """Join ``shape`` (z = 0 is the underside) to a body's plate.

        Eyes within the circle ``holds`` need no link.
        """
        self.plates.setdefault(body, []).append(Plate(shape, holds, through_holes))

    def cut(self, body: str, tool: cq.Workplane, through_holes: int) -> None:
        """Take ``tool`` (z = 0 is the plate's underside) out of a body's plate."""
        self.cuts.setdefault(body, []).append((tool, through_holes))

    def add(self, body: str, *solids: Solid) -> None:
        """Solids that move with ``body``."""
        kept = self.solids.setdefault(body, [])
        kept += [replace(s, name=self.named(s.name)) for s in solids]

    def make(self, body: str, name: str, shape: cq.Workplane, material: str, through_holes: int, buy: str = "") -> str:
        """Add one solid; return the name that it gets."""
        self.add(body, Solid(name, shape, material, through_holes, buy=buy))
        return self.solids[body][-1].name

    def pressed_into(self, body: str, piece: str, parts: Iterable[Carried]) -> None:
        """A piece of ``body`` carries round parts; note those that are seen to press into it."""
        yielding = self.layout.yielding
        self.pressing += [(part, body, piece) for part in parts if frozenset((part.body, body)) in yielding]

    def reserve(self, bodies: list[str]) -> None:
        """Main pieces are called like their bodies."""
        for body in bodies:
            self.main[body] = self.named(body)

    def named(self, wish: str) -> str:
        """Return a name that no other solid has."""
        return free_name(wish, self.names)


def free_name(wish: str, taken: set[str]) -> str:
    """Return a name of letters, digits and _ that is not ``taken``, and enter it there.

    It is entered in lower case: some disks take upper and lower case for one.
    """
    name = re.sub(r"\W", "_", wish, flags=re.ASCII)
    name = name if name[:1].isalpha() else f"part_{name}"
    free, number = name, 1
    while free.lower() in taken:
        number += 1
        free = f"{name}_{number}"
    taken.add(free.lower())
    return free
