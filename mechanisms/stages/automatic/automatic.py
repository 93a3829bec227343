"""Automatic parts: from the model and its motion to solids."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from functools import cached_property, partial
from pathlib import Path

import cadquery as cq

from mbsd import Mechanism, Solution
from mbsd.model.mechanism import hidden_bodies
from mechanisms.stages.automatic import assembly
from mechanisms.stages.automatic.body_shapes import Joined
from mechanisms.stages.automatic.decision import NoOrder, decided
from mechanisms.stages.automatic.features import laid_out
from mechanisms.stages.automatic.glass import WISHED, Panes, all_of_glass, plain_layout, sentence_of
from mechanisms.stages.automatic.layout.items import Heights, Need, heights
from mechanisms.stages.automatic.layout.layout import Layout, Springs
from mechanisms.stages.automatic.layout.motion import poses_of, times_of
from mechanisms.stages.automatic.layout.plan import Mark, Plan, build
from mechanisms.stages.automatic.layout.sizes import (
    THINNEST,
    Sizes,
    lengths_of,
    of_pin,
    printed_sizes,
    refuse_sizes,
    rods_of,
    sizes,
    thin_pins,
)
from mechanisms.stages.automatic.looks import looks_of
from mechanisms.stages.automatic.own_solids import OwnSolid, read_solid
from mechanisms.stages.automatic.pins.pins import places
from mechanisms.stages.automatic.rolling.roads import runs_on_ground
from mechanisms.stages.automatic.shafts.along import THINNEST_ALONG, Along
from mechanisms.stages.automatic.shafts.bodies import has_places
from mechanisms.stages.automatic.shafts.solids import plate_of, solids
from mechanisms.stages.automatic.standing import hold
from mechanisms.stages.loading.wishes import wished, wished_scale
from shared.contract.materials import MATERIALS
from shared.contract.parts import Mount, mounted
from shared.shapes.bodies import Bodies, pair_of
from shared.shapes.outline import Point
from shared.shapes.solid import Solid
from shared.shapes.standards import Fit
from shared.stage.console import Shown
from shared.stage.errors import UserError, did_you_mean

# Names in wishes for parts: bodies and materials that there are.


def refuse_unknown(m: Mechanism, body: str, left_out: Collection[str], ground: bool = False) -> None:
    """Raise UserError unless ``body`` moves, is a rod, or where that may be ground, and is not left out."""
    if body in left_out:
        raise UserError(f"{m.name}: '{body}' is left out, so there is nothing of it to shape")
    names = [*(name for name in m.bodies if ground or name != "ground"), *rods_of(m)]
    if body not in names:
        raise UserError(
            f"{m.name}: there is no body '{body}' to shape; there is: {', '.join(names)}{did_you_mean(body, names)}"
        )


def refuse_material(m: Mechanism, body: str, material: str) -> None:
    """Raise UserError unless ``material`` is one that there is."""
    if material not in MATERIALS:
        raise UserError(
            f"{m.name}: material of '{body}': there is no '{material}'; there is {', '.join(MATERIALS)}"
            f"{did_you_mean(material, MATERIALS)}"
        )


MOST_GLASS = 0.5
"""Where more of the bodies would be of glass, all are."""

# Parts from the model and its motion: ``automatic(m)`` plans them, ``solids()`` builds them.
#
# def parts(p: Params) -> dict[str, list[Solid]]:
#     made = automatic(build(p))
#     made.material("crank", "steel")
#     made.layer("rocker", 2)
#     return made.solids()


class Automatic:
    """Automatic parts, and what an author may wish otherwise. Lengths that are given are mm."""

    def __init__(self, m: Mechanism, solution: Solution, pin: float | None = None, fit: Fit | None = None) -> None:
        self.m, self.solution = m, solution
        self._pin, self._fit = pin, fit
        refuse_sizes(m.name, pin, fit)
        self._materials: dict[str, str] = {}
        self._layers: dict[str, int] = {}
        self._replaced: dict[str, list[Solid]] = {}
        self._own: dict[str, OwnSolid] = {}
        self._joined: list[Joined] = []
        self._left_out: set[str] = hidden_bodies(m)
        self._glass: set[str] = set()
        self._touching: set[tuple[str, str]] = set()
        self._marks: list[tuple[str, Mark]] = []
        self._base_under: list[Point] = []
        self._flywheels: set[str] = set()

    # -- wishes -------------------------------------------------------------------------------------------------

    def material(self, body: str, name: str) -> None:
        """Make the plate of ``body`` of another material."""
        self._known(body)
        refuse_material(self.m, body, name)
        self._materials[body] = name

    def layer(self, body: str, number: int) -> None:
        """Put ``body`` on a layer, counted from 0 above the base; the others are found around it."""
        self._known(body)
        self._refuse_along("layer", "layers follow the places z of its bodies")
        if number < 0:
            raise UserError(f"{self.m.name}: layer of '{body}' is {number}; the lowest one is 0")
        self._layers[body] = number
        self._plan_anew()

    def replace(self, body: str, solids: Sequence[Solid]) -> None:
        """Build ``body`` of these solids (mm, its frame, at its height) instead: the first is its main piece.

        It keeps its layer, and the others keep clear of the outline that it would have had; :meth:`span` gives its
        height. Pins, bushings and washers that it would have carried are part of what is replaced.
        """
        self._known(body)
        if body in dict(self._marks):
            raise UserError(f"{self.m.name}: '{body}' is engraved; engrave its solids (shared/shapes/engraving.py)")
        self._replaced[body] = list(solids)

    def solid(self, body: str, file: str | Path) -> None:
        """Build the plate of ``body`` from a STEP file, in the frame of the body; others keep clear of its hull.

        ``file``: beside mechanism.py, or a whole path. Its mass, centre and inertia count where mechanism.py gives
        none. Raises UserError for a file without one closed solid, and when it is built, where its holes do not meet
        the pins or it is thicker than its layer.
        """
        self._known(body)
        self._refuse_along("solid", "give solids with made.replace(...)")
        if body in self._replaced or body in dict(self._marks):
            raise UserError(f"{self.m.name}: '{body}' is replaced or engraved; give it one solid")
        own = self._own[body] = read_solid(self.m.name, body, file)
        self._joined.append(Joined(body, own.outline, (0.0, 0.0), (), True))
        self._plan_anew()

    def join(
        self, body: str, outline: cq.Wire, at: Point = (0.0, 0.0), holes: Sequence[cq.Wire] = (), sharp: bool = False
    ) -> None:
        """Make a closed outline (mm, the body's frame, z = 0) a part of its plate.

        Others keep clear of its hull.

        ``at`` is the place of the joint whose eye it carries; joints that no outline carries are linked as usual.
        ``sharp`` leaves its edges as they are.
        """
        self._known(body)
        self._refuse_along("join", "join the outline to the solids (made.replace)")
        self._joined.append(Joined(body, outline, at, tuple(holes), sharp))
        self._plan_anew()

    def engrave(self, body: str, word: str, at: tuple[float, float], height: float | None = None) -> None:
        """Engrave ``word`` into a plate's upper face, its middle ``at`` (x, y) in the frame of ``body`` (mm).

        ``height`` of the letters (mm); by default they go with the eyes. Raises UserError for letters that there are
        not, and when it is built where the word is not all on the plate.
        """
        self._known(body)
        self._refuse_along("engrave", "engrave its solids (shared/shapes/engraving.py)")
        assembly.refuse_letters(self.m.name, word)
        if body in self._replaced:
            raise UserError(f"{self.m.name}: '{body}' is replaced; engrave its solids (shared/shapes/engraving.py)")
        self._marks.append((body, Mark(word, *at, height or 0.0)))

    def base_under(self, *places: Point) -> None:
        """Let the base plate and roads on it reach places (x, y) of ground (mm) besides what stands on it.

        Raises UserError for a place that is not finite.
        """
        for x, y in places:
            if not (math.isfinite(x) and math.isfinite(y)):
                raise UserError(f"{self.m.name}: base_under({x:g}, {y:g}): give places in mm")
        self._base_under += places

    def leave_out(self, body: str) -> None:
        """Build nothing of ``body``. Where a joint would hold it, other bodies keep an eye without a pin.

        Where mechanism.py gives it no mass, that is estimated. Raises UserError for the last body that moves.
        """
        self._known(body)
        wished = [self._materials, self._layers, self._replaced, dict(self._marks)]
        if any(body in wishes for wishes in wished):
            raise UserError(
                f"{self.m.name}: '{body}' has a material, a layer, a word or solids, so it cannot be left out too"
            )
        if body in self.m.bodies and len(self._left_out & self.m.bodies.keys()) + 2 == len(self.m.bodies):
            raise UserError(f"{self.m.name}: without '{body}' nothing that moves is left; keep one body")
        self._left_out.add(body)
        self._plan_anew()

    def show_as_glass(self, body: str) -> None:
        """Show ``body`` as a thin glass plate above all layers, which may overlap others.

        Parts with one cannot be printed or proven clear. Raises UserError where bodies have places z.
        """
        self._known(body)
        self._refuse_along("show_as_glass", "leave it out (made.leave_out)")
        self._glass.add(body)
        self._plan_anew()

    def may_touch(self, first: str, second: str) -> None:
        """Let two bodies (one may be ground) share room: they touch by design.

        Neither the order of layers nor the clearance stage keeps them apart.
        """
        for body in (first, second):
            self._known(body, ground=True)
        self._touching.add(pair_of(first, second))
        self._plan_anew()

    def flywheel(self, shaft: str) -> None:
        """Put a flywheel on the lower end of a body that becomes a shaft, where bodies have places z.

        Raises UserError for a body that becomes none.
        """
        self._known(shaft)
        if self.along is None or shaft not in self.along.machine.shafts:
            raise UserError(
                f"{self.m.name}: flywheel('{shaft}'): '{shaft}' becomes no shaft; a shaft turns on ground and carries "
                "links at places z along the normal"
            )
        self._flywheels.add(shaft)
        self._plan_anew()

    # -- results ------------------------------------------------------------------------------------------------

    @cached_property
    def along(self) -> Along | None:
        """The plan of a machine whose bodies have places along the normal of the plane; None for others."""
        if not has_places(self.m):
            return None
        plan = Along(self.m, self.solution, self.wishes(), frozenset(self._left_out), frozenset(self._flywheels))
        return plan.with_pins_that_pass()

    @property
    def mount(self) -> Mount:
        """How ground stands: as shot.py says while the parts stage runs, else as gravity says."""
        rolls = self.along is None and runs_on_ground(self.layout)
        return mounted(self.m.gravity or (0.0, 0.0), wished(), rolls)

    @property
    def sizes(self) -> Sizes:
        """Proportions and the scale."""
        return self.layout.sizes if self.along is None else self.along.sizes

    @cached_property
    def layout(self) -> Layout:
        """Return what is to be built, with styluses as tall as the layers allow.

        Raises UserError if no layers are possible.
        """
        return self._decided[0]

    @cached_property
    def levels(self) -> dict[str, int]:
        """The layer of each moving body, from 0 up."""
        return {body: self.decided[body] for body in self.layout.moving}

    @property
    def decided(self) -> dict[str, int]:
        """The layers, and the choices of items that have one (0 or 1)."""
        return self._decided[1]

    @cached_property
    def heights(self) -> Heights:
        """Heights (rmm) of the layers."""
        layout = self.layout
        needs = [need for feature in layout.features for need in feature.needs(self.decided, layout)]
        pivot = self.sizes.pivot
        heights_of = heights(self.decided, layout.layered, self.sizes.thickness, needs, 2 * pivot.fit.axial)
        floor = 4.0 + self.sizes.screw / self.sizes.finished + 2 * pivot.fit.axial
        if heights_of.bottoms and heights_of.bottoms[0] < floor:
            needs.append(Need(-1, floor))
            heights_of = heights(self.decided, layout.layered, self.sizes.thickness, needs, 2 * pivot.fit.axial)
        return heights_of

    def solids(self, engraved_too: bool = True) -> Bodies:
        """Return every piece by the body it moves with, in mm.

        The first of each list is the body's main piece. ``on_stand()`` adds a stand. ``engraved_too``: the base with
        its names, rule and dial, which cost as much as a link.
        """
        if self.along is not None:
            return self._solids_along(self.along)
        if self._glass >= self._moving:
            return all_of_glass(self._plain_layout, self.solution, self._plain_mount)
        plan = self.plan()
        made = Bodies(assembly.fitted(assembly.built(plan, self.heights, engraved_too)) | self._replaced)
        for body, own in self._own.items():
            made[body][0] = own.in_place(self.m.name, plan, made[body][0], self.span(body))
        made.notes = self._notes()
        if self._glass:
            self._add_glass(made)
        scale, plate = self.sizes.scale, assembly.back_plate(plan)
        poses = {body: pose * [scale, scale, 1.0] for body, pose in self.layout.poses.items()}
        hold(made, self.mount, plate and plate.scaled(scale), poses, self.sizes)
        for body in self._left_out.intersection(self.m.bodies):
            made.leave_out(body)
        for rod, joint in rods_of(self.m, self._left_out).items():
            made.join_places(rod, *places(joint))
        for first, second in map(tuple, self.layout.touching | self.layout.pressing):
            if first in made and second in made:
                made.may_touch(first, second)
        names = {solid.name for solids in made.values() for solid in solids}
        for part, body, piece in plan.pressing:
            if {plan.outer[part], piece} <= names:
                made.pieces_may_touch(plan.outer[part], piece)
            else:
                made.may_touch(part.body, body)  # solids that are replaced may be anything
        return made

    def shown(self) -> Bodies:
        """Return :meth:`solids`, or where they cannot be built, glass plates that may overlap in their place.

        Bodies that leave no order of layers are of glass; all are where that does not help. ``made.schematic`` says so.
        """
        looks_of(self.m)  # an unknown look is an error, and no reason for glass
        first: UserError | None = None
        before = set(self._glass)
        while True:
            try:
                made = self.solids()
                break
            except UserError as error:
                first = first or error
                more = set(error.bodies) & self._moving - self._glass if isinstance(error, NoOrder) else set[str]()
                self._glass |= more
                self._plan_anew()
                if not more or len(self._glass) > MOST_GLASS * len(self._moving):
                    made = all_of_glass(self._plain_layout, self.solution, self._plain_mount)
                    break
        self._glass = before
        self._plan_anew()
        if first is not None:
            bodies = first.bodies if isinstance(first, NoOrder) else ()
            made.schematic = sentence_of(bodies) if bodies else sentence_of((), _why(first))
            made.notes = [*made.notes, f"{made.schematic}. {first}"]
        return made

    def _add_glass(self, made: Bodies) -> None:
        layout, heights = self._plain_layout, self.heights
        bodies = [body for body in layout.moving if body in self._glass or body not in self.layout.moving]
        top = max([heights.roof, *(z for z in heights.bottoms)]) + heights.thickness

        def span(body: str) -> tuple[float, float]:
            return heights.bottom(body), heights.top(body)

        Panes(layout, self.solution, tuple(bodies), top, span).add(made)
        made.schematic = sentence_of([body for body in bodies if body in self._glass], WISHED)

    @property
    def _moving(self) -> set[str]:
        """Bodies of the model that move and are not left out."""
        return {body for body in self.m.bodies if body != "ground"} - self._left_out

    @property
    def _plain_layout(self) -> Layout:
        return plain_layout(self.m, self.wishes()[0], self.solution, self._left_out)

    @property
    def _plain_mount(self) -> Mount:
        return mounted(self.m.gravity or (0.0, 0.0), wished())

    def _solids_along(self, along: Along) -> Bodies:
        made = Bodies(assembly.fitted(solids(along, self._materials, self.mount, self._base_under)) | self._replaced)
        made.along, made.notes = True, self._notes()
        plate = plate_of(along, self.mount, self._base_under)
        hold(made, self.mount, plate, along.machine.poses, self.sizes)
        for body in self._left_out.intersection(self.m.bodies):
            made.leave_out(body)
        for first, second in self._touching:
            made.may_touch(first, second)
        return made

    def _refuse_along(self, method: str, remedy: str) -> None:
        if has_places(self.m):
            raise UserError(f"{self.m.name}: {method} is for plates in layers, and bodies here have places z; {remedy}")

    def span(self, body: str) -> tuple[float, float]:
        """Return the lower and upper face (mm) of the plate of ``body``."""
        self._known(body)
        if self.along is not None:
            return self.along.span(body)
        scale = self.sizes.scale
        return self.heights.bottom(body) * scale, self.heights.top(body) * scale

    def plan(self) -> Plan:
        """Return eyes, feet and hardware, before plates and base are built."""
        rods = dict.fromkeys(self.layout.rods, assembly.ROD)
        named = assembly.materials(self.m) | rods | self._materials
        plan = Plan(self.layout, named | {web: named[body] for web, body in self.layout.webs.items()})
        plan.mount = self.mount
        plan.reserve([*self.m.bodies, *rods, "base_plate", *self.layout.webs])
        plan.base_under += [(x / self.sizes.scale, y / self.sizes.scale) for x, y in self._base_under]
        shown = Shown("parts", self.m.name, len(self.layout.features), "joints, springs and the like shaped")
        for feature in self.layout.features:
            shown.advance()
            with assembly.kernel_refusals(
                self.m.name, f"the parts of '{getattr(feature, 'name', type(feature).__name__)}'"
            ):
                build(feature, plan, self.heights)
        assembly.place(self._marks, plan)
        return plan

    @cached_property
    def _decided(self) -> tuple[Layout, dict[str, int]]:
        if looks_of(self.m):
            try:
                return decided(partial(self._layout, looks=True), self.wishes(), self._layers)
            except NoOrder:  # there is no room for what bodies look like
                pass
        return decided(self._layout, self.wishes(), self._layers)

    def wishes(self) -> list[Sizes]:
        """Return sizes of pins and all that goes with them, the most wanted first."""
        scale, thinnest = wished_scale(), THINNEST_ALONG if has_places(self.m) else THINNEST
        if scale is None and self._pin is not None:
            return [of_pin(self._pin, self._fit)]
        lengths = lengths_of(self.m, self.solution, self._left_out)
        if scale is not None:
            return printed_sizes(self.m.name, lengths, scale, thinnest, self._pin, self._fit)
        return sizes(lengths.shortest[0], lengths.overall, self._fit, thinnest)

    def _notes(self) -> list[str]:
        """Return what the user should know of the sizes that were chosen."""
        if wished_scale() is not None or self._pin is not None:
            return []
        note = thin_pins(lengths_of(self.m, self.solution, self._left_out), self.sizes.pin)
        return [note] if note else []

    def _layout(
        self,
        size: Sizes,
        springs: Springs,
        tubes: bool = False,
        tall: bool = False,
        pointers: bool = False,
        looks: bool = False,
    ) -> Layout:
        poses = poses_of(self.solution, size.of_metres(1.0))
        layout = Layout(self.m, size, poses, times_of(self.solution), springs)
        layout.apart = frozenset(self._left_out | self._glass)
        layout.touching = frozenset(map(frozenset, self._touching))
        return laid_out(layout, self._joined, tubes, tall, pointers, looks)

    def _plan_anew(self) -> None:
        """Forget what was found before a wish."""
        for name in ("sizes", "layout", "levels", "heights", "_decided", "along"):
            self.__dict__.pop(name, None)

    def _known(self, body: str, ground: bool = False) -> None:
        refuse_unknown(self.m, body, self._left_out, ground)


def _why(error: UserError) -> str:
    """Return why all is of glass, in few words, where it is not that some bodies are in each other's way."""
    return "no order of layers was found" if isinstance(error, NoOrder) else "these lengths leave no room for parts"


def automatic(
    m: Mechanism, pin: float | None = None, solution: Solution | None = None, fit: Fit | None = None
) -> Automatic:
    """Return parts of ``m``, planned from ``solution``.

    By default that is the motion of the mechanism's folder, or of its variant that is made.

    ``pin``: diameter (mm) of its pins; by default it follows from the links. ``fit``: clearances (mm), such as
    ``Fit(running=0.3)`` for printed parts; by default they follow from the pins. Raises UserError where it cannot move.
    """
    if solution is None:
        from mechanisms.stages.loading.loading import running
        from mechanisms.stages.solve.masses import bare_solution

        solution = bare_solution(running(m.name))
    return Automatic(m, solution, pin, fit)
