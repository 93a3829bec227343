"""The plan of a machine whose bodies have places along the normal of the plane, in millimetres.

z of the model is z of the parts. The base plate lies below all of it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mbsd import Mechanism, Solution
from mechanisms.stages.automatic.layout.motion import poses_of, times_of
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.shafts.bearings import (
    BOSS,
    FOOT,
    Axle,
    Bearers,
    axle_takes,
    axles,
    bearers,
    free_places,
)
from mechanisms.stages.automatic.shafts.bodies import Machine, Mounted
from mechanisms.stages.automatic.shafts.cylinders import Cylinder, cylinders
from mechanisms.stages.automatic.shafts.machine import free_links, machine
from mechanisms.stages.automatic.shafts.passing import (
    Meeting,
    Takes,
    banks,
    cylinder_takes,
    deck_corners,
    deck_takes,
    fins,
    links_take,
    meeting,
    refuse_meetings,
    shaft_takes,
    weights,
)
from mechanisms.stages.automatic.shafts.rams import RamPlan, ram_plans
from mechanisms.stages.automatic.shafts.shaft_plan import Measures, ShaftPlan, shaft_plan, thicknesses
from mechanisms.stages.automatic.shafts.valves import ValvePlan, valve_plans
from mechanisms.stages.automatic.shafts.wheels import Wheels, wheels
from shared.shapes.units import mm
from shared.stage.errors import UserError

BELOW = 8.0
"""From the lowest part that moves to the base plate, at least (rmm)."""
THINNEST_ALONG = 0.35
"""Thinnest of the pins that are tried, in the first ones: with given places only thinner pins can be tried."""
FAR = 1e4
"""Where links are, far from each other, that have no place yet (mm)."""
SMALLER = (1.0, 0.92, 0.84, 0.76, 0.68, 0.6)
"""Counterweights that are tried, in the largest one."""
ROOM = 0.03
"""Between a flywheel and the liners, in bores."""
FLYWHEEL = 1.25
"""Radius of a flywheel, in what the webs of its shaft sweep."""


@dataclass(eq=False)
class Along:
    """The plan of a machine; ``wishes`` are sizes of pins, the most wanted first."""

    m: Mechanism
    solution: Solution
    wishes: Sequence[Sizes]
    left_out: frozenset[str] = frozenset()
    flywheels: frozenset[str] = frozenset()
    """Shafts with a flywheel."""

    def with_pins_that_pass(self) -> Along:
        """Return the same plan with the thickest pins with which nothing meets; itself if there are none."""
        for k, _ in enumerate(self.wishes):
            plan = self if k == 0 else replace(self, wishes=self.wishes[k:])
            try:
                plan.refuse()
            except Meeting:
                continue
            except UserError:
                break
            return plan
        return self

    @cached_property
    def machine(self) -> Machine:
        """Machine that says what each body becomes."""
        free = free_links(self.m, self.left_out)
        return self._machine(self.left_out, self._places(free) if free else {})

    def _machine(self, left_out: frozenset[str], chosen: Mapping[str, float]) -> Machine:
        return machine(self.m, self._poses, times_of(self.solution), left_out, chosen)

    @cached_property
    def _poses(self) -> dict[str, np.ndarray]:
        return poses_of(self.solution, mm(1.0))

    def _places(self, free: Sequence[str]) -> dict[str, float]:
        """Return places of links that the model gives none, beside all that it gives a place."""
        given = replace(self, left_out=self.left_out.union(free))
        if not given.machine.links:
            raise UserError(
                f"{self.m.name}: '{free[0]}' has no place z along the normal, and no link has one; give it one, such "
                f"as m.body('{free[0]}', z=0.02)"
            )
        somewhere = max(link.z for link in given.machine.links.values()) + FAR
        every = self._machine(self.left_out, {name: somewhere + k * FAR for k, name in enumerate(free)})
        measures = Measures(every, given.sizes, given.cylinders)
        taken = [space for plan in given.shafts for space in shaft_takes(plan)] + given._of_cylinders()
        return free_places(measures, free, given.thickness, axles(every), taken)

    @cached_property
    def cylinders(self) -> dict[str, Cylinder]:
        """By piston."""
        return cylinders(self.machine)

    @cached_property
    def _sized(self) -> tuple[Measures, dict[str, float]]:
        """With the thickest pins that the distances along z leave."""
        for k, sizes in enumerate(self.wishes):
            measures = Measures(self.machine, sizes, self.cylinders)
            try:
                return measures, thicknesses(measures)
            except UserError:
                if k == len(self.wishes) - 1:
                    raise
        raise UserError(f"{self.m.name}: there is no size of pins to try")

    @property
    def measures(self) -> Measures:
        """Sizes that links, pins and shafts share."""
        return self._sized[0]

    @property
    def sizes(self) -> Sizes:
        """Sizes of the pins."""
        return self.measures.sizes

    @property
    def thickness(self) -> dict[str, float]:
        """By link."""
        return self._sized[1]

    @cached_property
    def shafts(self) -> list[ShaftPlan]:
        """Their crank pins, webs and journals, with counterweights as large as what passes them leaves."""
        every = [
            self._below_liners(
                shaft_plan(shaft, self.measures, self.thickness, self.cylinders, self._mounted(shaft.body))
            )
            for shaft in self.machine.shafts.values()
        ]
        bare = [replace(plan, counterweight=0.0) for plan in every]
        return [
            self._lightened(plan, [other for k, other in enumerate(bare) if k != own]) for own, plan in enumerate(every)
        ]

    @cached_property
    def wheels(self) -> Wheels:
        """Gears, pulleys and belts."""
        return wheels(self.machine, self.measures)

    def _mounted(self, shaft: str) -> list[Mounted]:
        """Return valves and wheels that sit on a shaft beside its throws."""
        cams = [valve.mounted for valve in self.valves.values() if valve.valve.shaft == shaft]
        return [*(wheel.mounted for wheel in self.wheels.wheels_on(shaft)), *cams]

    @cached_property
    def valves(self) -> dict[str, ValvePlan]:
        """By body."""
        return valve_plans(self.machine, self.measures, self.cylinders)

    def _of_valves(self) -> list[Takes]:
        return [space for own in self.valves.values() for space in own.takes()]

    def _below_liners(self, plan: ShaftPlan) -> ShaftPlan:
        """Return the plan with a first journal so long that a flywheel turns below all liners."""
        if plan.shaft.body not in self.flywheels:
            return plan
        first, *rest = plan.journals
        liners = [own.piston.z - self.fins[name] for name, own in self.cylinders.items()]
        low = min([first.low, *(z - ROOM * plan.unit for z in liners)])
        return replace(plan, journals=(replace(first, low=low), *rest))

    def _lightened(self, plan: ShaftPlan, shafts: Sequence[ShaftPlan]) -> ShaftPlan:
        others = [*links_take(self.measures, self.thickness), *self._of_cylinders(), *self._of_axles(-math.inf)]
        others += [*self._of_rams(-math.inf), *self.wheels.takes()]
        others += [space for other in shafts for space in shaft_takes(other)]
        for part in SMALLER if plan.has_weights else ():
            smaller = replace(plan, counterweight=part * plan.counterweight)
            if not any(
                meeting(self.machine, weight, other) is not None for weight in weights(smaller) for other in others
            ):
                return smaller
        return replace(plan, counterweight=0.0)

    @cached_property
    def axles(self) -> list[Axle]:
        """Pins of links."""
        return axles(self.machine)

    @cached_property
    def rams(self) -> dict[str, RamPlan]:
        """By body that slides on ground and is driven in several planes."""
        return ram_plans(self.machine, self.measures, self.thickness)

    @cached_property
    def fins(self) -> dict[str, float]:
        """Radius of the fins, by piston."""
        return fins(self.cylinders)

    def flywheel(self, plan: ShaftPlan) -> float:
        """Return the radius of a shaft's flywheel; 0 for none."""
        return FLYWHEEL * plan.webs_sweep if plan.shaft.body in self.flywheels else 0.0

    @cached_property
    def low(self) -> float:
        """Top of the base plate."""
        lowest = [link.z - self.thickness[name] / 2 for name, link in self.machine.links.items()]
        lowest += [own.piston.z - self.fins[name] for name, own in self.cylinders.items()]
        lowest += [plan.bottom(self.flywheel(plan)) for plan in self.shafts]
        lowest += [own.span[0] for own in self.rams.values()]
        return min(lowest, default=0.0) - BELOW * self.measures.unit

    @cached_property
    def bearers(self) -> list[Bearers]:
        """Bearers of each shaft."""
        running = max(0.12, self.sizes.pivot.fit.running * self.measures.unit / 2)
        return [bearers(self.machine, plan, self._others(plan), running, self.flywheel(plan)) for plan in self.shafts]

    def _others(self, own: ShaftPlan) -> list[Takes]:
        spaces = [*links_take(self.measures, self.thickness), *self._of_cylinders(), *self._of_rams()]
        spaces += self._of_decks()
        spaces += [space for space in [*self.wheels.takes(), *self._of_valves()] if space.body != own.shaft.body]
        for plan in self.shafts:
            spaces += [] if plan is own else shaft_takes(plan)
        return spaces + self._of_axles()

    def _of_cylinders(self) -> list[Takes]:
        return [space for name, own in self.cylinders.items() for space in cylinder_takes(own, self.fins[name])]

    def _of_decks(self) -> list[Takes]:
        return [deck_takes(bank, self.low) for bank in banks(self.cylinders)]

    def _of_rams(self, low: float | None = None) -> list[Takes]:
        return [space for own in self.rams.values() for space in own.takes(self.low if low is None else low)]

    def _of_axles(self, low: float | None = None) -> list[Takes]:
        low = self.low if low is None else low
        return [
            space for axle in self.axles for space in axle_takes(axle, self.machine, self.thickness, self.sizes, low)
        ]

    def refuse(self) -> None:
        """Raise UserError where things meet, a :class:`Meeting` where thinner pins may help."""
        return self._passes

    @cached_property
    def _passes(self) -> None:
        taken = [*links_take(self.measures, self.thickness), *self._of_cylinders(), *self._of_axles()]
        taken += [*self._of_rams(), *self._of_decks(), *self._of_valves(), *self.wheels.takes()]
        taken += [space for plan in self.shafts for space in shaft_takes(plan)]
        taken += [space for own in self.bearers for space in own.takes(self.low)]
        taken += [self._flywheel(plan) for plan in self.shafts if self.flywheel(plan)]
        refuse_meetings(self.machine, taken)

    def _flywheel(self, plan: ShaftPlan) -> Takes:
        body, radius = plan.shaft.body, self.flywheel(plan)
        shape = disc(*plan.shaft.axis, radius)
        return Takes(f"the flywheel of '{body}'", body, shape, plan.bottom(radius), plan.ends[0])

    def span(self, body: str) -> tuple[float, float]:
        """Return the lowest and highest z of a body's main piece."""
        if body in self.machine.links:
            z, half = self.machine.links[body].z, self.thickness[body] / 2
            return z - half, z + half
        if body in self.cylinders:
            own = self.cylinders[body]
            half = own.bore / 2 - own.running
            return own.piston.z - half, own.piston.z + half
        if body in self.rams:
            return self.rams[body].span
        if body in self.valves:
            own = self.valves[body]
            half = max(own.radius, own.tappet)
            return own.valve.z - half, own.valve.z + half
        plan = next(plan for plan in self.shafts if plan.shaft.body == body)
        return plan.bottom(self.flywheel(plan)), plan.top

    @property
    def feet(self) -> list[tuple[float, float]]:
        """Corners of what stands on the base plate."""
        corners = [corner for bank in banks(self.cylinders) for corner in deck_corners(bank)]
        corners += [corner for own in self.rams.values() for corner in own.corners]
        for own in self.bearers:
            r = BOSS * own.radius
            corners += [(x + u * r, y + v * r) for x, y in own.places for u in (-1, 1) for v in (-1, 1)]
        r = FOOT * self.measures.unit
        for axle in self.axles:
            if axle.holder == "ground":
                x, y = axle.places["ground"]
                corners += [(x + u * r, y + v * r) for u in (-1, 1) for v in (-1, 1)]
        return corners or [(0.0, 0.0)]
