"""What takes room: a shape in the plane that moves with a body, and the heights it reaches through.

Heights are counted in half layers: layer k of plates is 2 k, the gap above it 2 k + 1; -1 is the gap above the base.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from mechanisms.automatic.planar import Rounded

BASE = -1
TOP = 10**6

type Levels = Mapping[str, int]
"""The layer of each body, as far as it is decided; and the choices (0 or 1) of items that have one."""


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

    def span(self, levels: Levels) -> tuple[int, int] | None:
        """Lowest and highest half layer, as far as layers are decided: more decided ones only make it longer."""
        known = [2 * levels[body] for body in self.bodies if body in levels]
        if not known:
            return (BASE, BASE) if self.base else None
        return (
            BASE if self.base else min(known) + self.low,
            TOP if self.top else max(known) + self.high,
        )


@dataclass(frozen=True)
class PinReach:
    """A pin between the plates of ``bodies``, with an end above the highest (``choice`` 0) or under the lowest (1)."""

    bodies: tuple[str, ...]
    choice: str
    base = top = False

    def span(self, levels: Levels) -> tuple[int, int] | None:
        """As :meth:`Reach.span`; while the choice is open, without an end."""
        known = [2 * levels[body] for body in self.bodies if body in levels]
        if not known:
            return None
        chosen = levels.get(self.choice)
        low, high = min(known) + 1, max(known) - 1
        span = low - 2 if chosen == 1 else low, high + 2 if chosen == 0 else high
        return span if span[0] <= span[1] else None


@dataclass(frozen=True, eq=False)
class Item:
    """One thing that takes room. ``what`` names it in messages; bodies in ``spares`` may pass through it by design."""

    what: str
    body: str
    shape: Rounded
    reach: Reach | PinReach
    spares: frozenset[str] = frozenset()
    source: object = None
    """The feature that it belongs to."""
    meshes: frozenset[str] = frozenset()
    """Names of items that it touches by design."""
    only: frozenset[str] = frozenset()
    """Names of the items that it keeps away, where it is no thing but a rule; empty: all."""


def spans_meet(a: tuple[int, int] | None, b: tuple[int, int] | None) -> bool:
    """Whether two spans share a half layer."""
    return a is not None and b is not None and a[0] <= b[1] and b[0] <= a[1]
