"""The tables of docs/engines.md: layouts without a bank angle; the best bank angle of each family, and why."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.machines.engines.bank_angles import BankAngles
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.free_forces import free_forces
from mbsd.machines.engines.layout import Layout
from mbsd.machines.engines.named import named

MARKERS = {
    "layouts": ("<!-- layouts: written by make study-engines -->", "<!-- end of layouts -->"),
    "angles": ("<!-- bank angles: written by make study-engines -->", "<!-- end of bank angles -->"),
}
FIXED = ("I1", "I2", "I3", "I4", "I5", "I6", "flat-2", "flat-4", "flat-6", "radial-5")


def with_tables(page: str, maps: Sequence[BankAngles]) -> str:
    """The page with its tables as they should be. Raises ValueError where their markers are missing."""
    for part, text in (("layouts", layouts()), ("angles", bank_angles(maps))):
        begin, end = MARKERS[part]
        before, mark, rest = page.partition(begin)
        if not mark or end not in rest:
            raise ValueError(f"the page has no '{begin}' ... '{end}'")
        page = f"{before}{begin}\n{text}\n{end}{rest.partition(end)[2]}"
    return page


def layouts() -> str:
    """Forces and couples by order of the layouts that have no bank angle to choose."""
    lines = [
        "| layout | throws | force, order 1 | order 2 | couple, order 1 | order 2 | fires |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in FIXED:
        of = named(name)
        free = free_forces(of)
        sizes = [size(free.force.largest[k], free.force.smallest[k]) for k in (0, 1)]
        sizes += [size(free.couple.largest[k], free.couple.smallest[k]) for k in (0, 1)]
        lines.append(f"| {name} | {_throws(of)} | {' | '.join(sizes)} | {_fires(of)} |")
    return "\n".join(lines)


def bank_angles(maps: Sequence[BankAngles]) -> str:
    """The best angle of each family, what is left there with counterweights, and why."""
    lines = [
        "| engine | best angle | force, order 1 | order 2 | couple, order 1 | order 2 | torque ripple | why |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for chart in maps:
        k = int(np.argmin(np.abs(chart.angle - chart.best)))
        left = chart.left(counterweights=True)
        sizes = [size(part[k, row]) for part in (left.force, left.couple) for row in (0, 1)]
        every = len(chart.angle) > 1 and chart.left(True).rank(0).max() < 1e-9 and chart.left(True).rank(1).max() < 1e-9
        best = f"any, such as {chart.best:g}" if every else f"{chart.best:g}"
        ripple = "" if chart.ripple is None else f"{chart.ripple[k]:.2g}"
        lines.append(f"| {chart.family.name} | {best} | {' | '.join(sizes)} | {ripple} | {' '.join(chart.reasons())} |")
    return "\n".join(lines)


def size(largest: float, smallest: float | None = None) -> str:
    """A number, 0 for rounding; with the smallest of the turn where that is another."""
    shown = "0" if largest < 1e-9 else f"{largest:.4g}"
    if smallest is None or abs(largest - smallest) < 1e-9 * max(largest, 1e-9) or largest < 1e-9:
        return shown
    return f"{shown} / {'0' if smallest < 1e-9 else f'{smallest:.4g}'}"


def _throws(of: Layout) -> str:
    return "-".join(f"{angle:g}" for angle in np.round(np.degrees(of.throws), 6) % 360)


def _fires(of: Layout) -> str:
    fired = firing(of)
    intervals = np.degrees(fired.intervals)
    order = "-".join(map(str, fired.order))
    if fired.even:
        return f"{order}, every {intervals[0]:g}°" if len(intervals) > 1 else "every 720°"
    return f"{order}, after {', '.join(f'{interval:g}' for interval in np.round(intervals, 6))}°"
