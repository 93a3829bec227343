"""Room along the normal: which bodies pass each other, and banks of cylinders (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from mechanisms.stages.automatic.layout.planar import Rounded, around, box, disc, least_gap
from mechanisms.stages.automatic.shafts.bodies import Link, Machine, carrier, flange, is_carrier
from mechanisms.stages.automatic.shafts.cylinders import HEAD, Cylinder, flange_shape, rod_shapes, shank_shapes
from mechanisms.stages.automatic.shafts.shaft_plan import Measures, ShaftPlan
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# Checks that bodies pass each other in the plane where they share heights, before anything is built (mm).

LEAST = 0.1
"""Gap (mm) that must be left."""


class Meeting(UserError):
    """Two things meet."""


@dataclass(frozen=True, eq=False)
class Takes:
    """Room that is taken: a shape in the plane that moves with a body, from ``low`` to ``high``."""

    what: str
    body: str
    shape: Rounded
    low: float
    high: float
    spares: frozenset[str] = frozenset()
    """Bodies that it touches or holds by design."""


def links_take(measures: Measures, thickness: Mapping[str, float]) -> list[Takes]:
    """Return the links."""
    spaces = []
    for name, link in measures.machine.links.items():
        half, on = thickness[name] / 2, frozenset(eye.on for eye in link.eyes)
        sliding = on & {*measures.machine.pistons, *measures.machine.rams}
        bore = measures.of_rod(link)
        if bore is not None and is_carrier(measures.machine, link):
            spaces += _carrier_takes(measures, link, thickness, bore, sliding)
            continue
        if bore is not None and carrier(measures.machine, link) is not None:
            shapes = shank_shapes(measures.machine, link, bore)
            spaces += [Takes(f"'{name}'", name, shape, link.z - half, link.z + half, sliding) for shape in shapes]
            continue
        shapes = (
            [measures.outline(link)] if bore is None or len(link.eyes) > 2 else rod_shapes(measures.machine, link, bore)
        )
        spaces += [Takes(f"'{name}'", name, shape, link.z - half, link.z + half, sliding) for shape in shapes]
    return spaces


def _carrier_takes(
    measures: Measures, link: Link, thickness: Mapping[str, float], bore: float, pistons: frozenset[str]
) -> list[Takes]:
    """Return its flanges, and between them the shank."""
    half, between = thickness[link.body] / 2, measures.shank(link, thickness) / 2
    thick = flange(2 * half, measures.axial)
    round_pins = flange_shape(measures.machine, link, bore)
    spaces = [
        Takes(f"a flange of '{link.body}'", link.body, round_pins, link.z + low, link.z + low + thick, pistons)
        for low in (-half, half - thick)
    ]
    for shape in shank_shapes(measures.machine, link, bore):
        spaces.append(Takes(f"'{link.body}'", link.body, shape, link.z - between, link.z + between, pistons))
    return spaces


def shaft_takes(plan: ShaftPlan) -> list[Takes]:
    """Return webs, crank pins and journals of a shaft."""
    (x, y), body, spaces = plan.shaft.axis, plan.shaft.body, []
    for web in plan.webs:
        places = [(x, y), *((x + u, y + v) for u, v in web.pins)]
        spaces.append(Takes(f"a web of '{body}'", body, around(places, plan.cheek), web.low, web.high))
        if web.weight and plan.has_weights:
            weight = disc(x, y, plan.counterweight)
            spaces.append(Takes(f"the counterweight of '{body}'", body, weight, web.low, web.high))
    for pin in plan.pins:
        held = frozenset(pin.links)
        spaces.append(
            Takes(f"a crank pin of '{body}'", body, disc(x + pin.x, y + pin.y, plan.pin), pin.low, pin.high, held)
        )
    if not plan.pins:
        rod = disc(x, y, plan.journal)
        spaces.append(Takes(f"the shaft of '{body}'", body, rod, plan.bottom(0.0), plan.top))
    for journal in plan.journals:
        spaces.append(Takes(f"a journal of '{body}'", body, disc(x, y, plan.journal), journal.low, journal.high))
    return spaces


def weights(plan: ShaftPlan) -> list[Takes]:
    """Return the counterweights of a shaft."""
    return [space for space in shaft_takes(plan) if space.what.startswith("the counterweight")]


def cylinder_takes(own: Cylinder, fin: float) -> list[Takes]:
    """Return a piston, and its liner on ground."""
    piston = own.piston
    link = [piston.link] if piston.link else []
    spares = frozenset(["ground", *link])
    c, s = np.cos(piston.turn), np.sin(piston.turn)
    x, y = piston.wrist[0] + s * piston.aside, piston.wrist[1] - c * piston.aside
    moving = box((x, y), (float(c), float(s)), -own.skirt, own.crown, own.bore / 2 - own.running)
    liner = box(own.origin, piston.along, own.low, own.top, fin)
    head = box(own.origin, piston.along, own.top, own.top + HEAD * own.bore, fin)
    mate = [own.against[0]] if own.against is not None else []
    on = frozenset([piston.body, *link, *mate])
    return [
        Takes(f"'{piston.body}'", piston.body, moving, piston.z - own.bore / 2, piston.z + own.bore / 2, spares),
        Takes(f"the liner of '{piston.body}'", "ground", liner, piston.z - fin, piston.z + fin, on),
        *([] if mate else [Takes(f"the head of '{piston.body}'", "ground", head, piston.z - fin, piston.z + fin, on)]),
    ]


def meeting(machine: Machine, first: Takes, second: Takes) -> int | None:
    """Return the pose at which two things meet; None if they do not."""
    if not _may_meet(first, second):
        return None
    poses = machine.poses[first.body], machine.poses[second.body]
    gap, at = least_gap(first.shape, second.shape, poses, LEAST)
    return at if gap < LEAST else None


def refuse_meetings(machine: Machine, taken: Sequence[Takes]) -> None:
    """Raise Meeting naming the first two things that meet, when, and what to do."""
    for first, second in combinations(taken, 2):
        at = meeting(machine, first, second)
        if at is not None:
            share = max(first.low, second.low), min(first.high, second.high)
            bored = [
                space.body in machine.pistons or space.what.startswith(("the liner", "the head"))
                for space in (first, second)
            ]
            remedy = (
                "make rods longer, bores smaller, or the angle between the banks wider"
                if all(bored)
                else "give one of them another place z, make links shorter or pins thinner (automatic(m, pin=...))"
            )
            raise Meeting(
                f"{machine.m.name}: {first.what} and {second.what} meet at t={machine.times[at]:.3g} s between "
                f"z = {share[0]:.4g} and {share[1]:.4g} mm; {remedy}, "
                f"or shape them by hand in {shown_file(machine.m.name, 'parts')}"
            )


def _may_meet(first: Takes, second: Takes) -> bool:
    if first.body == second.body or first.low >= second.high - 1e-9 or second.low >= first.high - 1e-9:
        return False
    return first.body not in second.spares and second.body not in first.spares


# Cylinders that stand in line, the fins of their liners, and the deck that holds these (mm).

DECK = (0.2, 0.05)
"""Between these distances below the upper end of a liner is the deck that holds it, in bores."""
FIN = 0.14
"""How far fins stand out of a liner, in bores, where there is room."""
BESIDE = 0.12
"""How far a deck reaches beside its liners."""


def fins(all_of: Mapping[str, Cylinder]) -> dict[str, float]:
    """Return by piston the radius of the fins of its liner, as far as its neighbours leave room."""
    radii = {}
    for name, own in all_of.items():
        radius = own.outer + FIN * own.bore
        for other in all_of.values():
            apart = abs(other.piston.z - own.piston.z)
            if other is own or apart > 2 * radius:
                continue
            cosine = sum(a * b for a, b in zip(own.piston.along, other.piston.along, strict=True))
            between = math.acos(max(-1.0, min(1.0, cosine)))
            room = apart / 2 - 0.01 * own.bore if between < 1e-6 else own.low * math.tan(between / 2)
            radius = min(radius, max(room, own.outer))
        radii[name] = radius
    return radii


def banks(all_of: Mapping[str, Cylinder]) -> list[list[Cylinder]]:
    """Return cylinders on the same line of the plane, in the order of their places along z."""
    rows: list[list[Cylinder]] = []
    for own in all_of.values():
        for bank in rows:
            if (
                math.dist(bank[0].piston.along, own.piston.along) < 1e-6
                and math.dist(bank[0].origin, own.origin) < 1e-3
            ):
                bank.append(own)
                break
        else:
            rows.append([own])
    return [sorted(bank, key=lambda cylinder: cylinder.piston.z) for bank in rows]


def deck_corners(bank: Sequence[Cylinder]) -> list[tuple[float, float]]:
    """Return corners of its foot on the base plate."""
    first, wide, low, high = bank[0], deck_half(bank), deck_range(bank)[0], deck_range(bank)[1]
    (x, y), (u, v) = first.origin, first.piston.along
    return [(x + s * u - q * v, y + s * v + q * u) for s in (low, high) for q in (-wide, wide)]


def deck_takes(bank: Sequence[Cylinder], low: float) -> Takes:
    """Return the room of a deck, from the base plate (z = ``low``) up."""
    first, (below, above), last = bank[0], deck_range(bank), bank[-1]
    inside = [own.piston.body for own in bank] + [own.piston.link for own in bank if own.piston.link]
    inside += [own.against[0] for own in bank if own.against is not None]
    shape = box(first.origin, first.piston.along, below, above, deck_half(bank))
    what = f"the deck of '{first.piston.body}'"
    return Takes(what, "ground", shape, low, deck_top(last), frozenset(inside))


def deck_top(last: Cylinder) -> float:
    """Return the upper end (z) of the deck whose last cylinder this is."""
    return last.piston.z + last.outer + BESIDE * last.bore


def deck_half(bank: Sequence[Cylinder]) -> float:
    """Return half of the width of a deck."""
    return max(own.outer + BESIDE * own.bore for own in bank)


def deck_range(bank: Sequence[Cylinder]) -> tuple[float, float]:
    """Return s of the lower and of the upper face of a deck."""
    return max(own.top - DECK[0] * own.bore for own in bank), min(own.top - DECK[1] * own.bore for own in bank)
