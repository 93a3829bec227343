"""Parts from the model and its motion: ``automatic(m)`` plans them, ``solids()`` builds them.

def parts(p: Params) -> dict[str, list[Solid]]:
    made = automatic(build(p))
    made.material("crank", "steel")
    made.layer("rocker", 2)
    return made.solids()
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from mechanisms.automatic.extents import extents
from mechanisms.automatic.features import CONTACT_KINDS, FORCE_KINDS, KINDS, Feature
from mechanisms.automatic.heights import Heights, heights
from mechanisms.automatic.layers import find_layers
from mechanisms.automatic.layout import Layout
from mechanisms.automatic.looks import materials
from mechanisms.automatic.motion import poses_of, times_of
from mechanisms.automatic.points import styluses, weights
from mechanisms.automatic.refusal import refusal
from mechanisms.automatic.sizes import Sizes, of_pin, sizes
from shared.errors import UserError
from shared.materials import MATERIALS
from shared.suggestions import did_you_mean

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.force import Force
    from mbsd.joint import Joint
    from mechanisms.automatic.features import Gather
    from mechanisms.automatic.plan import Plan
    from shared.shapes.solid import Solid

SHAPELESS = ("angle_lock", "constraint")
"""Kinds of joints that hold by no part of their own."""


class Automatic:
    """Parts by themselves, and what one may want otherwise. Lengths that are given are mm."""

    def __init__(self, m: Mechanism, solution: Solution, pin: float | None = None) -> None:
        self.m = m
        self.solution = solution
        self._pin = pin
        self._materials: dict[str, str] = {}
        self._layers: dict[str, int] = {}
        self._replaced: dict[str, list[Solid]] = {}

    # -- wishes -------------------------------------------------------------------------------------------------

    def material(self, body: str, name: str) -> None:
        """Make the plate of ``body`` of another material."""
        self._known(body)
        if name not in MATERIALS:
            raise UserError(
                f"{self.m.name}: material of '{body}': there is no '{name}'; there is {', '.join(MATERIALS)}"
                f"{did_you_mean(name, MATERIALS)}"
            )
        self._materials[body] = name

    def layer(self, body: str, number: int) -> None:
        """Put ``body`` on a layer, counted from 0 above the base; the others are found around it."""
        self._known(body)
        if number < 0:
            raise UserError(f"{self.m.name}: layer of '{body}' is {number}; the lowest one is 0")
        self._layers[body] = number

    def replace(self, body: str, solids: Sequence[Solid]) -> None:
        """Build ``body`` of these solids (mm, its frame, at its height) instead: the first is its main piece.

        It keeps its layer, and the others keep clear of the outline that it would have had; :meth:`span` gives its
        height. Pins, bushings and washers that it would have carried are part of what is replaced.
        """
        self._known(body)
        self._replaced[body] = list(solids)

    # -- results ------------------------------------------------------------------------------------------------

    @cached_property
    def sizes(self) -> Sizes:
        """Proportions and the scale."""
        if self._pin is not None:
            return of_pin(self._pin)
        import mechanisms.automatic.kinds  # noqa: F401  (enters them)

        shortest, overall = extents(self.m, self.solution)
        return sizes(shortest, overall)

    @cached_property
    def layout(self) -> Layout:
        """What is to be built, with styluses as tall as the layers allow. Raises UserError where there are none."""
        return self._found[0]

    @cached_property
    def levels(self) -> dict[str, int]:
        """The layer of each moving body, from 0 up."""
        return {body: self.decided[body] for body in self.layout.moving}

    @property
    def decided(self) -> dict[str, int]:
        """The layers, and the choices of items that have one (0 or 1)."""
        return self._found[1]

    @cached_property
    def heights(self) -> Heights:
        """Heights (rmm) of the layers."""
        layout = self.layout
        needs = [need for feature in layout.features for need in feature.needs(self.decided, layout)]
        pivot = self.sizes.pivot
        heights_of = heights(self.decided, layout.layered, self.sizes.thickness, needs, 2 * pivot.fit.axial)
        floor = 4.0 + self.sizes.screw / self.sizes.scale + 2 * pivot.fit.axial
        if heights_of.bottoms and heights_of.bottoms[0] < floor:
            from mechanisms.automatic.features import Need

            needs.append(Need(-1, floor))
            heights_of = heights(self.decided, layout.layered, self.sizes.thickness, needs, 2 * pivot.fit.axial)
        return heights_of

    def solids(self) -> dict[str, list[Solid]]:
        """Every piece by the body it moves with, in mm; the first of each list is the body's main piece."""
        from mechanisms.automatic.built import built

        return built(self.plan(), self.heights) | self._replaced

    def span(self, body: str) -> tuple[float, float]:
        """Lower and upper face (mm) of the plate of ``body``."""
        self._known(body)
        scale = self.sizes.scale
        return self.heights.bottom(body) * scale, self.heights.top(body) * scale

    def plan(self) -> Plan:
        """Eyes, feet and hardware, before plates and base are built."""
        from mechanisms.automatic.plan import Plan

        plan = Plan(self.layout, materials(self.m) | self._materials)
        plan.reserve([*self.m.bodies, "base_plate"])
        for feature in self.layout.features:
            feature.build(plan, self.heights)
        return plan

    @cached_property
    def _found(self) -> tuple[Layout, dict[str, int]]:
        low = self._layout(tall=False)
        least = self._levels(low)
        if least is None:
            raise UserError(refusal(low))
        if not low.m.traces:
            return low, least
        high = self._layout(tall=True)
        levels = self._levels(high)
        if levels is None or max(levels[b] for b in high.layered) > max(least[b] for b in low.layered):
            return low, least
        return high, levels

    def _levels(self, layout: Layout) -> dict[str, int] | None:
        return find_layers(layout.layered, layout.items, layout.conflicts, self._layers, together=layout.together)

    def _layout(self, tall: bool) -> Layout:
        poses = poses_of(self.solution, self.sizes.of_metres(1.0))
        layout = Layout(self.m, self.sizes, poses, times_of(self.solution))
        layout.features = [*self._joints(layout), *self._forces_and_contacts(layout)]
        layout.features += styluses(layout, tall)
        layout.features += weights(layout)
        return layout

    def _joints(self, layout: Layout) -> list[Feature]:
        import mechanisms.automatic.kinds  # noqa: F401  (enters them)

        by_kind: dict[str, list] = {}
        for name, joint in self.m.joints.items():
            if joint.kind.name in SHAPELESS:
                continue
            if joint.kind.name not in KINDS:
                raise UserError(
                    f"{self.m.name}: joint '{name}' is a {joint.kind.name.replace('_', ' ')}, which has no parts by "
                    f"itself yet (there are: {', '.join(KINDS)}); write mechanisms/{self.m.name}/parts.py"
                )
            by_kind.setdefault(joint.kind.name, []).append(joint)
        return [feature for kind, joints in by_kind.items() for feature in KINDS[kind](self.m, joints, layout)]

    def _forces_and_contacts(self, layout: Layout) -> list[Feature]:
        """Of those kinds that have parts; the others need none."""
        features = _features(FORCE_KINDS, self.m, self.m.forces.values(), layout)
        return features + _features(CONTACT_KINDS, self.m, self.m.contacts.values(), layout)

    def _known(self, body: str) -> None:
        names = [name for name in self.m.bodies if name != "ground"]
        if body not in names:
            raise UserError(
                f"{self.m.name}: there is no body '{body}' to shape; there is: {', '.join(names)}"
                f"{did_you_mean(body, names)}"
            )


def _features[Thing: (Force, Joint)](
    kinds: Mapping[str, Gather[Thing]], m: Mechanism, things: Iterable[Thing], layout: Layout
) -> list[Feature]:
    by_kind: dict[str, list[Thing]] = {}
    for thing in things:
        if thing.kind.name in kinds:
            by_kind.setdefault(thing.kind.name, []).append(thing)
    return [feature for kind, same in by_kind.items() for feature in kinds[kind](m, same, layout)]


def automatic(m: Mechanism, pin: float | None = None, solution: Solution | None = None) -> Automatic:
    """Parts of ``m``, planned from ``solution``; by default from the motion of the mechanism's folder.

    ``pin``: diameter (mm) of its pins; by default it follows from the links. Raises UserError where it cannot move.
    """
    if solution is None:
        from mechanisms.bare_motion import bare_solution

        solution = bare_solution(m.name)
    return Automatic(m, solution, pin)
