"""What is decided before anything is built: the size of the pins, the layers, springs, and bridges over pivots.

Pins as thick as the links allow come first. Where these leave no order of layers, thinner ones are tried, down to half
of that; then pivots hang from bridges; then springs are left out, and that is told.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.layers import find_layers
from mechanisms.stages.automatic.layout.layout import Springs
from mechanisms.stages.automatic.pins.bridges import bridges_over, may_hang
from mechanisms.stages.automatic.refusal import refusal
from shared.stage.console import warn
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.sizes import Sizes

type LayoutOf = Callable[[Sizes, Springs, bool], Layout]
"""The layout with pins of a size, with springs, and with tall styluses or flush ones."""
type Found = tuple[Layout, dict[str, int]]


def decided(layout_of: LayoutOf, wishes: Sequence[Sizes], fixed: Mapping[str, int]) -> Found:
    """The layout, and the layers and choices. ``wishes`` are sizes, the most wanted first; ``fixed`` are layers that
    are asked for. Raises UserError that names what cannot pass each other if there is no order with any of them.
    """
    tried = _Tried(layout_of, fixed)
    for bridges, sizes, above in product((False, True), wishes, (True, False)):
        found = tried.found(sizes, Springs(above), bridges)
        if found is not None:
            return tried.with_styluses(found) if not bridges else found
    last = tried.layout(wishes[-1], Springs(False))
    if last.springs.found:
        for bridges in (False, True):
            found = tried.with_some_springs(wishes[0], last.springs.found, bridges)
            if found is not None:
                return found
    raise UserError(refusal(last, fixed))


@dataclass(frozen=True)
class _Tried:
    layout_of: LayoutOf
    fixed: Mapping[str, int]

    def layout(self, sizes: Sizes, springs: Springs) -> Layout:
        """With flush styluses."""
        return self.layout_of(sizes, springs, False)

    def found(self, sizes: Sizes, springs: Springs, bridges: bool) -> Found | None:
        """None where there is no order of layers."""
        layout = self.layout(sizes, springs)
        if not springs.above and not springs.left_out and not layout.springs.found:
            return None  # without springs it was tried before
        levels = find_layers(layout.problem(self.fixed, may_hang(layout) if bridges else frozenset()))
        if levels is None:
            return None
        layout.features += bridges_over(layout, levels)
        return layout, levels

    def with_some_springs(self, sizes: Sizes, names: Sequence[str], bridges: bool) -> Found | None:
        """Those springs, one after the other, that leave an order of layers; of the others it is told."""
        left_out = frozenset(names)
        best = self.found(sizes, Springs(False, left_out), bridges)
        if best is None:
            return None
        for name in names:
            more = self.found(sizes, Springs(False, left_out - {name}), bridges)
            if more is not None:
                best, left_out = more, left_out - {name}
        warn(
            "parts",
            f"{best[0].m.name}: no order of layers leaves room for {', '.join(sorted(left_out))} beside the others; "
            "no studs or stops are made there, and the film draws springs over all parts",
        )
        return best if bridges else self.with_styluses(best)

    def with_styluses(self, low: Found) -> Found:
        """Styluses as tall as layers allow without a layer more."""
        layout, least = low
        if not layout.m.traces:
            return low
        high = self.layout_of(layout.sizes, layout.springs, True)
        levels = find_layers(high.problem(self.fixed))
        if levels is None or max(levels[b] for b in high.layered) > max(least[b] for b in layout.layered):
            return low
        return high, levels
