"""Bank angles of V engines: a map of every family, a degree apart (``make study-engines``).

The torque of the gas is of a four-stroke cycle.

Writes out/engines/bank_angles.csv, out/engines/engines.md and the tables of docs/engines.md.
"""

from __future__ import annotations

import csv
import io
import time
from collections.abc import Sequence

import numpy as np

from mbsd import four_stroke
from mbsd.machines.engines.bank_angles import ORDERS, BankAngles, all_families
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.free_forces import free_forces
from mbsd.machines.engines.layout import Layout, named
from shared.stage.console import markdown_table
from shared.stage.files import write_bytes
from shared.stage.paths import out_root
from tools.documents.pages import DOCS, replaced

RATIO = 0.28
"""Crank radius over rod."""
CYCLE = four_stroke(10.0, heat_density=2e6)
LAYOUTS = "<!-- layouts: written by make study-engines -->", "<!-- end of layouts -->"
ANGLES = "<!-- bank angles: written by make study-engines -->", "<!-- end of bank angles -->"
SIZES = ("force, order 1", "order 2", "couple, order 1", "order 2")
FIXED = ("I1", "I2", "I3", "I4", "I5", "I6", "flat-2", "flat-4", "flat-6", "radial-5")


def main(words: Sequence[str]) -> None:
    """Compute the maps of all families and write them."""
    begun = time.monotonic()
    maps = all_families(RATIO, CYCLE, lambda name: print(f"engines: {name}", flush=True))
    out, page = out_root() / "engines", DOCS / "engines.md"
    write_bytes(out / "bank_angles.csv", rows(maps).encode())
    write_bytes(out / "engines.md", f"{layout_table()}\n\n{angle_table(maps)}\n".encode())
    text = replaced(replaced(page.read_text(), *LAYOUTS, layout_table()), *ANGLES, angle_table(maps))
    write_bytes(page, text.encode())
    print(f"engines: {len(maps)} families of {len(maps[0].angle)} angles in {time.monotonic() - begun:.1f} s")
    print(f"engines: {out / 'bank_angles.csv'}, {out / 'engines.md'} and the tables of docs/engines.md written")


def rows(maps: list[BankAngles]) -> str:
    """Return CSV of largest forces and couples over the bank angle.

    Forces are in m r w^2, couples times the spacing, both without and with counterweights.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    extras = ("", ", counterweights")
    sizes = [f"{what} {order}{extra}" for extra in extras for what in ("force", "couple") for order in ORDERS]
    table.writerow(["engine", "bank angle (deg)", *sizes, "uneven (deg)", "firing order", "torque ripple"])
    for chart in maps:
        plain, held = chart.left(), chart.left(counterweights=True)
        for k, angle in enumerate(chart.angle):
            sizes = [part[k] for left in (plain, held) for part in (left.force, left.couple)]
            numbers = [f"{value:.9g}" for part in sizes for value in part]
            ripple = "" if chart.ripple is None else f"{chart.ripple[k]:.6g}"
            fires = f"{chart.uneven[k]:.6g}", "-".join(map(str, chart.order[k]))
            table.writerow([chart.family.name, f"{angle:g}", *numbers, *fires, ripple])
    return text.getvalue()


def layout_table() -> str:
    """Return forces and couples by order of the layouts that have no bank angle to choose."""
    rows = []
    for name in FIXED:
        of = named(name)
        free = free_forces(of)
        sizes = [size(free.force.largest[k], free.force.smallest[k]) for k in (0, 1)]
        sizes += [size(free.couple.largest[k], free.couple.smallest[k]) for k in (0, 1)]
        rows.append((name, _throws(of), *sizes, _fires(of)))
    return "\n".join(markdown_table(("layout", "throws", *SIZES, "fires"), rows))


def angle_table(maps: Sequence[BankAngles]) -> str:
    """Return the best angle of each family, what is left there with counterweights, and why."""
    rows = []
    for chart in maps:
        k = int(np.argmin(np.abs(chart.angle - chart.best)))
        left = chart.left(counterweights=True)
        sizes = [size(part[k, row]) for part in (left.force, left.couple) for row in (0, 1)]
        every = len(chart.angle) > 1 and chart.left(True).rank(0).max() < 1e-9 and chart.left(True).rank(1).max() < 1e-9
        best = f"any, such as {chart.best:g}" if every else f"{chart.best:g}"
        ripple = "" if chart.ripple is None else f"{chart.ripple[k]:.2g}"
        rows.append((chart.family.name, best, *sizes, ripple, " ".join(chart.reasons())))
    return "\n".join(markdown_table(("engine", "best angle", *SIZES, "torque ripple", "why"), rows))


def size(largest: float, smallest: float | None = None) -> str:
    """Return a number in words, 0 for rounding; with the smallest of the turn where that is another."""
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
