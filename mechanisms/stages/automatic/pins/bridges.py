"""Bridges over pivots on ground: where they are needed, how far they reach, and their solids."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mechanisms.stages.automatic.layout.items import Anchor, Heights
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Plan, build
from mechanisms.stages.automatic.layout.planar import Rounded, core_gaps, placed
from mechanisms.stages.automatic.pins.pin_solids import FOOT, TOP, run, standing
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.springs import Stud
from shared.shapes import outline
from shared.shapes.base import column
from shared.shapes.build import bore, eased, extruded
from shared.shapes.pin import pin
from shared.shapes.solid import placed as placed_solid
from shared.stage.errors import UserError

# Discs that moving things sweep, in cells of the plane, so that of millions a ray looks at few.

FEW = 300_000
"""So many are looked at one by one."""
CELL = 8.0
"""Side of a cell (rmm)."""
LOOSE = 1e-6
"""Added to what is compared, well above rounding (rmm)."""


class Swept:
    """Discs (n, 3): x, y, radius (rmm)."""

    def __init__(self, discs: np.ndarray, few: int = FEW) -> None:
        self._discs, self._is_few = discs, len(discs) <= few
        if self._is_few:
            return
        cells = np.floor(discs[:, :2] / CELL).astype(np.int64)
        cells -= cells.min(axis=0)
        keys = cells[:, 0] * (cells[:, 1].max() + 1) + cells[:, 1]
        order = np.argsort(keys, kind="stable")
        self._discs = discs[order]
        self._starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
        self._ends = np.append(self._starts[1:], len(discs))
        self._centres = (np.floor(self._discs[self._starts, :2] / CELL) + 0.5) * CELL
        self._least = np.minimum.reduceat(self._discs[:, 2], self._starts)
        self._most = np.maximum.reduceat(self._discs[:, 2], self._starts)

    def outermost(self, at: np.ndarray, way: np.ndarray) -> np.ndarray:
        """Return (m, 3) some of the discs, among them the one that a ray along ``way`` leaves last."""
        if self._is_few:
            return self._discs
        seen, half = self._centres - at, CELL / np.sqrt(2.0) + LOOSE
        along, aside = seen @ way, np.abs(seen @ np.array([-way[1], way[0]]))
        surely = along[aside + half < self._least] - half
        may = (aside - half < self._most) & (along + half + self._most >= surely.max(initial=-np.inf))
        return np.concatenate(
            [self._discs[:0], *(self._discs[self._starts[k] : self._ends[k]] for k in may.nonzero()[0])]
        )


# Bridges: pivots on ground over which links sweep from every side hang from a beam on two posts.
#
# Posts stand beside all that moves: on either side of the pivot, past the last thing that comes into the beam's way.
# One beam carries two pivots where that is shorter than a beam for each.

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
class Bridge(Feature):
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
        """Return its posts."""
        return [Anchor("ground", x, y, POST / 2) for x, y in self.ends]


def may_hang(layout: Layout) -> frozenset[str]:
    """Return choices of the pivots that may hang: those on whose pin no spring ends."""
    pivots = [pin for pin in layout.select(Pin) if pin.on_ground]
    held = [stud.pin for stud in layout.select(Stud)]
    return frozenset(pin.choice for pin in pivots if pin not in held)


def bridges_over(layout: Layout, levels: Mapping[str, int]) -> list[Feature]:
    """Return bridges for all pivots that hang by the choices in ``levels``.

    Raises UserError where a bridge has no place.
    """
    waiting = [pin for pin in layout.select(Pin) if pin.on_ground and levels[pin.choice] == 1]
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
        bridges.append(min(fitting, key=lambda beam: _cost(beam, points)))
        waiting = [pin for pin in waiting if pin not in bridges[-1].pins]
    return list(bridges)


HIDES = 3.0
"""Cost of a beam that hides all that moves, beside that of its length."""


def _cost(bridge: Bridge, moving: np.ndarray) -> float:
    """Return the length of a beam for each pivot, more the more of ``moving`` it hides, and the less it lies level."""
    (x0, y0), (x1, y1) = bridge.ends
    length = math.hypot(x1 - x0, y1 - y0)
    along, aside = _along(moving, np.array([x0, y0]), np.array([x1 - x0, y1 - y0]) / length)
    hidden = float(((along > 0) & (along < length) & (np.abs(aside) < BEAM / 2)).mean()) if len(moving) else 0.0
    return round(length / len(bridge.pins) * (1.0 + 0.01 * abs(y1 - y0) / length) * (1.0 + HIDES * hidden), 6)


def _points(layout: Layout, hanging: Sequence[Pin]) -> tuple[np.ndarray, np.ndarray]:
    """Return (n, 3) each: places that moving items come to, and places of ground.

    The third number is the gap (rmm) from a post's middle.
    """
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
    """Return (..., m, 2): points on the sides of polygons (..., n, 2), STEP or less from each other."""
    way = np.roll(core, -1, axis=-2) - core
    count = max(1, math.ceil(float(np.linalg.norm(way, axis=-1).max()) / STEP))
    share = (np.arange(count) / count)[:, None]
    return (core[..., None, :] + way[..., None, :] * share).reshape(*core.shape[:-2], -1, 2)


def _candidates(waiting: Sequence[Pin], moving: Swept, still: np.ndarray) -> list[Bridge]:
    """Return beams over the first of the pivots in all directions, and over it and another one."""
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
    """Return the first place along a ray from ``at`` past all that moves and clear of what stands."""
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
    """Return distances along and across a ray."""
    seen = points[:, :2] - at
    return seen @ way, seen @ np.array([-way[1], way[0]])


def _has_room(bridge: Bridge, others: Sequence[Bridge], waiting: Sequence[Pin]) -> bool:
    """Return True if it is clear of other beams, and of pivots that hang from others."""
    own = bridge.beam.core[None]
    for other in others:
        posts = np.array([[end] for end in other.ends])
        clear = FLANGE + FLANGE if core_gaps(own, other.beam.core[None])[0] >= BEAM + APART else math.inf
        if min(np.hypot(*(own[0] - post).T).min() for post in posts) < clear:
            return False
    away = [np.array([[pin.places["ground"]]]) for pin in waiting if pin not in bridge.pins]
    away += [np.array([[pin.places["ground"]]]) for other in others for pin in other.pins]
    return all(core_gaps(own, at)[0] >= BEAM + APART for at in away)


# The solids of a bridge (rmm): two posts, a beam that is pinned to them, and shafts that hang from it. The beam is of
# clear glass: it stands in front of all that moves.

BEAM_HEIGHT = 11.0
DOWEL = 24.0
"""Length of the pins that hold a beam on its posts."""


@build.register(Bridge)
def bridge_solids(bridge: Bridge, plan: Plan, heights: Heights) -> None:
    """All of a bridge, and what hangs from it."""
    sizes = plan.layout.sizes
    pivot, seat, low = sizes.pivot, sizes.pivot.fit.seat, heights.roof
    (x0, y0), (x1, y1) = bridge.ends
    shape = extruded(outline.hull([(x0, y0, BEAM / 2), (x1, y1, BEAM / 2)]), BEAM_HEIGHT, low)
    shape = eased(shape, 1.2, ">Z", chamfer=True)
    hung = [pin.places["ground"] for pin in bridge.pins]
    for x, y in [*bridge.ends, *hung]:
        shape = shape.cut(placed_solid(bore(pivot.held, low, low + BEAM_HEIGHT, 0.4), x, y))
    plan.make("ground", f"bridge_{bridge.name}", shape, "acrylic", 2 + len(hung))
    for k, (x, y) in enumerate(bridge.ends, start=1):
        standing(f"{bridge.name}_{k}", (x, y), low - seat, plan, label="", kind="post", levels=heights.levels)
        dowel = pin(pivot.pin, DOWEL - seat, sizes.head)
        top = low + BEAM_HEIGHT + seat
        plan.make("ground", f"dowel_{bridge.name}_{k}", placed_solid(dowel, x, y, top - DOWEL + seat), "steel", 0)
    for hanging in bridge.pins:
        _shaft(hanging, plan, heights)


def _shaft(joint: Pin, plan: Plan, heights: Heights) -> None:
    """A shaft in the beam, with a boss under it; what turns on it, and a circlip under the lowest."""
    sizes, name = plan.layout.sizes, joint.name
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = joint.places["ground"]
    stack = sorted(joint.movers, key=lambda body: heights.bottom(body))
    low = heights.top(stack[-1]) + pivot.flange_room + fit.axial + pivot.washer_room
    boss = column(heights.roof - fit.seat - low, pivot.held, TOP, FOOT).rotate((0, 0, 0), (1, 0, 0), 180)
    plan.make("ground", f"boss_{name}", placed_solid(boss, x, y, heights.roof - fit.seat), "aluminium", 1)
    run(joint, stack, "ground", plan, heights)
    clip = heights.bottom(stack[0]) - pivot.flange_room - pivot.retainer_room
    start, top = clip - sizes.pin_end, heights.roof + BEAM_HEIGHT + fit.seat
    bolt = pin(pivot.pin, top - start, sizes.head, pivot.groove(clip - start))
    plan.make("ground", f"pin_{name}", placed_solid(bolt, x, y, start), "steel", 0)
    plan.add(
        "ground",
        pivot.washer_at(f"washer_{name}_high", x, y, low - pivot.washer_room),
        pivot.washer_at(f"washer_{name}_low", x, y, clip + pivot.clip_thickness + fit.seat),
        pivot.clip_at(f"circlip_{name}", x, y, clip, turn=225),
    )
