"""Whether bodies pass each other in the plane where they share heights: told before anything is built (mm)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.planar import Rounded, around, disc, least_gap
from mechanisms.stages.automatic.shafts.cylinders import rod_shapes
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from mechanisms.stages.automatic.shafts.cylinders import Cylinder
    from mechanisms.stages.automatic.shafts.machine import Machine
    from mechanisms.stages.automatic.shafts.shaft_plan import ShaftPlan
    from mechanisms.stages.automatic.shafts.thickness import Measures

LEAST = 0.1
"""Gap (mm) that must be left."""


@dataclass(frozen=True, eq=False)
class Takes:
    """What takes room: a shape in the plane that moves with a body, from ``low`` to ``high``."""

    what: str
    body: str
    shape: Rounded
    low: float
    high: float
    spares: frozenset[str] = frozenset()
    """Bodies that it touches or holds by design."""


def links_take(measures: Measures, thickness: Mapping[str, float]) -> list[Takes]:
    """The links."""
    found = []
    for name, link in measures.machine.links.items():
        half, on = thickness[name] / 2, frozenset(eye.on for eye in link.eyes)
        pistons = on & set(measures.machine.pistons)
        bore = measures.of_rod(link)
        shapes = (
            [measures.outline(link)] if bore is None or len(link.eyes) > 2 else rod_shapes(measures.machine, link, bore)
        )
        found += [Takes(f"'{name}'", name, shape, link.z - half, link.z + half, pistons) for shape in shapes]
    return found


def shaft_takes(plan: ShaftPlan) -> list[Takes]:
    """Webs, crank pins and journals of a shaft."""
    (x, y), body, found = plan.shaft.axis, plan.shaft.body, []
    for web in plan.webs:
        places = [(x, y), *((x + u, y + v) for u, v in web.pins)]
        found.append(Takes(f"a web of '{body}'", body, around(places, plan.cheek), web.low, web.high))
        if web.weight and plan.has_weights:
            weight = disc(x, y, plan.counterweight)
            found.append(Takes(f"the counterweight of '{body}'", body, weight, web.low, web.high))
    for pin in plan.pins:
        held = frozenset(pin.links)
        found.append(
            Takes(f"a crank pin of '{body}'", body, disc(x + pin.x, y + pin.y, plan.pin), pin.low, pin.high, held)
        )
    for one in plan.journals:
        found.append(Takes(f"a journal of '{body}'", body, disc(x, y, plan.journal), one.low, one.high))
    return found


def weights(plan: ShaftPlan) -> list[Takes]:
    """The counterweights of a shaft."""
    return [one for one in shaft_takes(plan) if one.what.startswith("the counterweight")]


def cylinder_takes(own: Cylinder, fin: float) -> list[Takes]:
    """A piston, and its liner on ground."""
    piston = own.piston
    link = [piston.link] if piston.link else []
    spares = frozenset(["ground", *link])
    c, s = np.cos(piston.turn), np.sin(piston.turn)
    x, y = piston.wrist[0] + s * piston.aside, piston.wrist[1] - c * piston.aside
    moving = _box((x, y), (float(c), float(s)), -own.skirt, own.crown, own.bore / 2 - own.running)
    liner = _box(own.origin, piston.along, own.low, own.top, fin)
    on = frozenset([piston.body, *link])
    return [
        Takes(f"'{piston.body}'", piston.body, moving, piston.z - own.bore / 2, piston.z + own.bore / 2, spares),
        Takes(f"the liner of '{piston.body}'", "ground", liner, piston.z - fin, piston.z + fin, on),
    ]


def _box(at: tuple[float, float], along: tuple[float, float], low: float, high: float, half: float) -> Rounded:
    u, place = np.array(along), np.array(at)
    left = np.array([-u[1], u[0]])
    corners = [place + s * u + q * left for s in (low, high) for q in (-half, half)]
    return around([(float(p[0]), float(p[1])) for p in corners], 1e-6)


def meeting(machine: Machine, first: Takes, second: Takes) -> int | None:
    """The pose at which two things meet; None if they do not."""
    if not _may_meet(first, second):
        return None
    poses = machine.poses[first.body], machine.poses[second.body]
    gap, at = least_gap(first.shape, second.shape, poses, LEAST)
    return at if gap < LEAST else None


def refuse_meetings(machine: Machine, taken: Sequence[Takes]) -> None:
    """Raise UserError naming the first two things that meet, when, and what to do."""
    for first, second in combinations(taken, 2):
        at = meeting(machine, first, second)
        if at is not None:
            share = max(first.low, second.low), min(first.high, second.high)
            raise UserError(
                f"{machine.m.name}: {first.what} and {second.what} meet at t={machine.times[at]:.3g} s between "
                f"z = {share[0]:.4g} and {share[1]:.4g} mm; give one of them another place z, make links shorter, "
                f"or shape them by hand in mechanisms/{machine.m.name}/parts.py"
            )


def _may_meet(first: Takes, second: Takes) -> bool:
    if first.body == second.body or first.low >= second.high - 1e-9 or second.low >= first.high - 1e-9:
        return False
    return first.body not in second.spares and second.body not in first.spares
