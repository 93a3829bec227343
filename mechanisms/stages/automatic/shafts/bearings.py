"""Pins along the normal, free places of links, and the bearers of the shaft (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.layers import Problem, Undecided, find_layers
from mechanisms.stages.automatic.layout.planar import Rounded, around, disc, least_gap
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.shafts.bodies import NEAR, SAME, Machine, carries, marker_on, place
from mechanisms.stages.automatic.shafts.passing import Takes
from mechanisms.stages.automatic.shafts.shaft_plan import Journal, Measures, ShaftPlan
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Pins between links in different planes, and axles on ground that links turn on (mm).

FOOT = 16.0
"""Radius of the foot of what carries an axle on ground (rmm)."""


@dataclass(frozen=True, eq=False)
class Axle:
    """Links that turn about one axis, in the order of their planes.

    The lowest holds the pin unless ground does.
    """

    joint: str
    places: Mapping[str, tuple[float, float]]
    """Place on each body, ground included where it holds the pin, in its frame."""
    stack: tuple[str, ...]

    @property
    def holder(self) -> str:
        """The body with the pin."""
        return "ground" if "ground" in self.places else self.stack[0]


def axles(machine: Machine) -> list[Axle]:
    """Return pins between links, and between links and ground.

    Raises UserError for two links of one axis in one plane.
    """
    groups: list[tuple[str, dict[str, tuple[float, float]]]] = []
    for body, link in machine.links.items():
        for eye in link.eyes:
            if eye.on not in machine.links and eye.on != "ground":  # shafts, pistons, free ends
                continue
            if eye.on in machine.links and carries(machine, link, machine.links[eye.on]):
                continue  # between the flanges of its carrier
            other = place(marker_on(machine.m.joints[eye.joint], eye.on))
            ends = {body: (eye.x, eye.y), eye.on: other}
            near = [group for group in groups if _share(group[1], ends)]
            joined = {k: v for _, group in near for k, v in group.items()} | ends
            name = near[0][0] if near else eye.joint
            groups = [group for group in groups if group not in near]
            groups.append((name, joined))
    made = []
    for name, places in groups:
        stack = sorted((body for body in places if body != "ground"), key=lambda body: machine.links[body].z)
        for below, above in pairwise(stack):
            z = machine.links[below].z
            if machine.links[above].z - z < SAME:
                raise UserError(
                    f"{machine.m.name}: '{below}' and '{above}' are both at z = {z:g} mm and turn about one axis in "
                    f"'{name}'; give them places z that differ by more than their thickness"
                )
        made.append(Axle(name, places, tuple(stack)))
    return made


def _share(a: Mapping[str, tuple[float, float]], b: Mapping[str, tuple[float, float]]) -> bool:
    return any(abs(a[k][0] - b[k][0]) < NEAR and abs(a[k][1] - b[k][1]) < NEAR for k in a.keys() & b.keys())


def axle_takes(own: Axle, machine: Machine, thickness: Mapping[str, float], sizes: Sizes, low: float) -> list[Takes]:
    """Return its pin with head, spacers and column; ``low`` is the top of the base plate."""
    unit, on = sizes.scale, frozenset(own.places)
    first, last = machine.links[own.stack[0]], machine.links[own.stack[-1]]
    top = last.z + thickness[last.body] / 2 + sizes.head.height * unit + 0.5 * unit
    start = low if own.holder == "ground" else first.z - thickness[first.body] / 2
    shape = pin_outline(own, sizes)
    return [Takes(f"the pin of '{own.joint}'", own.holder, shape, start, top, on)]


def bore_of(own: Axle, body: str, sizes: Sizes) -> float:
    """Return the diameter of the hole in a link on an axle."""
    pivot = sizes.pivot
    return (pivot.held if body == own.holder else pivot.pin + pivot.fit.running) * sizes.scale


def pin_outline(own: Axle, sizes: Sizes) -> Rounded:
    """Return the outline of a pin with its head, in the frame of the body that holds it."""
    return disc(*own.places[own.holder], sizes.hardware * sizes.scale)


# Places of links that the model gives none: by the search for layers, among and beside the places that it gives (mm).
#
# Every plane with a link is a layer; between two of them there are as many more as have room, and some below and above
# all. What else takes room, such as webs and liners, belongs to the layers whose plates it would meet.

MARGIN = 1.6
"""Beside the head of a pin, from a plate to the next layer (rmm)."""


def free_places(
    measures: Measures,
    free: Sequence[str],
    thickness: Mapping[str, float],
    pins: Sequence[Axle],
    taken: Sequence[Takes],
) -> dict[str, float]:
    """Return the place of each link of ``free``, which the machine of ``measures`` has in any plane.

    ``taken`` is what else takes room.

    Raises UserError naming the links where no order of layers lets them pass.
    """
    machine = measures.machine
    thick = max([thickness[name] for name in thickness], default=0.0)
    pitch = thick + (measures.sizes.head.height + MARGIN) * measures.unit
    given = {name: link.z for name, link in machine.links.items() if name not in free}
    layers = _layers(sorted(given.values()), pitch, len(free))
    fixed = {name: min(range(len(layers)), key=lambda k, z=z: abs(layers[k] - z)) for name, z in given.items()}
    slots = {f"layer {k}": k for k in range(len(layers))}
    items = [Item(f"'{name}'", name, measures.outline(link), Reach((name,))) for name, link in machine.links.items()]
    for axle in pins:
        shape, on = pin_outline(axle, measures.sizes), frozenset(axle.places)
        reach = Reach(axle.stack, -1, 1, base=axle.holder == "ground")
        items.append(Item(f"the pin of '{axle.joint}'", axle.holder, shape, reach, on))
    for space in taken:
        for slot, k in slots.items():
            if space.low < layers[k] + pitch / 2 and space.high > layers[k] - pitch / 2:
                items.append(Item(space.what, space.body, space.shape, Reach((slot,)), space.spares))
    conflicts = [
        (i, j)
        for (i, a), (j, b) in combinations(enumerate(items), 2)
        if _asks(a, b, {*free}) and _meet(machine, a, b, measures)
    ]
    problem = Problem([*machine.links, *slots], items, conflicts, fixed | slots)
    try:
        levels = find_layers(problem)
    except Undecided:
        levels = None
    if levels is None:
        raise UserError(
            f"{machine.m.name}: no layer beside the places that are given lets {', '.join(free)} pass; give them "
            "places z, or others more room along z"
        )
    return {name: _height(layers, levels[name], pitch) for name in free}


def _layers(given: Sequence[float], pitch: float, count: int) -> list[float]:
    """Return heights of all layers, rising."""
    planes = [z for k, z in enumerate(given) if k == 0 or z - given[k - 1] > SAME] or [0.0]
    layers = [planes[0] - pitch * k for k in range(count, 0, -1)]
    for low, high in pairwise([*planes, planes[-1] + (count + 1) * pitch]):
        more = max(int((high - low) / pitch + 1e-6) - 1, 0)
        layers += [low, *(low + (high - low) * k / (more + 1) for k in range(1, more + 1))]
    return layers


def _height(layers: Sequence[float], level: int, pitch: float) -> float:
    return layers[level] if level < len(layers) else layers[-1] + (level - len(layers) + 1) * pitch


def _asks(a: Item, b: Item, free: set[str]) -> bool:
    """Return True if two items that meet say something of a free link."""
    if not free.intersection((*a.reach.bodies, *b.reach.bodies)) or (a.body == b.body and a.body == "ground"):
        return False
    return a.body != b.body and a.body not in b.spares and b.body not in a.spares


def _meet(machine: Machine, a: Item, b: Item, measures: Measures) -> bool:
    room = measures.sizes.room * measures.unit / 2
    return least_gap(a.shape, b.shape, (machine.poses[a.body], machine.poses[b.body]), room)[0] < room


# Bearers of a shaft: pillars on the base plate, and bearings between them (mm).

PILLAR = 0.085
"""Radius of a pillar, in bores."""
HUB, BOSS = 1.45, 1.9
"""Radii of a bearing in the journal's, and of its ends round the pillars in theirs."""
LONGEST = 1.3
"""Length of a bearing, in radii of its journal."""
MOST, APART = 4, math.radians(55)
"""Pillars of a shaft, and their least angle about it."""
WIDER = (1.0, 1.15, 1.35, 1.6, 2.0, 2.5)
"""Distances from the axis that are tried, in the nearest one."""
STEP = 5
EVERY = 4
"""Step between the poses at which places for pillars are looked at."""
ROOM = 0.5
"""Gap (mm) that is left there."""


@dataclass(frozen=True, eq=False)
class Bearers:
    """Where the pillars of a shaft stand on ground."""

    plan: ShaftPlan
    radius: float
    places: tuple[tuple[float, float], ...]
    running: float
    """Gap of a journal in its bearing."""
    journals: tuple[Journal, ...]
    """Journals with a bearing."""
    tapered: bool = False
    """True if there is room for its arms only as they are, thinner towards the pillars."""

    @property
    def hub(self) -> float:
        """Outer radius of a bearing."""
        return HUB * self.plan.journal

    def takes(self, low: float) -> list[Takes]:
        """Return pillars from ``low`` up, and bearings."""
        x, y = self.plan.shaft.at
        body, top = frozenset({self.plan.shaft.body}), self.top
        spaces = [Takes("a pillar", "ground", disc(*pillar, self.radius), low, top) for pillar in self.places]
        for journal in self.journals:
            a, b = heights_of(self.plan, journal)
            spaces.append(Takes("a bearing", "ground", disc(x, y, self.hub), a, b, body))
            for pillar in self.places:
                arm = _arm(self.plan, pillar, self.radius, self.tapered)
                spaces.append(Takes("the arm of a bearing", "ground", arm, a, b, body))
        return spaces

    @property
    def top(self) -> float:
        """Upper end of the pillars."""
        return heights_of(self.plan, self.plan.journals[-1])[1] + 0.05 * self.plan.unit


def bearers(
    machine: Machine, plan: ShaftPlan, taken: Sequence[Takes], running: float, flywheel: float = 0.0
) -> Bearers:
    """Find places for pillars that nothing comes near to, also not a flywheel of that radius.

    Raises UserError where there are not two.
    """
    radius = PILLAR * plan.unit
    room = 0.05 * plan.unit + (BOSS - 1) * radius
    nearest = max(plan.swept, _hubs_of_links(plan), flywheel) + BOSS * radius + 0.05 * plan.unit
    ends = plan.journals[0], plan.journals[-1]
    tries = [(tapered, journals) for tapered in (False, True) for journals in (plan.journals, ends)]
    for tapered, journals in tries:

        def holds(place: tuple[float, float], journal: Journal, tapered: bool = tapered) -> bool:
            return _is_free(machine, _arm(plan, place, radius, tapered), _shapes_at_heights(plan, journal, taken))

        for wider in WIDER:
            free = []
            for turn in np.radians(np.arange(0, 360, STEP)):
                place = _place_round(plan, wider * nearest, turn)
                if _is_free(machine, disc(*place, radius + room), taken) and all(
                    holds(place, journal) for journal in journals
                ):
                    free.append(turn)
            chosen = _spread(machine, plan, free)
            if len(chosen) >= 2:
                places = tuple(_place_round(plan, wider * nearest, turn) for turn in chosen)
                held = tuple(
                    journal
                    for journal in plan.journals
                    if journal in journals or all(holds(place, journal) for place in places)
                )
                return Bearers(plan, radius, places, running, held, tapered)
    raise UserError(
        f"{machine.m.name}: round the shaft '{plan.shaft.body}' there is no room for two pillars that carry its "
        f"bearings; bodies sweep all of it up to {WIDER[-1] * nearest:.4g} mm: leave one out "
        f"(automatic(m).leave_out), or write {shown_file(machine.m.name, 'parts')}"
    )


def _hubs_of_links(plan: ShaftPlan) -> float:
    return max((math.hypot(pin.x, pin.y) for pin in plan.pins), default=0.0) + 1.5 * plan.pin


def _place_round(plan: ShaftPlan, away: float, turn: float) -> tuple[float, float]:
    x, y = plan.shaft.at
    return float(x + away * math.cos(turn)), float(y + away * math.sin(turn))


def _arm(plan: ShaftPlan, place: tuple[float, float], radius: float, tapered: bool) -> Rounded:
    """Return the arm of a bearing, from the axis to a pillar."""
    wide, end = 0.8 * HUB * plan.journal, BOSS * radius
    if tapered and wide > end:
        (x, y), turns = plan.shaft.at, [k * math.pi / 8 for k in range(16)]
        return around([place, *((x + (wide - end) * math.cos(t), y + (wide - end) * math.sin(t)) for t in turns)], end)
    return around([plan.shaft.at, place], max(BOSS * radius, 0.8 * HUB * plan.journal))


def _shapes_at_heights(plan: ShaftPlan, journal: Journal, taken: Sequence[Takes]) -> list[Takes]:
    """Return the shapes that share heights with a bearing."""
    low, high = heights_of(plan, journal)
    return [space for space in taken if space.low < high and space.high > low]


def heights_of(plan: ShaftPlan, journal: Journal) -> tuple[float, float]:
    """Return the lower and upper face of a bearing, in the middle of its journal."""
    half = min((journal.high - journal.low) / 2 - plan.gap, LONGEST * plan.journal / 2)
    middle = (journal.low + journal.high) / 2
    return middle - half, middle + half


def _is_free(machine: Machine, shape: Rounded, taken: Sequence[Takes]) -> bool:
    """Return True if nothing comes near to a shape on ground."""
    still = machine.poses["ground"][::EVERY]
    return all(
        least_gap(space.shape, shape, (machine.poses[space.body][::EVERY], still), ROOM)[0] >= ROOM for space in taken
    )


def _spread(machine: Machine, plan: ShaftPlan, free: list[float]) -> list[float]:
    """Return directions: the farthest from all bores, then always the farthest from those chosen."""
    bores = [math.atan2(piston.along[1], piston.along[0]) for piston in machine.pistons.values()]
    chosen: list[float] = []
    while free and len(chosen) < MOST:
        beside = chosen or bores or [math.pi / 2]
        away = [min(abs(math.remainder(turn - other, math.tau)) for other in beside) for turn in free]
        best = int(np.argmax(np.round(away, 6)))
        if chosen and away[best] < APART:
            break
        chosen.append(float(free[best]))
    return chosen
