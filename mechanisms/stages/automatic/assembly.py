"""Assembly: bodies with bores and marks, the frame, and failures of the CAD kernel."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import combinations

import cadquery as cq
import numpy as np

from mbsd import Mechanism
from mechanisms.stages.automatic.body_shapes import PlacedEye, body_shape, rod_shape, yoke_shape
from mechanisms.stages.automatic.layout.items import Heights
from mechanisms.stages.automatic.layout.plan import BOLT_HOLE, Foot, Mark, Plan
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.standing import BackPlate, Upright
from mechanisms.stages.automatic.wheels.wheels import shape_of
from shared.shapes.base import base_plate, foot
from shared.shapes.build import extruded
from shared.shapes.engraving import LETTERS, dial, engraved, rule, text
from shared.shapes.kernel import is_of_kernel
from shared.shapes.link import Eye, with_eyes
from shared.shapes.outline import Circle, circle
from shared.shapes.screw import SOCKET, head_diameter, socket_screw
from shared.shapes.solid import Solid, placed
from shared.shapes.standards import screw_length, screw_name
from shared.stage.console import Shown
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

# A failure of the CAD kernel in automatic parts becomes an error that names the part, no traceback.

KERNEL = "the CAD kernel cannot make"
"""Words of such a refusal."""


@contextmanager
def kernel_refusals(name: str, what: str) -> Iterator[None]:
    """Raise UserError naming mechanism and ``what`` where the CAD kernel fails or a shape has no room."""
    try:
        yield
    except Exception as error:
        if not isinstance(error, ValueError) and not is_of_kernel(error):
            raise
        raise UserError(
            f"{name}: {KERNEL} {what} ({type(error).__name__}: {error}); change its sizes a little, make pins thinner "
            f"(automatic(m, pin=...)), or shape it by hand in {shown_file(name, 'parts')}"
        ) from error


# Materials of bodies without a wish: those of the colour of their role (mbsd/drawing/look.py).

ROD = "steel"


def materials(m: Mechanism) -> dict[str, str]:
    """Return the material of each moving body."""
    from mbsd.drawing.look import colours_by_role

    return {body: "aluminium" if word == "silver" else f"aluminium_{word}" for body, word in colours_by_role(m).items()}


# A check that the bores of a body's plate leave a wall between them.

WALL = 0.5
"""Least wall between two bores (rmm)."""
ONE = 0.01
"""Bores nearer than this are one (rmm)."""


def refuse_meeting_bores(plan: Plan) -> None:
    """Raise UserError where two bores of a body meet."""
    layout = plan.layout
    for body, eyes in plan.eyes.items():
        bored = [(x, y, eye.bore) for x, y, eye in eyes if eye.bore > 0]
        for first, second in combinations(bored, 2):
            apart = math.hypot(first[0] - second[0], first[1] - second[1])
            least = (first[2] + second[2]) / 2 + WALL
            if ONE < apart < least:
                this, other = (_what(plan, body, *place[:2]) for place in (first, second))
                scale = layout.sizes.scale
                raise UserError(
                    f"{layout.m.name}: on '{body}' {this} and {other} are {apart * scale:.3g} mm apart, and their "
                    f"bores of {first[2] * scale:.3g} and {second[2] * scale:.3g} mm need {least * scale:.3g} mm; move "
                    f"one of them, or shape '{body}' by hand in {shown_file(layout.m.name, 'parts')}"
                )


def _what(plan: Plan, body: str, x: float, y: float) -> str:
    """Return the purpose of the bore at (x, y) of a body."""
    layout = plan.layout
    for kind, things in (("joint", layout.m.joints), ("force", layout.m.forces), ("contact", layout.m.contacts)):
        for name, thing in things.items():
            for marker in (thing.i, thing.j):
                u, v = layout.place(marker)
                if marker.body.name == body and math.hypot(u - x, v - y) < ONE:
                    return f"{kind} '{name}'"
    return f"what is at ({x:.3g}, {y:.3g})"


# Words engraved into the upper face of a plate (rmm).

DEPTH = 0.6
WIDTH = 0.2
"""Width of a stroke, in heights of the letters."""
LEAST = 0.99
"""How much of a word must be on the plate."""


def place(wishes: Iterable[tuple[str, Mark]], plan: Plan) -> None:
    """Enter words by body, in mm; letters are half as high as an eye's radius where nobody says."""
    sizes = plan.layout.sizes
    for body, wish in wishes:
        height = wish.height / sizes.scale or sizes.eye / 2
        mark = Mark(wish.word, wish.x / sizes.scale, wish.y / sizes.scale, height)
        plan.marks.setdefault(body, []).append(mark)


def refuse_letters(name: str, word: str) -> None:
    """Raise UserError where a word cannot be engraved."""
    unknown = [letter for letter in word if letter not in LETTERS]
    if unknown or not word:
        what = f"cannot engrave {unknown[0]!r}" if unknown else "there is no letter to engrave"
        raise UserError(f"{name}: {what}; there are strokes for {''.join(LETTERS)}")


def marked(shape: cq.Workplane, plan: Plan, body: str, thickness: float) -> cq.Workplane:
    """Return the plate of ``body``, z = 0 to ``thickness``, with its words.

    Raises UserError naming word, body and place where a word is not wholly on the plate.
    """
    for mark in plan.marks.get(body, []):
        strokes = text(mark.word, mark.height, mark.x, mark.y, width=WIDTH * mark.height)
        slab = cq.Workplane(origin=(mark.x, mark.y, 0)).rect(1e3, 1e3).extrude(thickness)
        wanted = slab.val().Volume() - engraved(slab, strokes, thickness, DEPTH).val().Volume()
        before, shape = shape, engraved(shape, strokes, thickness, DEPTH)
        if before.val().Volume() - shape.val().Volume() < LEAST * wanted:
            scale = plan.layout.sizes.scale
            place = f"({mark.x * scale:g}, {mark.y * scale:g}) mm"
            raise UserError(
                f"{plan.layout.m.name}: '{mark.word}' at {place} is not all on the upper face of '{body}'; move it, or "
                "make it smaller with height="
            )
    return shape


# The base: a plate, engraved with the joints' names, a rule and a dial round what is driven; it lies, or stands.

PLATE, FOOT_HEIGHT = 12.0, 3.0
MARGIN = (48.0, 40.0)
"""Margins of the plate beyond the places where something stands (rmm)."""
SLIM = (42.0, 36.0)
"""Margins of a plate on a stand, whose corners carry no screws."""
INSET = 12.0
"""Inset of the screws at the corners."""
LONGEST_RULE = 420.0
DIAL = 22.5
MOST_LETTERS = 3


def base(plan: Plan, engraved_too: bool = True) -> list[Solid]:
    """Return the plate, the ground's main piece, and what carries it.

    It is engraved if ``engraved_too``. Screws and feet, or spacers to a wall, are there where it is on no stand.
    Nothing where the ground itself is all that one needs.
    """
    back = back_plate(plan)
    if back is None:
        return []
    upright, (x0, y0, x1, y1) = Upright.from_mount(plan.mount), back.corners
    bolts = [(x, y, 2 * radius, BOLT_HOLE) for x, y, radius in back.holes]
    rests = plan.mount.kind in ("desk", "wall")
    corners = [(x, y) for x in (x0 + INSET, x1 - INSET) for y in (y0 + INSET, y1 - INSET)] if rests else []
    screw = _corner_screw(plan.layout.sizes)
    plate = base_plate((x0, y0, x1, y1), PLATE, 12.0, corners, screw.diameter, screw.room, bolts)
    if engraved_too:
        plate = engraved(plate, _marks(plan, upright, (x0, y0, x1, y1)), 0.0)
    seat = plan.layout.sizes.pivot.fit.seat
    solids = [Solid("base_plate", plate, "aluminium_black", len(corners))]
    under = foot(18.0, FOOT_HEIGHT, screw.diameter + 0.4)
    for i, (x, y) in enumerate(corners):
        solids += [
            Solid(f"corner_screw_{i + 1}", placed(screw.shape, x, y, seat - screw.room[1]), "steel", 0, buy=screw.buy),
            Solid(f"foot_{i + 1}", placed(under, x, y, -PLATE - seat), "rubber", 1),
        ]
    return [replace(solid, shape=upright.in_model(solid.shape)) for solid in solids]


def back_plate(plan: Plan) -> BackPlate | None:
    """Return the plate (rmm) as its mount has it; None where the ground itself is all that one needs."""
    if plan.mount.kind == "ground" and all(stand.road for stand in plan.feet) and not plan.base_under:
        return None
    upright, sizes = Upright.from_mount(plan.mount), plan.layout.sizes
    hole = sizes.screw / sizes.finished + 0.4
    bolts = [(*upright.seen_place(x, y), hole / 2) for stand in plan.feet for x, y in stand.holes]
    return BackPlate(_extent(plan, upright), 0.0, PLATE, 1.0, sizes.pivot.fit.seat, tuple(bolts))


@dataclass(frozen=True)
class _Screw:
    """Screw of a corner (rmm), through the plate and its foot.

    ``room``: diameter and depth of its counterbore.
    """

    shape: cq.Workplane
    diameter: float
    room: tuple[float, float]
    buy: str = ""


def _corner_screw(sizes: Sizes) -> _Screw:
    """Return the standard screw next to 5 rmm; of 5 rmm where none is near."""
    nominal = min(SOCKET, key=lambda size: abs(size - 5.0 * sizes.finished))
    diameter = nominal / sizes.finished
    room = head_diameter(nominal) / sizes.finished + 0.5, diameter + 0.4
    longest = PLATE + FOOT_HEIGHT - room[1] - 0.4
    length = screw_length(nominal, longest * sizes.finished)
    if length is None or not 4.0 < diameter < 6.25:
        return _Screw(socket_screw(5.0, 8.5), 5.0, (9.0, 5.4))
    shape = socket_screw(nominal, length)
    shape = shape.newObject([shape.val().scale(1 / sizes.finished)])
    return _Screw(shape, diameter, room, screw_name(nominal, length))


def _extent(plan: Plan, upright: Upright) -> tuple[float, float, float, float]:
    """Return the extent of the plate: round all feet, or without any under what moves.

    It reaches as far as one wishes.
    """
    if plan.feet:
        places = np.array([[stand.x, stand.y] for stand in plan.feet])
    else:
        places = np.concatenate([plan.layout.poses[body][:, :2] for body in plan.layout.moving])
    places = upright.seen(places)
    (x0, y0), (x1, y1) = places.min(axis=0), places.max(axis=0)
    right, up = MARGIN if plan.mount.kind in ("desk", "wall") else SLIM
    under = [upright.seen_place(x, y) for x, y in plan.base_under]
    corners = np.array([[x0 - right, y0 - up], [x1 + right, y1 + up], *under])
    return (*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())


def _marks(plan: Plan, upright: Upright, extent: tuple[float, float, float, float]) -> list[cq.Face]:
    y0 = extent[1]
    marks: list[cq.Face] = []
    feet = [_seen(stand, upright) for stand in plan.feet]
    xs = [stand.x for stand in feet]
    middle = (min(xs) + max(xs)) / 2 if xs else 0.0
    for stand, there in zip(feet, plan.feet, strict=True):
        if stand.dial and plan.layout.room_on_base(there.x, there.y) > DIAL + 4.0:
            marks += dial(stand.x, stand.y, DIAL, 10.0)
        marks += _letters(stand, middle, feet)
    reach = max(xs) - min(xs) if xs else 0.0
    if 30.0 < reach < LONGEST_RULE:
        marks += _ruler(plan.layout.sizes, reach, min(xs), y0)
    return marks


def _seen(stand: Foot, upright: Upright) -> Foot:
    x, y = upright.seen_place(stand.x, stand.y)
    return replace(stand, x=x, y=y)


def _letters(stand: Foot, middle: float, feet: Sequence[Foot]) -> list[cq.Face]:
    """Return the joint's name beside its foot, away from the others, if it is short and its place is free."""
    if not 0 < len(stand.label) <= MOST_LETTERS or any(letter not in LETTERS for letter in stand.label):
        return []
    aside = stand.radius + 10.5 + 3.0 * (len(stand.label) - 1) + (4.0 if stand.dial else 0.0)
    x = stand.x + (aside if stand.x > middle + 1.0 else -aside)
    if any(math.hypot(x - s.x, stand.y - s.y) < s.radius + 8.0 for s in feet if s is not stand):
        return []
    return text(stand.label, 7.0, x, stand.y, width=1.2)


def _ruler(sizes: Sizes, reach: float, x: float, y0: float) -> list[cq.Face]:
    """Return a rule in millimetres of the finished piece, its strokes 3 to 8 rmm apart."""
    step = next(
        s for power in range(-3, 6) for s in (10.0**power, 5 * 10.0**power) if s * 0.999 / sizes.finished >= 3.0
    )
    short = step / sizes.finished
    marks = rule(reach, x, y0 + 3.4, step=short)
    count = math.floor(reach / short + 1e-9)
    every = next(n for n in (2, 4, 10, 20, 40, 100) if n * short >= 14.0 + 2.0 * len(f"{count * step:g}"))
    for i in range(0, count + 1, every):
        label = f"{i * step:g}"
        if all(letter in LETTERS for letter in label):
            marks += text(label, 2.6, x + i * short, y0 + 9.0, width=0.45)
    return marks


# From a plan to solids: plates, base and hardware, at last scaled to millimetres.


def built(plan: Plan, heights: Heights, engraved_too: bool = True) -> dict[str, list[Solid]]:
    """Return all solids by body, in mm; ``engraved_too``: the base with its names, rule and dial.

    Raises UserError where two bores of a body meet.
    """
    refuse_meeting_bores(plan)
    made: dict[str, list[Solid]] = {"ground": [*base(plan, engraved_too), *plan.solids.get("ground", [])]}
    shown = Shown("parts", plan.layout.m.name, len(plan.layout.moving), "plates shaped")
    for body in plan.layout.moving:
        shown.advance()
        with kernel_refusals(plan.layout.m.name, f"the plate of '{body}'"):
            shape, holes = _plate(plan, body, heights.thickness)
            for tool, through in plan.cuts.get(body, []):
                shape, holes = shape.cut(tool), holes + through
            shape = marked(shape, plan, body, heights.thickness)
        plate = Solid(plan.main[body], placed(shape, z=heights.bottom(body)), plan.materials[body], holes)
        made.setdefault(plan.layout.webs.get(body, body), []).extend([plate, *plan.solids.get(body, [])])
    scale, tolerance = plan.layout.sizes.scale, plan.layout.sizes.tolerance
    return {
        body: [replace(scaled(solid, scale), tolerance=tolerance) for solid in solids] for body, solids in made.items()
    }


def fitted(bodies: dict[str, list[Solid]]) -> dict[str, list[Solid]]:
    """Return the same, marked as pieces whose sizes were chosen for what is made."""
    return {body: [replace(solid, fitted=True) for solid in solids] for body, solids in bodies.items()}


def _plate(plan: Plan, body: str, thickness: float) -> tuple[cq.Workplane, int]:
    """Return all that is one piece in the layer of a body, and its number of through holes."""
    if body in plan.wheels:
        return _geared(plan, body, thickness)
    eyes = plan.eyes.get(body, [])
    if body in plan.layout.rods:
        return rod_shape(eyes, thickness)
    eyes = [*eyes, *_blanks(plan, body, eyes)]
    plates = plan.plates.get(body, [])
    if not plates:
        slots = plan.slots.get(body, [])
        yoke = yoke_shape(eyes, slots[0], thickness) if len(slots) == 1 else None
        return (yoke, sum(eye.bore > 0 for _, _, eye in eyes)) if yoke else body_shape(eyes, thickness)
    beside = [eye for eye in eyes if not any(_is_held(eye, plate.holds) for plate in plates)]
    shape, holes = plates[0].shape, sum(plate.through_holes for plate in plates)
    for plate in plates[1:]:
        shape = shape.union(plate.shape)
    if not beside and shape.solids().size() == 1:
        return with_eyes(shape, eyes, thickness, 0.0), holes + sum(eye.bore > 0 for _, _, eye in eyes)
    link, own = body_shape(eyes, thickness)
    bores = [(x, y, Eye(eye.radius, eye.bore)) for x, y, eye in eyes]
    return with_eyes(shape.union(link), bores, thickness, 0.0), holes + own


def _geared(plan: Plan, body: str, thickness: float) -> tuple[cq.Workplane, int]:
    """Return a toothed plate: a wheel that carries its eyes, or a wheel and a plate round its eyes."""
    eyes, own_wheel = plan.eyes.get(body, []), plan.wheels[body]
    wheel, holes = shape_of(own_wheel, thickness, [(x - own_wheel.x, y - own_wheel.y, eye) for x, y, eye in eyes])
    wheel = placed(wheel, own_wheel.x, own_wheel.y)
    for plate in plan.plates.get(body, []):
        wheel, holes = wheel.union(plate.shape), holes + plate.through_holes
    if not plan.layout.anchors[body]:
        return wheel, holes
    arm = [*eyes, *_blanks(plan, body, eyes)]
    shape, _ = body_shape(
        [(u, v, Eye(eye.radius, 0.0, eye.above, eye.below, eye.boss)) for u, v, eye in arm], thickness
    )
    shape = shape.union(wheel)
    bored = [(u, v, eye) for u, v, eye in eyes if eye.bore > 0]
    for u, v, eye in bored:
        shape = shape.cut(placed(extruded(circle(0, 0, eye.bore / 2), 400.0, -200.0), u, v))
    return shape, len(bored)


def _is_held(eye: PlacedEye, circle: Circle) -> bool:
    return math.hypot(eye[0] - circle[0], eye[1] - circle[1]) + eye[2].radius <= circle[2] + 0.01


def _blanks(plan: Plan, body: str, eyes: list[PlacedEye]) -> list[PlacedEye]:
    """Return places that the outline reaches without an eye there."""
    return [
        (anchor.x, anchor.y, Eye(anchor.radius, 0.0))
        for anchor in plan.layout.anchors[body]
        if all(math.hypot(anchor.x - x, anchor.y - y) > 0.01 for x, y, _ in eyes)
    ]


def scaled(solid: Solid, scale: float) -> Solid:
    """Return a solid with all lengths times ``scale``."""
    if scale == 1.0:
        return solid
    shape = cq.Workplane(obj=solid.shape.val().scale(scale))
    holds = tuple(replace(hold, z=hold.z * scale, radius=hold.radius * scale) for hold in solid.holds)
    roll = solid.rolls
    if roll is not None:
        roll = replace(roll, x=roll.x * scale, y=roll.y * scale, radius=roll.radius * scale)
    return replace(solid, shape=shape, holds=holds, rolls=roll)
