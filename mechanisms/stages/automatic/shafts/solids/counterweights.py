"""Webs with counterweights as large as what their shaft carries asks for (mm).

Each load is shared by the two counterweights it is between by the law of the lever, so that force and couple vanish:

    S_a = -sum m (z_b - z) / (z_b - z_a) (x, y),    S_b = -sum m (z - z_a) / (z_b - z_a) (x, y)

Source: Norton, Design of Machinery, ch. 12, balancing in two planes. A counterweight is a sector of the radius R and
the angle 2 a with flanks to the neck of the radius n; its area has beyond the neck the first moment

    2/3 R^3 sin a + 1/3 n R^2 cos^2 a - 2/3 n^3
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.shafts.solids.web_solid import Weight, web_solid
from shared.shapes.units import cubic_metres

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.shaft_plan import ShaftPlan, Web
    from mechanisms.stages.automatic.shafts.solids.carried import Load

SECTOR, WIDEST = math.radians(62), math.radians(90)
"""Half of a counterweight's angle, and at most where the radius does not suffice."""
LEAST = 1.1
"""The least radius of a counterweight, in the neck's."""
STEPS, ENOUGH = 4, 2e-4
"""How often a counterweight is made again for what its rounded edges change, and the part that may be left."""


def balanced_webs(plan: ShaftPlan, loads: Sequence[Load], density: float) -> list[cq.Workplane]:
    """All webs of a shaft of that density (kg/m^3), with counterweights where there is room for them."""
    webs = [web_solid(plan, web) for web in plan.webs]
    if not plan.has_weights:
        return webs
    moments = [_moment(web, density) for web in webs]
    middles = [(web.low + web.high) / 2 for web in plan.webs]
    turning = [(load.z, load.mass * np.array([load.x, load.y])) for load in loads]
    for pin in plan.pins:
        place = density * math.pi * np.array([pin.x, pin.y])
        area = plan.pin**2 - plan.hole**2
        turning.append(((pin.low + pin.high) / 2, cubic_metres(area * (pin.high - pin.low)) * place))
        for web in plan.beside(pin):
            k = plan.webs.index(web)
            moments[k] = moments[k] - cubic_metres(plan.hole**2 * (web.high - web.low)) * place
    turning += [(z, own) for z, own, web in zip(middles, moments, plan.webs, strict=True) if not web.weight]
    heavy = [k for k, web in enumerate(plan.webs) if web.weight]
    for a, b in zip(heavy[::2], heavy[1::2], strict=True):
        between = [(z, moment) for z, moment in turning if middles[a] < z < middles[b]]
        for own, other in ((a, b), (b, a)):
            shares = [(z - middles[other]) / (middles[own] - middles[other]) * moment for z, moment in between]
            wanted = -(moments[own] + sum(shares, np.zeros(2)))
            webs[own] = _balanced(plan, plan.webs[own], webs[own], wanted, density)
    return webs


def _balanced(plan: ShaftPlan, web: Web, bare: cq.Workplane, wanted: np.ndarray, density: float) -> cq.Workplane:
    """A web whose counterweight has the wanted moment (2,) (kg mm), or the largest one."""
    asked, without, made = wanted, _moment(bare, density), bare
    for _ in range(STEPS):
        weight = _weight(plan, asked / (density * cubic_metres(web.high - web.low)))
        if weight is None:
            return bare
        made = web_solid(plan, web, weight)
        left = wanted - (_moment(made, density) - without)
        if weight.half >= WIDEST or np.linalg.norm(left) < ENOUGH * np.linalg.norm(wanted):
            break
        asked = asked + left
    return made


def _weight(plan: ShaftPlan, wanted: np.ndarray) -> Weight | None:
    """The counterweight of a first moment of area (2,) (mm^3), as far as there is room."""
    size, far, neck = float(np.linalg.norm(wanted)), plan.counterweight, plan.neck

    def area(radius: float, half: float) -> float:
        flanks = neck * radius**2 * math.cos(half) ** 2 / 3
        return 2 / 3 * radius**3 * math.sin(half) + flanks - 2 / 3 * neck**3

    if size <= max(0.0, area(LEAST * neck, SECTOR)):
        return None
    towards = math.atan2(wanted[1], wanted[0])
    if size <= area(far, SECTOR):
        return Weight(towards, _solved(lambda radius: area(radius, SECTOR) - size, LEAST * neck, far), SECTOR)
    if size < area(far, WIDEST):
        return Weight(towards, far, _solved(lambda half: area(far, half) - size, SECTOR, WIDEST))
    return Weight(towards, far, WIDEST)


def _solved(rest: Callable[[float], float], low: float, high: float) -> float:
    """Where a rising function is zero, by bisection."""
    for _ in range(48):
        middle = (low + high) / 2
        low, high = (middle, high) if rest(middle) < 0 else (low, middle)
    return (low + high) / 2


def _moment(shape: cq.Workplane, density: float) -> np.ndarray:
    """(2,): mass times place of the centre of mass from the axis (kg mm)."""
    solid = shape.val()
    centre = solid.Center()
    return density * cubic_metres(solid.Volume()) * np.array([centre.x, centre.y])
