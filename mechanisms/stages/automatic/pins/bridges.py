"""Bridges: pivots on ground over which links sweep from every side hang from a beam on two posts.

Posts stand beside all that moves: on either side of the pivot, past the last thing that comes into the beam's way. One
beam carries two pivots where that is shorter than a beam for each.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Need
from mechanisms.stages.automatic.layout.layout import Feature
from mechanisms.stages.automatic.layout.planar import Rounded, core_gaps, placed
from mechanisms.stages.automatic.pins.pin_solids import FOOT
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.springs.stretching import Stud
from mechanisms.stages.automatic.pins.swept import Swept
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.items import Item, Levels
    from mechanisms.stages.automatic.layout.layout import Layout

BEAM, POST = 26.0, FOOT
"""Width of a beam, and diameter of a post (rmm)."""
WAYS = 24
"""Directions that are tried for a beam, over half a turn."""
STEP = 4.0
"""Between points on the sides of what moves (rmm)."""
EVERY = 3
"""So many poses from one that is looked at to the next."""
APART = 6.0
"""Least gap between a post and all that moves, and between two beams (rmm)."""
FLANGE = 20.0
"""Room round a post at its foot, as for a pedestal (rmm)."""
LEAST = 26.0
"""From a pivot to the middle of a post (rmm)."""


@dataclass(frozen=True, eq=False)
class Bridge:
    """A beam between two posts (rmm), and the pins that hang from it."""

    ends: tuple[tuple[float, float], tuple[float, float]]
    pins: tuple[Pin, ...]

    @property
    def name(self) -> str:
        """Names of its pivots."""
        return "_".join(pin.name for pin in self.pins)

    @property
    def beam(self) -> Rounded:
        """In the plane."""
        return Rounded(np.array(self.ends), BEAM / 2)

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Its posts."""
        return [Anchor("ground", x, y, POST / 2) for x, y in self.ends]

    def items(self, layout: Layout) -> Iterable[Item]:
        """None: its place is chosen where nothing is in its way."""
        return []

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Nothing."""
        return []


def may_hang(layout: Layout) -> frozenset[str]:
    """Choices of the pivots that may hang: those on whose pin no spring ends."""
    pivots = [pin for pin in layout.features if isinstance(pin, Pin) and pin.on_ground]
    held = [stud.pin for stud in layout.features if isinstance(stud, Stud)]
    return frozenset(pin.choice for pin in pivots if pin not in held)


def bridges_over(layout: Layout, levels: Mapping[str, int]) -> list[Feature]:
    """For all pivots that hang by the choices in ``levels``. Raises UserError where a bridge has no place."""
    waiting = [pin for pin in layout.features if isinstance(pin, Pin) and pin.on_ground and levels[pin.choice] == 1]
    points, still = _points(layout, waiting)
    moving = Swept(points)
    bridges: list[Bridge] = []
    while waiting:
        beams = _candidates(waiting, moving, still)
        fitting = [beam for beam in beams if _has_room(beam, bridges, waiting)]
        if not fitting:
            raise UserError(
                f"{layout.m.name}: the pivot '{waiting[0].name}' must hang from a bridge, because links sweep over it "
                "from every side, and there is no place for one between the bridges of "
                f"{', '.join(bridge.name for bridge in bridges)}; move pivots apart, or shape them by hand in parts.py"
            )
        bridges.append(min(fitting, key=_cost))
        waiting = [pin for pin in waiting if pin not in bridges[-1].pins]
    return list(bridges)


def _cost(bridge: Bridge) -> float:
    """Length for each pivot; a hundredth more, the less it lies level, so that of equal ones the level one is taken."""
    (x0, y0), (x1, y1) = bridge.ends
    length = math.hypot(x1 - x0, y1 - y0)
    return round(length / len(bridge.pins) * (1.0 + 0.01 * abs(y1 - y0) / length), 6)


def _points(layout: Layout, hanging: Sequence[Pin]) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) each: places that moving items come to, and those of ground, with the gap (rmm) from a post's middle."""
    moving, still = [np.zeros((0, 3))], [np.zeros((0, 3))]
    for item in layout.items:
        if any(item.source is pin for pin in hanging):
            continue
        on_ground = item.body == "ground"
        poses = layout.poses[item.body]
        at = np.arange(0, 1 if on_ground else len(poses), EVERY)
        seen = placed(_sides(item.shape.core_at(at)), poses[at]).reshape(-1, 2)
        gap = item.shape.radius + (max(APART, FLANGE) + FLANGE if on_ground else APART + POST / 2)
        (still if on_ground else moving).append(np.column_stack([seen, np.full(len(seen), gap)]))
    return np.concatenate(moving), np.concatenate(still)


def _sides(core: np.ndarray) -> np.ndarray:
    """(..., m, 2): points on the sides of polygons (..., n, 2), STEP or less from each other."""
    way = np.roll(core, -1, axis=-2) - core
    count = max(1, math.ceil(float(np.linalg.norm(way, axis=-1).max()) / STEP))
    share = (np.arange(count) / count)[:, None]
    return (core[..., None, :] + way[..., None, :] * share).reshape(*core.shape[:-2], -1, 2)


def _candidates(waiting: Sequence[Pin], moving: Swept, still: np.ndarray) -> list[Bridge]:
    """Beams over the first of the pivots in all directions, and over it and another one."""
    first, *others = waiting
    at = np.array(first.places["ground"])
    beams = []
    for k in range(WAYS):
        way = np.array([math.cos(math.pi * k / WAYS), math.sin(math.pi * k / WAYS)])
        beams.append(Bridge((_post(at, -way, moving, still), _post(at, way, moving, still)), (first,)))
    for other in others:
        there = np.array(other.places["ground"])
        way = (there - at) / max(float(np.hypot(*(there - at))), 1e-9)
        beams.append(Bridge((_post(at, -way, moving, still), _post(there, way, moving, still)), (first, other)))
    return beams


def _post(at: np.ndarray, way: np.ndarray, moving: Swept, still: np.ndarray) -> tuple[float, float]:
    """The first place from ``at`` on in a direction that is past all that moves and clear of what stands."""
    outer = moving.outermost(at, way)
    along, aside = _along(outer, at, way)
    inside = np.abs(aside) < outer[:, 2]
    reach = float((along + np.sqrt(np.maximum(outer[:, 2] ** 2 - aside**2, 0.0)))[inside].max(initial=LEAST))
    along, aside = _along(still, at, way)
    near = np.abs(aside) < still[:, 2]
    half = np.sqrt(np.maximum(still[:, 2] ** 2 - aside**2, 0.0))
    for low, high in sorted(zip((along - half)[near], (along + half)[near], strict=True)):
        if low < reach < high:
            reach = float(high)
    return float(at[0] + reach * way[0]), float(at[1] + reach * way[1])


def _along(points: np.ndarray, at: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances along and across a ray."""
    seen = points[:, :2] - at
    return seen @ way, seen @ np.array([-way[1], way[0]])


def _has_room(bridge: Bridge, others: Sequence[Bridge], waiting: Sequence[Pin]) -> bool:
    """Whether it is clear of other beams, and of pivots that hang from others."""
    own = bridge.beam.core[None]
    for other in others:
        posts = np.array([[end] for end in other.ends])
        clear = FLANGE + FLANGE if core_gaps(own, other.beam.core[None])[0] >= BEAM + APART else math.inf
        if min(np.hypot(*(own[0] - post).T).min() for post in posts) < clear:
            return False
    away = [np.array([[pin.places["ground"]]]) for pin in waiting if pin not in bridge.pins]
    away += [np.array([[pin.places["ground"]]]) for other in others for pin in other.pins]
    return all(core_gaps(own, at)[0] >= BEAM + APART for at in away)
