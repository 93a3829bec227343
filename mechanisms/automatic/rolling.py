"""Discs that roll on a line or a terrain of ground: a wheel with a tyre, and the road as a wall on the base.

Wheel and road touch by design; they are made with the clearance of a cam and its roller.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.automatic.cams import CLEAR
from mechanisms.automatic.extents import Extent, extent
from mechanisms.automatic.features import Anchor, Feature, Need, kind
from mechanisms.automatic.items import Item, Reach
from mechanisms.automatic.planar import around, disc
from mechanisms.automatic.rolling_solids import ROAD, rolling_solids
from shared.errors import UserError

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.joint import Joint
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.items import Levels
    from mechanisms.automatic.layout import Layout
    from mechanisms.automatic.plan import Plan

BEYOND = 0.8
"""How far a straight road goes on beyond the wheel's travel, in the wheel's radii."""
PIECES = 48
"""Of a terrain in the plane."""
LEAST = 16.0
"""Least radius of a wheel (rmm)."""


@dataclass(frozen=True, eq=False)
class Rolling:
    """A wheel and its road (rmm)."""

    name: str
    wheel: str
    at: tuple[float, float]
    """The wheel's centre in its body."""
    radius: float
    """As it is made."""
    road: np.ndarray
    """(n, 2) the road's surface on ground; the wheel is on its left."""

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """The wheel's hub."""
        return [Anchor(self.wheel, *self.at, layout.sizes.eye)]

    def items(self, layout: Layout) -> Iterable[Item]:
        """The wheel, and the road at its height and below."""
        yield Item(
            f"the wheel of {self.name}", self.wheel, disc(*self.at, self.radius), Reach((self.wheel,)), source=self
        )
        reach, spares = Reach((self.wheel,), base=True), frozenset((self.wheel,))
        for a, b in pairwise(self.road[:: max(1, len(self.road) // PIECES)]):
            foot = [(p + self.depth(p) * self.under) for p in (a, b)]
            piece = around([(float(x), float(y)) for x, y in (a, b, *foot)], 0.2)
            yield Item(f"the road of {self.name}", "ground", piece, reach, spares, self)

    @property
    def under(self) -> np.ndarray:
        """(2,): the direction from the road's ends to its straight lower side."""
        along = self.road[-1] - self.road[0]
        return np.array([along[1], -along[0]]) / np.hypot(*along)

    def depth(self, place: np.ndarray) -> float:
        """From a place to the lower side."""
        return float(((self.road - place) @ self.under).max()) + ROAD

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing."""
        return []

    def build(self, plan: Plan, heights: Heights) -> None:
        """Wheel, tyre and road."""
        rolling_solids(self, plan, heights)


@kind("rolling_disc")
def on_lines(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """One for each joint."""
    found: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        start, angle = np.array(layout.place(joint.i)), joint.i.angle
        along = np.array([math.cos(angle), math.sin(angle)])
        travel = (layout.seen(joint.j.body.name, layout.place(joint.j), "ground") - start) @ along
        beyond = BEYOND * layout.sizes.of_metres(joint.params["radius"])
        ends = np.array([travel.min() - beyond, travel.max() + beyond])
        found.append(_rolling(joint, start + ends[:, None] * along, layout))
    return found


@kind("rolling_on_curve")
def on_curves(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """One for each joint."""
    from mbsd.curve_numbers import curve_pieces

    found: list[Feature] = []
    for joint in joints:
        _refuse(m, joint)
        if joint.params["closed"]:
            raise UserError(
                f"{m.name}: joint '{joint.name}' rolls on a closed curve, which has no parts by itself yet; "
                f"write mechanisms/{m.name}/parts.py"
            )
        breaks, coefficients = curve_pieces(np.array(joint.params["points"], dtype=float), False)
        end = (coefficients[-1] * (breaks[-1] - breaks[-2]) ** np.arange(6)).sum(axis=1)
        path = layout.sizes.of_metres(1.0) * np.vstack([coefficients[:, :, 0], end])
        c, s = math.cos(joint.i.angle), math.sin(joint.i.angle)
        found.append(_rolling(joint, path @ np.array([[c, s], [-s, c]]) + layout.place(joint.i), layout))
    return found


def _rolling(joint: Joint, road: np.ndarray, layout: Layout) -> Rolling:
    radius = layout.sizes.of_metres(joint.params["radius"]) - CLEAR * layout.sizes.pivot.fit.running
    return Rolling(joint.name, joint.j.body.name, layout.place(joint.j), radius, road)


def _refuse(m: Mechanism, joint: Joint) -> None:
    if joint.i.body.name != "ground" or joint.j.body.name == "ground":
        raise UserError(
            f"{m.name}: joint '{joint.name}' is a {joint.kind.name.replace('_', ' ')} whose road is not on ground; "
            f"it has no parts by itself yet; write mechanisms/{m.name}/parts.py"
        )


@extent("rolling_disc")
@extent("rolling_on_curve")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """The wheel."""
    radius = joint.params["radius"]
    return Extent(((joint.j, radius),), ((radius, LEAST),))
