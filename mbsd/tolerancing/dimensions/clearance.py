"""Pins with play: how much of it there is, and to which side the pin lies in its bore.

A pin touches its bore: the gap is a massless link of half the play between the two centres (Wu, Earles, A determination
of contact-loss at a bearing of a linkage mechanism, J. Eng. for Industry 99, 1977). It points along the reaction that
the pin of the ideal mechanism carries, so the centre of the second body's marker lies behind that of the first body's
by half the play against the force on the second body. Where there is no force, it points anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mbsd.base.arguments import not_negative_number
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, no_such
from mbsd.tolerancing.dimensions.spreads import Normal, Spread, Triangular, Uniform
from mbsd.tolerancing.dimensions.standards import fit

DIRECTIONS = ("auto", "reaction", "any")
SPREADS: dict[str, type[Spread]] = {"normal": Normal, "uniform": Uniform, "triangular": Triangular}


@dataclass(frozen=True)
class Clearance(Suggesting):
    """A pin with ``play`` (m, difference of the diameters) in its bore, give or take ``tolerance`` (m).

    The pin's centre lies half the play off the centre of its bore, by ``direction``: "reaction", against the force that
    the ideal mechanism's sweep gives, at each time; "any", where all directions in the frame of the joint's first body
    are equally likely, and the worst is taken where the worst is asked for; "auto", the first where the pin carries
    anything. ``spread``: "normal", "uniform" or "triangular" over the tolerance. Raises ModelError for play below 0.
    """

    play: float
    tolerance: float = 0.0
    direction: str = "auto"
    spread: str = "normal"

    def __post_init__(self) -> None:
        play = not_negative_number("Clearance: play", self.play, "m")
        tolerance = not_negative_number("Clearance: tolerance", self.tolerance, "m")
        if play + tolerance == 0.0:
            raise ModelError("Clearance: play is 0 m; leave out a pin without play")
        if tolerance > play:
            raise ModelError(
                f"Clearance: the tolerance {tolerance:g} m is wider than the play {play:g} m; where the pin is "
                "larger than its bore it does not turn"
            )
        if self.direction not in DIRECTIONS:
            raise ModelError(f"Clearance: {no_such('direction', self.direction, DIRECTIONS)}")
        if self.spread not in SPREADS:
            raise ModelError(f"Clearance: {no_such('spread', self.spread, SPREADS)}")

    @classmethod
    def from_fit(cls, diameter: float, name: str, direction: str = "auto", spread: str = "normal") -> Clearance:
        """The play of a fit of ISO 286-1 at a ``diameter`` (m), such as "H7/g6", with its tolerance.

        Raises ModelError for a fit that there is not, and for one whose pin may be larger than its bore: it turns
        only where there is play.
        """
        least, largest = fit(diameter, name)
        if least < 0.0:
            raise ModelError(
                f"Clearance: {name} at {diameter * 1e3:g} mm has a play of {least * 1e6:g} to {largest * 1e6:g} "
                "um; where "
                "the pin is larger it does not turn. Take a looser fit, such as H7/g6, or give Clearance(play, "
                "tolerance)"
            )
        return cls(0.5 * (least + largest), 0.5 * (largest - least), direction, spread)

    @property
    def limits(self) -> tuple[float, float]:
        """Least and largest play (m)."""
        return self.play - self.tolerance, self.play + self.tolerance

    @property
    def sizes(self) -> Any:
        """The Spread of the play about its nominal value; None where it is always the same."""
        return SPREADS[self.spread](self.tolerance) if self.tolerance else None
