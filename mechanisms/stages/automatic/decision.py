"""Decisions before anything is built: pins, layers, springs, bridges; or why there is no order."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice, product

from mechanisms.stages.automatic.layout.layers import ALL, Purse, Undecided, blocking, find_layers
from mechanisms.stages.automatic.layout.layout import Layout, Springs
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.pins.bridges import Bridge, bridges_over, may_hang
from mechanisms.stages.automatic.pins.free_bodies import RimMark
from mechanisms.stages.automatic.pins.pins import webbed
from mechanisms.stages.automatic.slides.curved_slots import CurvedSlot
from shared.stage.console import Shown, warn
from shared.stage.errors import UserError

# Why there is no order of layers: the fewest bodies that cannot pass each other, and what to do.


class NoOrder(UserError):
    """Error for bodies that cannot pass each other in layers."""

    def __init__(self, message: str, bodies: Sequence[str] = ()) -> None:
        super().__init__(message, bodies)
        self.bodies = tuple(bodies)

    def __str__(self) -> str:
        return str(self.args[0])


REPORTED = 4
"""So many meetings are reported."""
SLOTTED = "the slotted plate of "
CROSSED = (
    "; slots on ground that cross fit where their pins are pinned to small bodies on prismatic joints, which get one "
    "plate with grooves"
)


def refusal(layout: Layout, fixed: Mapping[str, int], purse: Purse | None = None) -> NoOrder:
    """Return an error with a sentence or two on meetings that together leave no order.

    Without any one of them there would be one.
    """
    items, kept = layout.items, _kept(layout, fixed, purse)
    bodies = _bodies(layout, kept)
    pins = [rule for rule in kept if any(items[k].source is not None for k in rule)] or kept
    crossed = any(all(items[k].what.startswith(SLOTTED) for k in rule) for rule in pins)
    wish = "make pins thinner still (automatic(m, pin=...))" if layout.sizes.ratio == 1.0 else "make the model larger"
    meetings = [_meeting(layout, rule) for rule in _first_of_each(layout, pins)[:REPORTED]]
    return NoOrder(
        f"{layout.m.name}: no order of layers lets {_listed(bodies)} pass each other with pins of "
        f"{layout.sizes.finished_pin:g} mm, on the base or on bridges, with one of them built up of "
        f"two webs: {'; '.join(meetings)}. Make links shorter or move joints "
        f"apart so that one stays clear of the other, {wish}, or shape them by hand in parts.py"
        f"{CROSSED if crossed else ''}",
        bodies,
    )


def undecided(layout: Layout) -> NoOrder:
    """Return the error of a search that was given up; it knows no bodies."""
    return NoOrder(
        f"{layout.m.name}: the search for an order of layers of {len(layout.layered)} bodies and "
        f"{len(layout.conflicts)} places where something meets was given up after {ALL} conflicts, with none "
        "found: there may be one. Give some bodies their layer in parts.py (made.layer), move joints apart, make pins "
        "thinner (automatic(m, pin=...)), or give bodies places z along the normal"
    )


def in_the_way(layout: Layout, fixed: Mapping[str, int], purse: Purse | None = None) -> list[str]:
    """Return bodies that leave no order of layers. Raises ValueError where there is one."""
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


# Decisions before anything is built: the size of the pins, the layers, springs, and bridges over pivots.
#
# Pins as thick as the links allow come first. Where these leave no order of layers, thinner ones are tried, down to
# half of that; then pivots are sunk into their links where something passes close above; then pivots hang from bridges;
# then wheels whose mates an arm would meet stand on tubes; then plates of curved slots reach out to posts farther away;
# then a body is built up of two webs; then springs are left out, and that is reported.

DEVICES = ((False, False), (True, False), (True, True))
"""True if pivots may be flush with their links, and if they may hang from bridges."""
MOST_WEBS = 60
"""So many ways to build a body of two webs are tried."""


type LayoutOf = Callable[..., Layout]
"""Makes the layout with pins of a size, with springs, and with tubes beside arms.

``tall``: with styluses that stand up, not flush ones; ``pointers``: with those of points on rims.
"""
type Outcome = tuple[Layout, dict[str, int]]


def decided(layout_of: LayoutOf, wishes: Sequence[Sizes], fixed: Mapping[str, int]) -> Outcome:
    """Return the layout, and the layers and choices. ``wishes`` are sizes, the most wanted first.

    ``fixed`` are layers that are asked for. Raises UserError that names what cannot pass each other if there is no
    order with any of them.
    """
    tried = _Tried(layout_of, fixed)
    try:
        return _decided(tried, wishes)
    except Undecided:
        raise undecided(tried.layout(wishes[0], Springs())) from None


def _decided(tried: _Tried, wishes: Sequence[Sizes]) -> Outcome:
    outcome = tried.with_devices(wishes)
    if outcome is None and any(tried.layout(sizes, Springs(), True).tubes for sizes in wishes):
        outcome = tried.with_devices(wishes, True)
    outcome = outcome or tried.with_far_posts(wishes) or tried.with_webs(wishes)
    if outcome is not None:
        return outcome
    last = tried.layout(wishes[-1], Springs(False)).with_flush_pivots()
    if last.springs.names:
        for bridges in (False, True):
            outcome = tried.with_some_springs(wishes[0], last.springs.names, bridges)
            if outcome is not None:
                return outcome
    raise refusal(last, tried.fixed, tried.purse)


@dataclass(frozen=True)
class _Tried:
    layout_of: LayoutOf
    fixed: Mapping[str, int]
    known: dict[tuple[float, Springs, bool], Layout] = field(default_factory=dict)
    purse: Purse = field(default_factory=Purse)
    shown: list[Shown] = field(default_factory=list)

    def layout(self, sizes: Sizes, springs: Springs, tubes: bool = False) -> Layout:
        """Return the layout with flush styluses."""
        key = sizes.scale, springs, tubes
        if key not in self.known:
            self.known[key] = self.layout_of(sizes, springs, tubes)
        return self.known[key]

    def with_devices(self, wishes: Sequence[Sizes], tubes: bool = False) -> Outcome | None:
        """Return the outcome with the fewest devices, and then the thickest pins, that leave an order."""
        for (flush, bridges), sizes, above in product(DEVICES, wishes, (True, False)):
            outcome = self.attempt(sizes, Springs(above), flush, bridges, tubes)
            if outcome is not None:
                return self.with_styluses(outcome) if not bridges else outcome
        return None

    def attempt(
        self, sizes: Sizes, springs: Springs, flush: bool, bridges: bool, tubes: bool = False
    ) -> Outcome | None:
        """Return None where there is no order of layers."""
        layout = self.layout(sizes, springs, tubes)
        if not springs.above and not springs.left_out and not layout.springs.names:
            return None  # without springs it was tried before
        return self.ordered(layout.with_flush_pivots() if flush else layout, bridges)

    def ordered(self, layout: Layout, bridges: bool) -> Outcome | None:
        """Return a layout with its layers, and with the bridges that these need."""
        self._show(layout)
        levels = find_layers(layout.problem(self.fixed, may_hang(layout) if bridges else frozenset()), self.purse)
        if levels is None:
            return None
        layout.features += bridges_over(layout, levels)
        return layout, levels

    def _show(self, layout: Layout) -> None:
        """Say now and then what is tried."""
        if not self.shown:
            self.shown.append(Shown("parts", layout.m.name, 0, "orders of layers looked for"))
        self.shown[0].advance(f"{len(layout.layered)} bodies, pins of {layout.sizes.finished_pin:g} mm")

    def with_far_posts(self, wishes: Sequence[Sizes]) -> Outcome | None:
        """Return where there are curved slots on ground, with the thickest pins that leave an order."""
        for bridges, sizes in product((False, True), wishes):
            layout = self.layout(sizes, Springs())
            if not any(isinstance(feature, CurvedSlot) and feature.slot == "ground" for feature in layout.features):
                return None
            outcome = self.ordered(layout.with_far_posts(), bridges)
            if outcome is not None:
                return outcome
        return None

    def with_webs(self, wishes: Sequence[Sizes]) -> Outcome | None:
        """Return the outcome with one body of two webs: the fewest bridges, then the fewest layers.

        The thickest pins are tried, then the thinnest.

        One of the bodies that leave no order must be the one; none is tried where there are too many ways.
        """
        for sizes in dict.fromkeys((wishes[0], wishes[-1])):
            layout = self.layout(sizes, Springs()).with_flush_pivots()
            bodies = in_the_way(layout, self.fixed, self.purse)
            ways = list(islice(webbed(layout, bodies), MOST_WEBS + 1))
            if len(ways) > MOST_WEBS:
                return None
            outcomes = [outcome for outcome in (self.ordered(way, True) for way in ways) if outcome is not None]
            if outcomes:
                return min(outcomes, key=_cost)
        return None

    def with_some_springs(self, sizes: Sizes, names: Sequence[str], bridges: bool) -> Outcome | None:
        """Keep springs one by one while an order of layers is left; report the others."""
        left_out = frozenset(names)
        best = self.attempt(sizes, Springs(False, left_out), True, bridges)
        if best is None:
            return None
        for name in names:
            more = self.attempt(sizes, Springs(False, left_out - {name}), True, bridges)
            if more is not None:
                best, left_out = more, left_out - {name}
        warn(
            "parts",
            f"{best[0].m.name}: no order of layers leaves room for {', '.join(sorted(left_out))} beside the others; "
            "no studs or stops are made there, and the film draws springs over all parts",
        )
        return best if bridges else self.with_styluses(best)

    def with_styluses(self, low: Outcome) -> Outcome:
        """Return styluses as tall as layers allow without a layer more.

        Else pointers alone, if there is room for them.
        """
        layout, least = low
        if not layout.m.traces:
            return low
        for tall in (True, False):
            high = self.layout_of(layout.sizes, layout.springs, layout.tubes, tall, pointers=True)
            if not tall and not any(isinstance(feature, RimMark) for feature in high.features):
                break
            high = high.with_flush_pivots() if layout.flush else high
            levels = find_layers(high.problem(self.fixed), self.purse)
            if levels is not None and max(levels[b] for b in high.layered) <= max(least[b] for b in layout.layered):
                return high, levels
        return low


def _cost(outcome: Outcome) -> tuple[int, int]:
    layout, levels = outcome
    return sum(isinstance(feature, Bridge) for feature in layout.features), max(levels[body] for body in layout.layered)
