"""Why there is no order of layers: the fewest bodies that cannot pass each other, and what to do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.order.layers import blocking
from mechanisms.stages.automatic.layout.order.purse import ALL, Purse
from mechanisms.stages.automatic.pins.bridges import may_hang

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.layout import Layout

REPORTED = 4
"""So many meetings are reported."""
SLOTTED = "the slotted plate of "
CROSSED = (
    "; slots on ground that cross fit where their pins are pinned to small bodies on prismatic joints, which get one "
    "plate with grooves"
)


def refusal(layout: Layout, fixed: Mapping[str, int], purse: Purse | None = None) -> str:
    """A sentence or two, of meetings that together leave no order: without any one of them there would be one."""
    items, kept = layout.items, _kept(layout, fixed, purse)
    bodies = _bodies(layout, kept)
    pins = [rule for rule in kept if any(items[k].source is not None for k in rule)] or kept
    crossed = any(all(items[k].what.startswith(SLOTTED) for k in rule) for rule in pins)
    wish = "make pins thinner still (automatic(m, pin=...))" if layout.sizes.ratio == 1.0 else "make the model larger"
    meetings = [_meeting(layout, rule) for rule in _first_of_each(layout, pins)[:REPORTED]]
    return (
        f"{layout.m.name}: no order of layers lets {_listed(bodies)} pass each other with pins of "
        f"{layout.sizes.finished_pin:g} mm, on the base or on bridges, with one of them built up of "
        f"two webs: {'; '.join(meetings)}. Make links shorter or move joints "
        f"apart so that one stays clear of the other, {wish}, or shape them by hand in parts.py"
        f"{CROSSED if crossed else ''}"
    )


def undecided(layout: Layout) -> str:
    """A sentence for a search that was given up."""
    return (
        f"{layout.m.name}: the search for an order of layers of {len(layout.layered)} bodies and "
        f"{len(layout.conflicts)} places where something meets was given up after {ALL} conflicts, with none "
        "found: there may be one. Give some bodies their layer in parts.py (made.layer), move joints apart, make pins "
        "thinner (automatic(m, pin=...)), or give bodies places z along the normal"
    )


def in_the_way(layout: Layout, fixed: Mapping[str, int], purse: Purse | None = None) -> list[str]:
    """Bodies that leave no order of layers. Raises ValueError where there is one."""
    return _bodies(layout, _kept(layout, fixed, purse))


def _kept(layout: Layout, fixed: Mapping[str, int], purse: Purse | None = None) -> list[tuple[int, int]]:
    keys = [_pair(layout, rule) for rule in layout.conflicts]
    pairs = set(blocking(layout.problem(fixed, may_hang(layout)), keys, purse))
    return [rule for rule in layout.conflicts if _pair(layout, rule) in pairs]


def _bodies(layout: Layout, kept: Sequence[tuple[int, int]]) -> list[str]:
    bodies = {body for rule in kept for k in rule for body in layout.items[k].reach.bodies}
    return sorted(bodies, key=layout.layered.index)


def _pair(layout: Layout, rule: tuple[int, int]) -> frozenset[str]:
    return frozenset(layout.items[k].what for k in rule)


def _first_of_each(layout: Layout, rules: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    firsts: dict[frozenset[str], tuple[int, int]] = {}
    for rule in rules:
        firsts.setdefault(_pair(layout, rule), rule)
    return list(firsts.values())


def _meeting(layout: Layout, rule: tuple[int, int]) -> str:
    first, second = (layout.items[k] for k in rule)
    gap, time = layout.gap(first, second)
    near = "meets" if gap < 0 else f"comes within {gap * layout.sizes.finished:.2g} mm of"
    return f"{second.what} {near} {first.what} at t={time:.3g} s"


def _listed(names: Sequence[str]) -> str:
    return f"the pieces of {names[0]}" if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
