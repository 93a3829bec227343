"""Blocks that slide along one line of a body: on one rail where they never meet, else on rails one above the other.

Carts of a track run on one rail. Where blocks pass each other in the plane, each next rail on ground is longer than
those before, so that its posts stand beyond them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, POST, RAIL, Slide

if TYPE_CHECKING:
    from mbsd import Solution
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout

ON_LINE, ALONG = 1e-3, 1e-6
"""Lines that are nearer (rmm) and more parallel (rad) are one."""
NEAR = 0.05
"""Blocks that come nearer to each other than this part of their way need not fit beside each other."""


@extent("prismatic")
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Blocks that never pass each other on a line have room beside each other."""
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
    """(T, 2): the block's marker along and across the line of another joint of the same rail (m)."""
    rail, block = solution.place(line.i), solution.place(joint.j)
    x, y, c, s = block.x - rail.x, block.y - rail.y, np.cos(rail.theta), np.sin(rail.theta)
    return np.stack([c * x + s * y, c * y - s * x], axis=1)


def on_one_line(slide: Slide, other: Slide) -> bool:
    """Whether two slides of a body guide along the same line of it, this way or the other."""
    x, y, angle = other.rail_at
    aside = (slide.rail_at[1] - y) * math.cos(angle) - (slide.rail_at[0] - x) * math.sin(angle)
    return slide.rail == other.rail and abs(aside) < ON_LINE and abs(math.sin(slide.rail_at[2] - angle)) < ALONG


def with_common_rails(slides: Sequence[Slide], layout: Layout) -> list[Slide]:
    """The slides, those that overlap along one line on common rails or on longer ones."""
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
    """On one line: the first of each group of slides that share a rail builds it."""
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
    beside = _beside(layout)
    for host, *guests in rails:
        low, high = _joined([_span(slide, line[0]) for slide in (host, *guests)])
        if host.rail == "ground":
            for first, last in taken * len(taken):  # a longer rail may come to another one
                if low - beside < last and first < high + beside:
                    low, high = min(low, first - beside - POST), max(high, last + beside + POST)
            taken.append((low, high))
        laid.append(replace(_with_ends(host, line[0], low, high), guests=tuple(guests)))
        laid += [replace(guest, host=host.name) for guest in guests]
        layout.together += [(host.block, guest.block) for guest in guests]
    return laid


def _beside(layout: Layout) -> float:
    """Between the middles of the round ends of two rails that do not overlap, at least."""
    return RAIL + 2.0 + layout.sizes.room


def _may_share(slide: Slide, other: Slide, line: Slide, layout: Layout) -> bool:
    """Whether two overlapping rails can be one: the blocks never meet, and no stop is in the way of either."""
    first, second = _span(slide, line), _span(other, line)
    if min(first[1], second[1]) - max(first[0], second[0]) < -_beside(layout):
        return False
    if any(end is not None for end in (*slide.ends, *other.ends)):
        return False
    away = np.abs(_middle(slide, line, layout) - _middle(other, line, layout))
    return float(away.min()) > 2 * HALF_LENGTH + layout.sizes.room


def _middle(slide: Slide, line: Slide, layout: Layout) -> np.ndarray:
    """(T,) of a block along the line."""
    x, y, angle = line.rail_at
    seen = layout.seen(slide.block, slide.block_at[:2], slide.rail) - (x, y)
    return seen @ np.array([math.cos(angle), math.sin(angle)])


def _span(slide: Slide, line: Slide) -> tuple[float, float]:
    """Middles of a rail's round ends along the line, the lower first."""
    x, y, angle = line.rail_at
    places = (np.array(slide.rail_ends()) - (x, y)) @ np.array([math.cos(angle), math.sin(angle)])
    return float(places.min()), float(places.max())


def _joined(spans: Sequence[tuple[float, float]]) -> tuple[float, float]:
    return min(low for low, _ in spans), max(high for _, high in spans)


def _with_ends(slide: Slide, line: Slide, low: float, high: float) -> Slide:
    """The slide with a rail whose round ends are there."""
    first, last = _span(slide, line)
    before, behind = slide.shorter
    if math.cos(slide.rail_at[2] - line.rail_at[2]) > 0:
        return replace(slide, shorter=(before + low - first, behind + last - high))
    return replace(slide, shorter=(before + last - high, behind + low - first))
