"""Prismatic joints: rails of their own, rails that several share, and rails that cross."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout import motion
from mechanisms.stages.automatic.layout.items import BASE, Anchor, Heights, Item, Levels, Need, Reach
from mechanisms.stages.automatic.layout.layout import Feature, Layout
from mechanisms.stages.automatic.layout.plan import Foot, Plan, build, kind
from mechanisms.stages.automatic.layout.planar import Rounded, core_gaps, disc
from mechanisms.stages.automatic.layout.sizes import Extent, extent
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, POST, RAIL, Slide, bar
from shared.shapes import outline
from shared.shapes.build import eased, extruded

# Slides on ground whose rails would cross, as of an elliptical trammel: a plate with grooves, and shuttles in them.
#
# Each shuttle has a tongue below its plate, longer than a groove is wide, so that it is guided while it passes the
# other groove. All shuttles of a plate share a layer, as their tongues must reach the grooves.

TONGUE, TONGUE_DEPTH = 11.0, 6.5
"""Width of a tongue, and how far it reaches down."""
TONGUE_HALF = 22.0
"""Half of its length: twice as long as the grooves that it passes are wide."""
FLOOR = 3.5
"""Thickness of the plate below its grooves, at least."""
WALL = 8.0
"""Width of the plate beside its grooves."""
CORE = 30.0
"""Radius of the plate about the crossing."""
SMALLEST = math.radians(30.0)
"""Grooves at a smaller angle would leave a tongue without a guide where they cross."""

type Ends = list[tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Crossing(Feature):
    """Slides on ground in the grooves of one plate."""

    slides: tuple[Slide, ...]

    @property
    def name(self) -> str:
        """Names of its joints."""
        return "_".join(slide.name for slide in self.slides)

    @property
    def what(self) -> str:
        """Name of the plate."""
        return f"the grooved plate of {' and '.join(slide.name for slide in self.slides)}"

    @property
    def blocks(self) -> tuple[str, ...]:
        """The bodies of the shuttles."""
        return tuple(dict.fromkeys(slide.block for slide in self.slides))

    @property
    def middle(self) -> tuple[float, float]:
        """Where the grooves cross: of more than two the mean."""
        places = [_crossing(*pair) for pair in combinations(self.slides, 2)]
        x, y = np.mean([place for place in places if place is not None], axis=0)
        return float(x), float(y)

    def groove(self, slide: Slide) -> Ends:
        """Return middles (rmm) of the round ends of a groove."""
        reach = TONGUE_HALF - TONGUE / 2
        return [slide.rail_place(slide.travel[0] - reach), slide.rail_place(slide.travel[1] + reach)]

    def tongue(self, slide: Slide) -> Ends:
        """Return middles (rmm) of the round ends of a tongue, in the frame of its body."""
        reach = TONGUE_HALF - TONGUE / 2
        return [slide.block_place(-reach), slide.block_place(reach)]

    def anchors(self, layout: Layout) -> Iterable[Anchor]:
        """Return the plates of the shuttles; what the grooved plate is fixed by."""
        eye = layout.sizes.eye
        anchors = [Anchor(slide.block, x, y, eye) for slide in self.slides for x, y in slide.block_ends(eye)]
        return [*anchors, *(Anchor("ground", x, y, WALL) for slide in self.slides for x, y in self.groove(slide))]

    def items(self, layout: Layout) -> Iterable[Item]:
        """Yield the plate below the shuttles, and their tongues in it."""
        tongues = {slide.name: f"the tongue of {slide.name}" for slide in self.slides}
        meshes, reach = frozenset(tongues.values()), Reach(self.blocks, -1, -1, base=True)
        for slide in self.slides:
            arm = Rounded(np.array(self.groove(slide)), TONGUE / 2 + WALL + 0.5)
            yield Item(self.what, "ground", arm, reach, source=self, meshes=meshes, stands=self.what)
            shape = Rounded(np.array(self.tongue(slide)), TONGUE / 2 + 0.5)
            below = Reach((slide.block,), -1, -1)
            yield Item(tongues[slide.name], slide.block, shape, below, source=self, meshes=frozenset((self.what,)))
        yield Item(self.what, "ground", disc(*self.middle, CORE), reach, source=self, meshes=meshes, stands=self.what)

    def needs(self, levels: Levels, layout: Layout) -> Iterable[Need]:
        """Yield the room for the plate."""
        if levels[self.blocks[0]] == 0:
            yield Need(BASE, FLOOR + TONGUE_DEPTH + 2 * layout.sizes.pivot.fit.axial)
        else:
            yield Need(levels[self.blocks[0]] - 1, TONGUE_DEPTH + 2 * layout.sizes.pivot.fit.axial)


def with_crossings(slides: Sequence[Slide], layout: Layout) -> list[Feature]:
    """Return the slides, those on ground that cross as one feature."""
    group = {slide.name: slide.name for slide in slides}
    for first, second in combinations([slide for slide in slides if slide.rail == "ground"], 2):
        if _crossing(first, second) is not None and group[first.name] != group[second.name]:
            old, new = group[second.name], group[first.name]
            group = {name: new if of == old else of for name, of in group.items()}
    features: list[Feature] = []
    for head in dict.fromkeys(group.values()):
        members = tuple(slide for slide in slides if group[slide.name] == head)
        if len(members) == 1:
            features += members
            continue
        crossing = Crossing(members)
        layout.together += [(crossing.blocks[0], block) for block in crossing.blocks[1:]]
        features.append(crossing)
    return features


def _crossing(first: Slide, second: Slide) -> np.ndarray | None:
    """Return (2,) where two rails would cross.

    None where they stay clear of each other, or are nearly parallel.
    """
    if first.block == second.block:
        return None
    (a, b), (c, d) = (np.array(slide.rail_ends()) for slide in (first, second))
    if core_gaps(np.array([[a, b]]), np.array([[c, d]]))[0] > RAIL + 2.0 + 2 * (HALF_LENGTH - TONGUE_HALF):
        return None
    u, v = (b - a) / np.hypot(*(b - a)), (d - c) / np.hypot(*(d - c))
    sine = u[0] * v[1] - u[1] * v[0]
    if abs(sine) < math.sin(SMALLEST):
        return None
    return a + u * ((c - a)[0] * v[1] - (c - a)[1] * v[0]) / sine


# The solids of crossing slides (rmm): a plate with grooves on the base, and a tongue under each shuttle.


@build.register(Crossing)
def crossed(crossing: Crossing, plan: Plan, heights: Heights) -> None:
    """A cross with a round middle, its grooves cut into it, and the tongues."""
    fit = plan.layout.sizes.pivot.fit
    face = heights.bottom(crossing.blocks[0])
    top, bottom = face - fit.axial, fit.seat
    plate = extruded(outline.circle(*crossing.middle, CORE), top - bottom, bottom)
    for slide in crossing.slides:
        plate = plate.union(bar(crossing.groove(slide), TONGUE / 2 + WALL, bottom, top))
    plate = eased(plate, 0.8, ">Z", chamfer=True)
    floor = top - TONGUE_DEPTH
    for slide in crossing.slides:
        plate = plate.cut(bar(crossing.groove(slide), (TONGUE + fit.running) / 2, floor, top + 1.0))
        plan.feet += [Foot("", x, y, TONGUE / 2 + WALL) for x, y in crossing.groove(slide)]
        tongue = bar(crossing.tongue(slide), TONGUE / 2, floor + fit.axial, face - fit.seat)
        plan.make(slide.block, f"tongue_{slide.name}", eased(tongue, 0.5, "<Z", chamfer=True), "bronze", 0)
    plan.make("ground", f"grooves_{crossing.name}", plate, "aluminium", 0)


# Blocks that slide along one line of a body: on one rail where they never meet, else on rails one above the other.
#
# Carts of a track run on one rail. Where blocks pass each other in the plane, each next rail on ground is longer than
# those before, so that its posts stand beyond them.

ON_LINE, ALONG = 1e-3, 1e-6
"""Lines that are nearer (rmm) and more parallel (rad) are one."""
NEAR = 0.05
"""Blocks that come nearer to each other than this part of their way need not fit beside each other."""


@extent("prismatic")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Raise UserError unless blocks on a line never pass each other."""
    least: list[tuple[float, float]] = []
    own = _way(joint, joint, solution)
    for other in solution.mechanism.joints.values():
        same = other.kind.name == "prismatic" and other.i.body is joint.i.body and other.j.body is not joint.j.body
        if not same or "ground" in (joint.j.body.name, other.j.body.name):
            continue
        way = _way(other, joint, solution)
        aside = max(np.abs(own[:, 1]).max(), np.abs(way[:, 1]).max())
        reach = float(np.ptp(np.concatenate([own[:, 0], way[:, 0]])))
        between = way[:, 0] - own[:, 0]
        apart = float(np.abs(between).min())
        if aside < 1e-6 * reach and np.abs(np.sign(between).sum()) == len(between) and apart > NEAR * reach:
            least.append((apart, 2 * HALF_LENGTH + 2.0))
    return Extent((), tuple(least))


def _way(joint: Joint, line: Joint, solution: Solution) -> np.ndarray:
    """Return (T, 2) the block's marker along and across the line of another joint of the same rail (m)."""
    rail, block = solution.place(line.i), solution.place(joint.j)
    x, y, c, s = block.x - rail.x, block.y - rail.y, np.cos(rail.theta), np.sin(rail.theta)
    return np.stack([c * x + s * y, c * y - s * x], axis=1)


def on_one_line(slide: Slide, other: Slide) -> bool:
    """Return True if two slides of a body guide along the same line of it, this way or the other."""
    x, y, angle = other.rail_at
    aside = (slide.rail_at[1] - y) * math.cos(angle) - (slide.rail_at[0] - x) * math.sin(angle)
    return slide.rail == other.rail and abs(aside) < ON_LINE and abs(math.sin(slide.rail_at[2] - angle)) < ALONG


def with_common_rails(slides: Sequence[Slide], layout: Layout) -> list[Slide]:
    """Return the slides, those that overlap along one line on common rails or on longer ones."""
    lines: list[list[Slide]] = []
    for slide in slides:
        for line in lines:
            if slide.block != "ground" and line[0].block != "ground" and on_one_line(slide, line[0]):
                line.append(slide)
                break
        else:
            lines.append([slide])
    return [slide for line in lines for slide in (line if len(line) == 1 else _laid(line, layout))]


def _laid(line: list[Slide], layout: Layout) -> list[Slide]:
    """Return slides on one line: the first of each group of slides that share a rail builds it."""
    rails: list[list[Slide]] = []
    for slide in line:
        free = (rail for rail in rails if all(_may_share(slide, other, line[0], layout) for other in rail))
        rail = next(free, None)
        if rail is None:
            rails.append([slide])
        else:
            rail.append(slide)
    laid: list[Slide] = []
    taken: list[tuple[float, float]] = []
    beside = _rail_distance(layout)
    for host, *guests in rails:
        lows, highs = zip(*(_span(slide, line[0]) for slide in (host, *guests)), strict=True)
        low, high = min(lows), max(highs)
        if host.rail == "ground":
            for first, last in taken * len(taken):  # a longer rail may come to another one
                if low - beside < last and first < high + beside:
                    low, high = min(low, first - beside - POST), max(high, last + beside + POST)
            taken.append((low, high))
        laid.append(replace(_with_ends(host, line[0], low, high), guests=tuple(guests)))
        laid += [replace(guest, host=host.name) for guest in guests]
        layout.together += [(host.block, guest.block) for guest in guests]
    return laid


def _rail_distance(layout: Layout) -> float:
    """Return the least distance between the middles of the round ends of two rails that do not overlap."""
    return RAIL + 2.0 + layout.sizes.room


def _may_share(slide: Slide, other: Slide, line: Slide, layout: Layout) -> bool:
    """Return True if two overlapping rails can be one: blocks never meet, no stop is in the way."""
    first, second = _span(slide, line), _span(other, line)
    if min(first[1], second[1]) - max(first[0], second[0]) < -_rail_distance(layout):
        return False
    if any(end is not None for end in (*slide.ends, *other.ends)):
        return False
    away = np.abs(_middle(slide, line, layout) - _middle(other, line, layout))
    return float(away.min()) > 2 * HALF_LENGTH + layout.sizes.room


def _middle(slide: Slide, line: Slide, layout: Layout) -> np.ndarray:
    """Return (T,) of a block along the line."""
    x, y, angle = line.rail_at
    seen = layout.seen(slide.block, slide.block_at[:2], slide.rail) - (x, y)
    return seen @ np.array([math.cos(angle), math.sin(angle)])


def _span(slide: Slide, line: Slide) -> tuple[float, float]:
    """Return middles of a rail's round ends along the line, the lower first."""
    x, y, angle = line.rail_at
    places = (np.array(slide.rail_ends()) - (x, y)) @ np.array([math.cos(angle), math.sin(angle)])
    return float(places.min()), float(places.max())


def _with_ends(slide: Slide, line: Slide, low: float, high: float) -> Slide:
    """Return the slide with a rail whose round ends are there."""
    first, last = _span(slide, line)
    before, behind = slide.shorter
    if math.cos(slide.rail_at[2] - line.rail_at[2]) > 0:
        return replace(slide, shorter=(before + low - first, behind + last - high))
    return replace(slide, shorter=(before + last - high, behind + low - first))


# Prismatic joints by their slides; those on ground whose rails would cross are the grooves of one plate.

FAR = 4.0
"""Stops farther beyond the travel than it is long, or than this (half lengths of a block), are not made."""
BESIDE = 0.5
"""Between the end of a rail and the pin beyond it (rmm)."""


@kind("prismatic")
def gather(m: Mechanism, joints: list[Joint], layout: Layout) -> list[Feature]:
    """Return one feature for each joint, or for several that belong together.

    Those on ground that cross are one, and those of two bodies along one line; several blocks along one line have a
    common rail where they can.
    """
    slides: list[Slide] = []
    for joint in joints:
        rail_at, block_at = (*layout.place(joint.i), joint.i.angle), (*layout.place(joint.j), joint.j.angle)
        along = layout.seen(joint.j.body.name, block_at[:2], joint.i.body.name) - np.array(rail_at[:2])
        place = along @ np.array([math.cos(joint.i.angle), math.sin(joint.i.angle)])
        travel = float(place.min()), float(place.max())
        lower, upper = (None if end is None else layout.sizes.of_metres(end) for end in motion.sliding(joint, m))
        ends = motion.reached((lower, upper), travel, FAR * HALF_LENGTH)
        given = [end for end in ends if end is not None]
        travel = min(travel[0], *given, travel[1]), max(travel[1], *given, travel[0])
        slide = Slide(joint.name, joint.i.body.name, joint.j.body.name, rail_at, block_at, travel, ends)
        slide = replace(slide, shorter=_room_for_pins(slide, m, layout))
        if given or not any(_repeats(slide, other) for other in slides):
            slides.append(slide)
    return with_crossings(with_common_rails(slides, layout), layout)


def _repeats(slide: Slide, other: Slide) -> bool:
    """Return True if another slide of the same two bodies guides along the same line already."""
    return slide.block == other.block and on_one_line(slide, other)


def _room_for_pins(slide: Slide, m: Mechanism, layout: Layout) -> tuple[float, float]:
    """Return how much the rail's ends are shortened beside pins of its body, down to the end of the block."""
    if slide.rail == "ground":
        return 0.0, 0.0
    c, s = math.cos(slide.rail_at[2]), math.sin(slide.rail_at[2])
    near = RAIL / 2 + layout.sizes.hardware + BESIDE
    first, last = slide.travel[0] - HALF_LENGTH, slide.travel[1] + HALF_LENGTH
    before = behind = 0.0
    for joint in m.joints.values():
        for marker in (joint.i, joint.j):
            if joint.kind.pair != "pin" or marker.body.name != slide.rail:
                continue
            x, y = layout.place(marker)
            x, y = x - slide.rail_at[0], y - slide.rail_at[1]
            along, aside = c * x + s * y, abs(c * y - s * x)
            if aside < near:
                reach = math.sqrt(near * near - aside * aside)
                if along < slide.travel[0]:
                    before = max(before, along + reach - first)
                elif along > slide.travel[1]:
                    behind = max(behind, last - (along - reach))
    return min(before, RAIL / 2), min(behind, RAIL / 2)
