"""Places of links that the model gives none: by the search for layers, among and beside the places that it gives (mm).

Every plane with a link is a layer; between two of them there are as many more as have room, and some below and above
all. What else takes room, such as webs and liners, belongs to the layers whose plates it would meet.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations, pairwise
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.order.layers import Problem, find_layers
from mechanisms.stages.automatic.layout.order.purse import Undecided
from mechanisms.stages.automatic.layout.planar import least_gap
from mechanisms.stages.automatic.shafts.bodies.planes import SAME
from mechanisms.stages.automatic.shafts.pins_along import pin_outline
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.shafts.bodies.kinds import Machine
    from mechanisms.stages.automatic.shafts.passing import Takes
    from mechanisms.stages.automatic.shafts.pins_along import Axle
    from mechanisms.stages.automatic.shafts.thickness import Measures

MARGIN = 1.6
"""Beside the head of a pin, from a plate to the next layer (rmm)."""


def free_places(
    measures: Measures,
    free: Sequence[str],
    thickness: Mapping[str, float],
    pins: Sequence[Axle],
    taken: Sequence[Takes],
) -> dict[str, float]:
    """By link of ``free``, which the machine of ``measures`` has in any plane. ``taken`` is what else takes room.

    Raises UserError naming the links where no order of layers lets them pass.
    """
    machine = measures.machine
    thick = max([thickness[name] for name in thickness], default=0.0)
    pitch = thick + (measures.sizes.head.height + MARGIN) * measures.unit
    given = {name: link.z for name, link in machine.links.items() if name not in free}
    layers = _layers(sorted(given.values()), pitch, len(free))
    fixed = {name: _nearest(layers, z) for name, z in given.items()}
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
    """Heights of all layers, rising."""
    planes = [z for k, z in enumerate(given) if k == 0 or z - given[k - 1] > SAME] or [0.0]
    layers = [planes[0] - pitch * k for k in range(count, 0, -1)]
    for low, high in pairwise([*planes, planes[-1] + (count + 1) * pitch]):
        more = max(int((high - low) / pitch + 1e-6) - 1, 0)
        layers += [low, *(low + (high - low) * k / (more + 1) for k in range(1, more + 1))]
    return layers


def _nearest(layers: Sequence[float], z: float) -> int:
    return min(range(len(layers)), key=lambda k: abs(layers[k] - z))


def _height(layers: Sequence[float], level: int, pitch: float) -> float:
    return layers[level] if level < len(layers) else layers[-1] + (level - len(layers) + 1) * pitch


def _asks(a: Item, b: Item, free: set[str]) -> bool:
    """Whether two items that meet say something of a free link."""
    if not free.intersection((*a.reach.bodies, *b.reach.bodies)) or (a.body == b.body and a.body == "ground"):
        return False
    return a.body != b.body and a.body not in b.spares and b.body not in a.spares


def _meet(machine: Machine, a: Item, b: Item, measures: Measures) -> bool:
    room = measures.sizes.room * measures.unit / 2
    return least_gap(a.shape, b.shape, (machine.poses[a.body], machine.poses[b.body]), room)[0] < room
