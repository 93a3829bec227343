"""Solids of pin joints: bolts, washers, circlips and pins of hardened steel (mm)."""

from __future__ import annotations

from mechanisms.stages.automatic.layout.items import Heights, Levels
from mechanisms.stages.automatic.layout.plan import BOLT_HOLE, Foot, Plan, build
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.pins.pins import Pin
from shared.shapes.base import bolt_circle, column, pedestal
from shared.shapes.build import bore
from shared.shapes.link import Eye
from shared.shapes.pin import Head, bushing, pin, washer
from shared.shapes.screw import socket_screw
from shared.shapes.solid import Solid, placed
from shared.shapes.standards import screw_length, screw_name

# The solids of a pin: what holds it, what runs on it, and what keeps it in place (rmm).

FLANGE, CIRCLE = 39.0, 31.0
"""Diameters of a pedestal's flange and of the circle of its screws."""
FLANGE_THICKNESS = 4.0
TOP, FOOT = 17.0, 20.0
"""Diameters of a pedestal's column."""


def moving_pin(joint: Pin, stack: list[str], plan: Plan, heights: Heights) -> None:
    """A pin pressed into the lowest of ``stack``; its head is above the highest."""
    sizes = plan.layout.sizes
    pivot, fit = sizes.pivot, sizes.pivot.fit
    holder, runners = stack[0], stack[1:]
    x, y = joint.places[holder]
    low = heights.top(holder)
    boss = boss_height(heights.bottom(runners[0]) - pivot.flange_room - fit.axial - pivot.washer_room - low)
    plan.eye(holder, x, y, holding_eye(sizes, above=boss))
    plan.add(holder, pivot.washer_at(f"washer_{joint.name}", x, y, low + boss + fit.seat))
    run(joint, runners, holder, plan, heights)
    start = heights.bottom(holder) + 0.3
    head = heights.top(runners[-1]) + pivot.flange_room + fit.axial
    bolt = pin(pivot.pin, head - start, sizes.head)
    plan.make(holder, f"pin_{joint.name}", placed(bolt, x, y, start), "brass", 0)


def hanging_pin(joint: Pin, stack: list[str], plan: Plan, heights: Heights) -> None:
    """A pin pressed into the highest of ``stack``; a circlip keeps it under the lowest.

    Its head is where there is room.
    """
    sizes, name = plan.layout.sizes, joint.name
    pivot, fit = sizes.pivot, sizes.pivot.fit
    holder, runners = stack[-1], stack[:-1]
    x, y = joint.places[holder]
    high = heights.bottom(holder)
    boss = boss_height(high - pivot.washer_room - fit.axial - pivot.flange_room - heights.top(runners[-1]))
    plan.eye(holder, x, y, holding_eye(sizes, below=boss))
    plan.add(holder, pivot.washer_at(f"washer_{name}_high", x, y, high - boss - pivot.washer_room))
    run(joint, runners, holder, plan, heights)
    clip = heights.bottom(runners[0]) - pivot.flange_room - pivot.retainer_room
    low = clip - sizes.pin_end
    covered = _flush(joint, holder, plan, heights)
    end = heights.top(holder) + (-0.3 if covered else fit.seat)
    bolt = pin(pivot.pin, end - low, None if covered else sizes.head, pivot.groove(clip - low))
    plan.make(holder, f"pin_{name}", placed(bolt, x, y, low), "brass", 0)
    plan.add(
        holder,
        pivot.washer_at(f"washer_{name}_low", x, y, clip + pivot.clip_thickness + fit.seat),
        pivot.clip_at(f"circlip_{name}", x, y, clip, turn=180),
    )


def ground_pin(joint: Pin, stack: list[str], plan: Plan, heights: Heights) -> None:
    """A pedestal with a fixed pin; a circlip above the highest of ``stack``."""
    sizes, name = plan.layout.sizes, joint.name
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = joint.places["ground"]
    height = heights.bottom(stack[0]) - pivot.flange_room - fit.axial - pivot.washer_room
    wheel = plan.layout.wheel_at(x, y)
    if wheel is None:
        standing(name, (x, y), height, plan, dial=joint.driven, levels=heights.levels)
    else:  # the wheel and its post carry it
        foot = heights.top(wheel.layer) + fit.seat
        post = column(height - foot, pivot.held, TOP, TOP)
        plan.make("ground", f"pedestal_{name}", placed(post, x, y, foot), "aluminium", 1)
        plan.feet.append(Foot(name, x, y, wheel.root, dial=joint.driven))
    run(joint, stack, "ground", plan, heights)
    clip = heights.top(stack[-1]) + pivot.flange_room + pivot.retainer_room - pivot.clip_thickness
    bolt = pin(pivot.pin, clip + pivot.clip_thickness + sizes.pin_end - 0.5, None, pivot.groove(clip - 0.5))
    plan.make("ground", f"pin_{name}", placed(bolt, x, y, 0.5), "steel", 0)
    plan.add(
        "ground",
        pivot.washer_at(f"washer_{name}_low", x, y, height + fit.seat),
        pivot.washer_at(f"washer_{name}_high", x, y, clip - fit.seat - pivot.washer_thickness),
        pivot.clip_at(f"circlip_{name}", x, y, clip, turn=225),
    )


def upper_end(joint: Pin, plan: Plan, heights: Heights) -> tuple[str, float]:
    """Return the body that holds a pin, and the height of the pin's upper end."""
    sizes = plan.layout.sizes
    pivot, fit = sizes.pivot, sizes.pivot.fit
    stack = sorted(joint.movers, key=heights.bottom)
    top = heights.top(stack[-1])
    if joint.on_ground:
        return "ground", top + pivot.flange_room + pivot.retainer_room + sizes.pin_end
    if heights.levels[joint.choice] == 0:
        return stack[0], top + pivot.flange_room + fit.axial + sizes.head.height
    return stack[-1], top + (-0.3 if _flush(joint, stack[-1], plan, heights) else fit.seat + sizes.head.height)


def _flush(joint: Pin, holder: str, plan: Plan, heights: Heights) -> bool:
    """Return True if something passes where the head of a hanging pin would be."""
    half = 2 * heights.levels[holder]
    return any(plan.layout.is_covered(joint, half + above, heights.levels) for above in (1, 2))


def run(joint: Pin, runners: list[str], holder: str, plan: Plan, heights: Heights) -> None:
    """Bushings in every body that turns on the pin, and a sleeve between each and the next."""
    sizes = plan.layout.sizes
    pivot = sizes.pivot
    run = pivot.flange_room + pivot.fit.axial
    for below, body in zip([None, *runners], runners, strict=False):
        label = joint.name if len(runners) == 1 else f"{joint.name}_{body}"
        x, y = joint.places[body]
        plan.eye(body, x, y, Eye(sizes.eye, pivot.running))
        plan.add(body, *pivot.bushings(label, x, y, heights.bottom(body), heights.thickness, joint.play))
        if below is not None:
            start = heights.top(below) + run
            tube = washer(pivot.pin + pivot.fit.running, pivot.washer, heights.bottom(body) - run - start)
            at = joint.places[holder]
            plan.make(holder, f"sleeve_{joint.name}_{below}", placed(tube, *at, start), "steel", 1)


def standing(
    name: str,
    at: tuple[float, float],
    height: float,
    plan: Plan,
    label: str | None = None,
    dial: bool = False,
    kind: str = "pedestal",
    levels: Levels | None = None,
) -> None:
    """A pedestal on the base plate, with a flange and screws where there is room beside its neighbours.

    Where ``levels`` are given, what moves under the lowest layer counts as well.

    ``label`` is what is engraved beside it, by default its name.
    """
    sizes = plan.layout.sizes
    pivot, seat = sizes.pivot, sizes.pivot.fit.seat
    x, y = at
    room = plan.layout.room_on_base(x, y)
    if levels is not None:
        room = min(room, plan.layout.room_below(x, y, levels))
    label = name if label is None else label
    if room < FLANGE / 2 + 0.5 or sizes.screw == 0:
        foot = min(FOOT, 2 * room - 1.0)
        post = column(height - seat, pivot.held, min(TOP, foot), foot)
        plan.make("ground", f"{kind}_{name}", placed(post, x, y, seat), "aluminium", 1)
        plan.feet.append(Foot(label, x, y, foot / 2, dial=dial))
        return
    nominal = sizes.screw / sizes.finished
    post = pedestal(height - seat, pivot.held, TOP, FOOT, FLANGE, FLANGE_THICKNESS, 3, nominal, CIRCLE)
    plan.make("ground", f"{kind}_{name}", placed(post, x, y, seat), "aluminium", 4)
    bolts = [(x + u, y + v) for u, v in bolt_circle(CIRCLE, 3)]
    plan.feet.append(Foot(label, x, y, FLANGE / 2, tuple(bolts), dial))
    longest = (FLANGE_THICKNESS + BOLT_HOLE - 0.5) * sizes.finished
    length = screw_length(sizes.screw, longest) or longest
    screw = socket_screw(sizes.screw, length)
    screw, bought = screw.newObject([screw.val().scale(1 / sizes.finished)]), screw_name(sizes.screw, length)
    for i, (u, v) in enumerate(bolts):
        at_screw = placed(screw, u, v, FLANGE_THICKNESS + 2 * seat)
        plan.add("ground", Solid(f"screw_{name}_{i + 1}", at_screw, "steel", 0, buy=bought))


# The solids of pins with nothing beyond their plates (rmm): sunk pivots, and pins of built-up cranks.

SUNK = Head(14.0, 1.4, 0.3)
"""Head of a pivot that is sunk into its link."""
UNDER = 0.3
"""How far such a head, or the end of a pin, is under the face of the plate."""


def flush_pivot(joint: Pin, plan: Plan, heights: Heights) -> None:
    """A pedestal with a pin whose head is in a counterbore of its one link: nothing is above it."""
    sizes, name, (body,) = plan.layout.sizes, joint.name, joint.movers
    pivot, fit = sizes.pivot, sizes.pivot.fit
    x, y = joint.places["ground"]
    u, v = joint.places[body]
    bottom = heights.bottom(body)
    height = bottom - pivot.flange_room - fit.axial - pivot.washer_room
    standing(name, (x, y), height, plan, dial=joint.driven, levels=heights.levels)
    depth = SUNK.height + fit.axial + UNDER
    floor = heights.thickness - depth
    plan.eye(body, u, v, Eye(sizes.eye, pivot.running))
    plan.cut(body, placed(bore(SUNK.diameter + fit.running + 0.4, floor + 0.5, heights.thickness + 1.0), u, v), 0)
    barrel = bushing(pivot.bored(joint.play), pivot.bushing, pivot.flange, pivot.flange_thickness, floor - 0.1)
    barrel = barrel.rotate((0, 0, 0), (1, 0, 0), 180)
    plan.make(body, f"bushing_{name}", placed(barrel, u, v, bottom - fit.seat), "bronze", 1)
    end = bottom + floor + fit.axial
    plan.make("ground", f"pin_{name}", placed(pin(pivot.pin, end - 0.5, SUNK), x, y, 0.5), "steel", 0)
    plan.add("ground", pivot.washer_at(f"washer_{name}", x, y, height + fit.seat))


def crank_pin(joint: Pin, stack: list[str], plan: Plan, heights: Heights) -> None:
    """A pin pressed into two webs of one body, the ends of ``stack``; the others turn between them."""
    sizes, name = plan.layout.sizes, joint.name
    pivot, fit = sizes.pivot, sizes.pivot.fit
    low, *runners, high = stack
    x, y = joint.places[low]
    top, under = heights.top(low), heights.bottom(high)
    room = pivot.flange_room + fit.axial + pivot.washer_room
    gaps = heights.bottom(runners[0]) - top, under - heights.top(runners[-1])
    above, below = (boss_height(gap - room) for gap in gaps)
    plan.eye(low, x, y, holding_eye(sizes, above=above))
    plan.eye(high, x, y, holding_eye(sizes, below=below))
    run(joint, runners, low, plan, heights)
    start, end = heights.bottom(low) + UNDER, heights.top(high) - UNDER
    plan.make(low, f"pin_{name}", placed(pin(pivot.pin, end - start), x, y, start), "steel", 0)
    plan.add(
        low,
        pivot.washer_at(f"washer_{name}_low", x, y, top + above + fit.seat),
        pivot.washer_at(f"washer_{name}_high", x, y, under - below - pivot.washer_room),
    )


def boss_height(room: float) -> float:
    """Return how high a boss is that fills so much room: none where it would be thinner than 0.05 rmm."""
    return room if room > 0.05 else 0.0


def holding_eye(sizes: Sizes, above: float = 0.0, below: float = 0.0) -> Eye:
    """Return the eye that holds a pin, with bosses of these heights."""
    return Eye(sizes.eye - 0.5, sizes.pivot.held, above=above, below=below, boss=min(9.5, sizes.hardware))


# Solids of a pin, by the element that holds it.


@build.register(Pin)
def pin_hardware(joint: Pin, plan: Plan, heights: Heights) -> None:
    """Eyes and hardware; a bridge builds what hangs from it."""
    stack = sorted(joint.movers, key=heights.bottom)
    hangs = heights.levels.get(joint.choice) == 1
    if joint.on_ground and hangs:
        return
    if joint.webs:
        crank_pin(joint, stack, plan, heights)
    elif joint.is_flush(heights.levels, plan.layout):
        flush_pivot(joint, plan, heights)
    elif joint.on_ground:
        ground_pin(joint, stack, plan, heights)
    elif hangs:
        hanging_pin(joint, stack, plan, heights)
    else:
        moving_pin(joint, stack, plan, heights)
