"""``make study-engines``: every family of V engines over its bank angles, a degree apart, with the torque of its gas.

Writes out/engines/bank_angles.csv, out/engines/engines.md and the tables of docs/engines.md.
"""

from __future__ import annotations

import csv
import io
import os
import time
from pathlib import Path

from mbsd import four_stroke
from mbsd.base.files import write_whole
from mbsd.machines.engines.bank_angles import ORDERS, BankAngles, all_families
from tools.engine_layouts.tables import bank_angles, layouts, with_tables

ROOT = Path(__file__).resolve().parents[2]
RATIO = 0.28
"""Crank radius over rod."""
CYCLE = four_stroke(10.0, heat_density=2e6)


def main() -> None:
    """Compute and write."""
    begun = time.monotonic()
    maps = all_families(RATIO, CYCLE, lambda name: print(f"engines: {name}", flush=True))
    out = Path(os.environ.get("MBSD_OUT") or ROOT / "out") / "engines"
    out.mkdir(parents=True, exist_ok=True)
    write_whole(out / "bank_angles.csv", rows(maps).encode())
    write_whole(out / "engines.md", f"{layouts()}\n\n{bank_angles(maps)}\n".encode())
    page = ROOT / "docs" / "engines.md"
    write_whole(page, with_tables(page.read_text(), maps).encode())
    print(f"engines: {len(maps)} families of {len(maps[0].angle)} angles in {time.monotonic() - begun:.1f} s")
    print(f"engines: {out / 'bank_angles.csv'}, {out / 'engines.md'} and the tables of docs/engines.md written")


def rows(maps: list[BankAngles]) -> str:
    """All numbers: largest forces (m r w^2) and couples (times the spacing), without and with counterweights."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    named = [
        f"{what} {order}{extra}"
        for extra in ("", ", counterweights")
        for what in ("force", "couple")
        for order in ORDERS
    ]
    table.writerow(["engine", "bank angle (deg)", *named, "uneven (deg)", "firing order", "torque ripple"])
    for chart in maps:
        plain, held = chart.left(), chart.left(counterweights=True)
        for k, angle in enumerate(chart.angle):
            sizes = [part[k] for left in (plain, held) for part in (left.force, left.couple)]
            numbers = [f"{value:.9g}" for part in sizes for value in part]
            ripple = "" if chart.ripple is None else f"{chart.ripple[k]:.6g}"
            table.writerow(
                [
                    chart.family.name,
                    f"{angle:g}",
                    *numbers,
                    f"{chart.uneven[k]:.6g}",
                    "-".join(map(str, chart.order[k])),
                    ripple,
                ]
            )
    return text.getvalue()


if __name__ == "__main__":
    main()
