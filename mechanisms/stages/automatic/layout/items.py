"""Items that take room: a shape in the plane that moves with a body, and the heights it reaches."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from mechanisms.stages.automatic.layout.planar import Rounded

# Items take room: a shape in the plane that moves with a body, and the heights that it reaches through.
#
# Heights are counted in half layers: layer k of plates is 2 k, the gap above it 2 k + 1; -1 is the gap above the base.

BASE = -1
TOP = 10**6
PIVOT = "pivot"
"""Kind of pivots on ground, which may stand beside each other."""

type Levels = Mapping[str, int]
"""The layer of each body, as far as it is decided; and the choices (0 or 1) of items that have one."""
type Ends = tuple[int | None, int | None]
"""Half layers from the lowest layer of some bodies to an item's lower end (None: it is the base), and from the highest
to its upper one (None: it goes up through all).
"""


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


@dataclass(frozen=True)
class Reach:
    """From the lowest layer of ``bodies`` plus ``low`` half layers to the highest plus ``high``.

    ``base``: from the base plate up; ``top``: up through all that is above.
    """

    bodies: tuple[str, ...]
    low: int = 0
    high: int = 0
    base: bool = False
    top: bool = False
    choice: ClassVar[None] = None
    """Name of the choice that decides between several ends; here there is one pair."""

    @property
    def ends(self) -> tuple[Ends, ...]:
        """Both ends, of each choice in turn."""
        return ((None if self.base else self.low, None if self.top else self.high),)


@dataclass(frozen=True)
class PinReach:
    """A pin between the plates of ``bodies``: its end is above them (``choice`` 0) or below (1)."""

    bodies: tuple[str, ...]
    choice: str

    ends: ClassVar[tuple[Ends, ...]] = ((1, 1), (-1, -1))


@dataclass(frozen=True)
class PivotReach:
    """A pin on ground that stands on the base (``choice`` 0), or hangs from a bridge above all layers (1).

    Among pivots that may do either, one that is ``driven`` stands. One that is ``flush`` may end in its body's plate.
    """

    bodies: tuple[str, ...]
    choice: str
    driven: bool = False
    flush: bool = False

    @property
    def ends(self) -> tuple[Ends, ...]:
        """Ends of a pin that stands, and of one that hangs."""
        return (None, 0 if self.flush else 1), (-1, None)


type AnyReach = Reach | PinReach | PivotReach


@dataclass(frozen=True, eq=False)
class Item:
    """One thing that takes room. ``what`` names it in messages.

    Bodies in ``spares`` may pass through it by design.
    """

    what: str
    body: str
    shape: Rounded
    reach: AnyReach
    spares: frozenset[str] = frozenset()
    source: object = None
    """The feature that it belongs to."""
    meshes: frozenset[str] = frozenset()
    """Names of items that it touches by design."""
    only: frozenset[str] = frozenset()
    """Names of the items that it keeps away, where it is no thing but a rule; empty: all."""
    spared: bool = True
    """True if items that spare its body spare it, too."""
    stands: str = ""
    """A word for what stands on ground; what has another such word must keep clear of it."""


def spans_meet(a: tuple[int, int] | None, b: tuple[int, int] | None) -> bool:
    """Return True if two spans share a half layer."""
    return a is not None and b is not None and a[0] <= b[1] and b[0] <= a[1]


def span(reach: AnyReach, levels: Levels) -> tuple[int, int] | None:
    """Return the lowest and highest half layer, as far as layers are decided.

    More decided layers only make it longer.

    While a choice is open: what both have in common.
    """
    chosen = levels.get(reach.choice) if reach.choice is not None else 0
    known = [2 * levels[body] for body in reach.bodies if body in levels]
    ends = reach.ends if chosen is None else reach.ends[chosen : chosen + 1]
    spans = [_placed(low, high, known) for low, high in ends]
    if any(span is None for span in spans):
        return None
    low, high = max(span[0] for span in spans if span), min(span[1] for span in spans if span)
    return (low, high) if low <= high else None


def _placed(low: int | None, high: int | None, known: list[int]) -> tuple[int, int] | None:
    if not known:
        return (BASE, BASE) if low is None else None
    return BASE if low is None else min(known) + low, TOP if high is None else max(known) + high


# From layers to heights: every gap as high as what is in it needs, and no higher.

ROOF = 12.0
"""From the highest layer to bridges above it (rmm): room for heads of pins, weights and the like."""


@dataclass(frozen=True)
class Heights:
    """Heights above the base plate (rmm)."""

    levels: Levels
    thickness: float
    bottoms: tuple[float, ...]
    """Underside of each layer."""

    @property
    def roof(self) -> float:
        """Underside of bridges."""
        return self.bottoms[-1] + self.thickness + ROOF

    def bottom(self, body: str) -> float:
        """Return the underside of a body's plate."""
        return self.bottoms[self.levels[body]]

    def top(self, body: str) -> float:
        """Return the upper face of a body's plate."""
        return self.bottom(body) + self.thickness

    def between(self, first: str, second: str, from_first: float, from_second: float) -> tuple[float, float]:
        """Return the range between two plates, less a gap to each of them."""
        if self.bottom(first) < self.bottom(second):
            return self.top(first) + from_first, self.bottom(second) - from_second
        return self.top(second) + from_second, self.bottom(first) - from_first


def heights(
    levels: Mapping[str, int], bodies: Iterable[str], thickness: float, needs: Iterable[Need], least: float
) -> Heights:
    """Stack the layers; ``least`` is the smallest gap (rmm)."""
    count = max((levels[body] for body in bodies), default=0) + 1
    gaps = dict.fromkeys(range(-1, count - 1), least)
    for need in needs:
        if need.gap in gaps:
            gaps[need.gap] = max(gaps[need.gap], need.height)
    z, bottoms = 0.0, []
    for level in range(count):
        z += gaps[level - 1]
        bottoms.append(z)
        z += thickness
    return Heights(levels, thickness, tuple(bottoms))
