"""What a force is made of, and the registry that one test walks through.

A force is one scalar element or several, and the magnitude of an element is a sum of terms. An element measures a
scalar x of two markers and acts along it, so that a positive magnitude F makes x grow:

    LINE   x = |p_j - p_i|                  F along the line, apart
    TURN   x = theta_j - theta_i            F is a torque on j, -F on i
    AXIS   x = u_i . (p_j - p_i)            F along the x axis of marker i
    PUSH   x = t                            F on body j at marker j, along the x axis of marker i; i feels nothing

    generalised force  Q = F (dx/dq)^T;     power F x'

    CONSTANT   a                            LAW_VALUE   a law(x)
    LINEAR     -a (x - b)                   LAW_RATE    a law(x')
    DAMPING    -a x'                        LAW_TIME    a law(t)
    POWER      a (x + b)^c                  DRY         -a tanh(x' / b)

What no element can say is an interaction: a function of the relative pose and velocity of two markers in a file of
mbsd/interactions. A function of the user stands in the params as ``function``. A friction of a joint is none of these.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from mbsd.body import Marker
    from mbsd.force import Force
    from mbsd.model import Mechanism
    from mbsd.packing import Packed

LINE, TURN, AXIS, PUSH = 0, 1, 2, 3
CONSTANT, LINEAR, DAMPING, POWER, LAW_VALUE, LAW_RATE, LAW_TIME, DRY = 0, 1, 2, 3, 4, 5, 6, 7
POTENTIAL_TERMS = (LINEAR, POWER, LAW_VALUE)
"""Terms that count as potential energy; the others do work."""


@dataclass(frozen=True)
class Term:
    """One term of a magnitude; ``law`` names one of the force's laws."""

    kind: int
    a: float = 1.0
    b: float = 0.0
    c: float = 0.0
    law: str | None = None


@dataclass(frozen=True)
class Element:
    """One scalar element. ``turned`` turns the x axis of marker i by a right angle (AXIS, PUSH)."""

    kind: int
    terms: tuple[Term, ...]
    turned: bool = False


@dataclass(frozen=True)
class Interaction:
    """A function in mbsd/interactions between two markers, its numbers, and the law of time it reads."""

    function: str
    i: Marker
    j: Marker
    numbers: Sequence[float]
    law: str | None = None


@dataclass(frozen=True)
class Foot:
    """Where a disc stands to a surface, (T, ...) arrays in the world's axes."""

    gap: np.ndarray
    """(T,) distance of the surface less the disc's radius (m)."""
    place: np.ndarray
    """(T, 2) nearest point of the surface (m)."""
    normal: np.ndarray
    """(T, 2) unit, out of the surface."""


def _no_elements(force: Force) -> tuple[Element, ...]:
    return ()


def _no_interactions(force: Force, packed: Packed) -> Sequence[Interaction]:
    return ()


@dataclass(frozen=True)
class ForceKind:
    """A kind of force."""

    name: str
    elements: Callable[[Force], tuple[Element, ...]] = _no_elements
    """What a force of this kind is made of."""
    example: Callable[[Mechanism, Marker, Marker], object] | None = None
    """Adds one of this kind between two markers of different bodies; must be given."""
    interactions: Callable[[Force, Packed], Sequence[Interaction]] = _no_interactions
    """Beside its elements."""
    potential: Callable[[Force, Packed, np.ndarray], np.ndarray] | None = None
    """(T,) potential energy (J) of its interactions along poses (T, 3 nb), if they have one at rest."""
    surface: Callable[[Force, Packed, np.ndarray], Foot] | None = None
    """Of a contact of marker j with a surface of marker i: where it touches along poses (T, 3 nb)."""
    outside: bool = False
    """Whether it is a load from outside, to which nothing in the mechanism feels the opposite."""
    of_reactions: bool = False
    """Whether it is friction, which comes from the reaction of a joint; see mbsd/joint_friction.py."""
    saved: bool = True
    """Whether a file can hold its params; a Python function cannot be saved."""


FORCE_KINDS: dict[str, ForceKind] = {}


def register(kind: ForceKind) -> ForceKind:
    """Enter a kind; raises ValueError if its name is taken or the example missing."""
    if not callable(kind.example):
        raise ValueError(f"{kind.name}: an example is missing; the registry test needs one")
    if kind.name in FORCE_KINDS:
        raise ValueError(f"{kind.name}: registered twice")
    FORCE_KINDS[kind.name] = kind
    return kind
