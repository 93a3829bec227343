"""Why there is no order of layers: the fewest bodies that cannot pass each other, and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mechanisms.automatic.layers import find_layers

if TYPE_CHECKING:
    from mechanisms.automatic.layout import Layout

TRIES = 4_000
"""Choices that are tried to see whether one pair of bodies more can be left out."""
TOLD = 4
"""So many meetings are told."""


def refusal(layout: Layout) -> str:
    """A sentence or two. Pairs of bodies are left out one after the other as long as there is still no order."""
    items, moving = layout.items, layout.layered
    kept = list(layout.conflicts)
    pairs = list(dict.fromkeys(_pair(layout, rule) for rule in kept))
    for pair in pairs:
        fewer = [rule for rule in kept if _pair(layout, rule) != pair]
        if find_layers(moving, items, fewer, tries=TRIES, together=layout.together) is None:
            kept = fewer
    bodies = sorted({body for rule in kept for k in rule for body in items[k].reach.bodies}, key=moving.index)
    pins = [rule for rule in kept if any(items[k].source is not None for k in rule)] or kept
    meetings = [_meeting(layout, rule) for rule in _first_of_each(layout, pins)[:TOLD]]
    return (
        f"{layout.m.name}: no order of layers lets {_listed(bodies)} pass each other: {'; '.join(meetings)}. "
        "Make links shorter or move joints apart so that one stays clear of the other, make pins thinner "
        "(automatic(m, pin=...)), or shape them by hand in parts.py"
    )


def _pair(layout: Layout, rule: tuple[int, int]) -> frozenset[str]:
    return frozenset(layout.items[k].what for k in rule)


def _first_of_each(layout: Layout, rules: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    found: dict[frozenset[str], tuple[int, int]] = {}
    for rule in rules:
        found.setdefault(_pair(layout, rule), rule)
    return list(found.values())


def _meeting(layout: Layout, rule: tuple[int, int]) -> str:
    first, second = (layout.items[k] for k in rule)
    gap, time = layout.gap(first, second)
    near = "meets" if gap < 0 else f"comes within {gap * layout.sizes.scale:.2g} mm of"
    return f"{second.what} {near} {first.what} at t={time:.3g} s"


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
