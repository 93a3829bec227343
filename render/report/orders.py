"""Orders of the report: harmonics of the crank in what shakes the frame and turns the shaft."""

from __future__ import annotations

import numpy as np

from render.magnitudes import floor_of, force_floor
from render.report.written import Amounts, table, written
from shared.contract import Motion
from shared.contract.motion import Harmonics

LEAST = 2e-3
"""Orders of less than this part of the largest are left out."""
MOST = 12
"""Rows of the table."""
VECTORS = ("shaking force", "shaking couple")


def orders_section(motion: Motion) -> list[str]:
    """Return a table with a row for each order that counts."""
    vibration = motion.vibration
    if vibration is None:
        return []
    shown: list[tuple[str, Harmonics, np.ndarray]] = []
    for name, harmonics in vibration.harmonics.items():
        if name not in (*VECTORS, "shaking moment", *motion.drivers):
            continue
        floor = floor_of(motion, name, harmonics.unit)
        size = np.array(harmonics.forward) + np.array(harmonics.backward)
        if size.max(initial=0.0) > floor:
            shown.append((name, harmonics, np.where(size > floor, size, 0.0)))
    if not shown:
        return []
    counts = np.max(np.array([size / size.max() for _, _, size in shown]), axis=0)
    kept = np.sort(np.argsort(counts, kind="stable")[::-1][:MOST])
    rows = [
        [
            f"{vibration.order[k]:g}",
            *(cell for name, harmonics, size in shown for cell in _cells(name, harmonics, size, int(k))),
        ]
        for k in kept
        if counts[k] > LEAST
    ]
    heads = [head for name, _, _ in shown for head in _heads(name)]
    cycle = "turn" if vibration.turns == 1 else f"cycle of {vibration.turns} turns"
    lines = [
        f"Largest size of each harmonic on the turn; an order counts periods in a turn of {vibration.crank}. With is "
        f"the part that turns with it, which a counterweight cancels where the order is 1; against is the part that "
        f"turns against it. All repeats after a {cycle}.",
        "",
    ]
    return [*lines, *table(["order", *heads], rows), "", _mean(motion)]


def _heads(name: str) -> list[str]:
    return [name, "with", "against"] if name in VECTORS else [name]


def _cells(name: str, harmonics: Harmonics, size: np.ndarray, k: int) -> list[str]:
    if size[k] == 0.0:
        return ["0"] * len(_heads(name))
    cells = [written(float(size[k]), harmonics.unit)]
    if name in VECTORS:
        tiny = 1e-9 * float(size.max())
        cells += [
            written(value, harmonics.unit) if value > tiny else "0"
            for value in (harmonics.forward[k], harmonics.backward[k])
        ]
    return cells


def _mean(motion: Motion) -> str:
    """Return the root mean squares, and how far the centre of mass goes."""
    vibration = motion.vibration
    assert vibration is not None
    force = float(np.sqrt(np.mean(np.square(vibration.fx) + np.square(vibration.fy))))
    amount = Amounts(motion)
    shown = 0.0 if force < force_floor(motion) else force
    return (
        f"The shaking force is {written(shown, 'N')} by root mean square; the centre of mass of all that moves goes "
        f"{amount(float(np.ptp(vibration.x)), 'm')} along x and {amount(float(np.ptp(vibration.y)), 'm')} along y."
    )
