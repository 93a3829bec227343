"""Means against shaking: counterweights on the bodies of a mechanism, balance shafts beside them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbsd.base.arguments import finite_number, number_pair, positive_number
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting
from mbsd.model.body import Marker


@dataclass(frozen=True)
class Counterweight(Suggesting):
    """A point mass on a body, at a given radius about a marker.

    Its mass and its direction are sought.
    """

    about: Marker
    """Place on the body that carries it, such as the pin on which that turns."""
    radius: float
    """Distance from the marker (m)."""
    largest: float = math.inf
    """No heavier than this (kg)."""
    z: float | None = None
    """Place along the normal of the plane (m); None: that of the marker."""

    def __post_init__(self) -> None:
        if not isinstance(self.about, Marker):
            raise ModelError(
                "balance: about of a counterweight must be a marker on its body: crank.start, body.at(x, y)"
            )
        if self.about.body.name == "ground":
            raise ModelError("balance: a counterweight on ground balances nothing; give a marker on a body that moves")
        positive_number(f"balance: radius (m) of the counterweight on '{self.body}'", self.radius)
        if self.largest != math.inf:
            positive_number(f"balance: largest mass (kg) of the counterweight on '{self.body}'", self.largest)
        if self.z is not None:
            finite_number(f"balance: z (m) of the counterweight on '{self.body}'", self.z)

    @property
    def body(self) -> str:
        """Name of the body."""
        return self.about.body.name

    @property
    def plane(self) -> float:
        """Place along the normal of the plane (m)."""
        return self.z if self.z is not None else self.about.plane or 0.0


@dataclass(frozen=True)
class BalanceShaft(Suggesting):
    """A shaft with an eccentric mass that turns ``ratio`` times as fast as the crank.

    Below 0 it turns the other way round.
    """

    ratio: float
    at: tuple[float, float] = (0.0, 0.0)
    """Place of its axis on ground (m)."""
    largest: float = math.inf
    """Mass times radius is at most this (kg m)."""
    z: float = 0.0
    """Place of the mass along the normal of the plane (m)."""

    def __post_init__(self) -> None:
        what = f"a balance shaft of ratio {self.ratio}"
        if finite_number(f"balance: ratio of {what}", self.ratio) == 0.0:
            raise ModelError("balance: ratio of a balance shaft is 0, so it would not turn; 2 and -2 are usual")
        number_pair(f"balance: at (m) of {what}", self.at)
        finite_number(f"balance: z (m) of {what}", self.z)
        if self.largest != math.inf:
            positive_number(f"balance: largest mass times radius (kg m) of {what}", self.largest)
