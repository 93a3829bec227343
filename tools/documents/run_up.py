"""Engines on mounts run through resonance, simulated beside linear theory (``make study-run-up``).

Writes out/engines/run_up.csv, out/engines/run_up.svg and the table of docs/engines.md; results are kept in
out/engines/studies/.

Mass, inertia and mounts are those of the mount study of docs/engines.md. The cylinders compress and do not burn, as on
a test bench that drives the engine; the bench stands on ground, so that the torque of gas and inertia rocks the block.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from mbsd import Mechanism, four_stroke, study
from mbsd.machines.engines.block import Block, mount_response, mounts_of_frequency
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.run_up import run_up
from shared.stage.console import markdown_table
from shared.stage.files import write_bytes
from shared.stage.paths import out_root
from tools.documents.figures.look import BLUE, GREEN, MOVED, PURPLE, QUIET, STYLE, plain
from tools.documents.pages import DOCS, replaced

PLACES = ((-0.30, -0.10), (0.30, -0.10), (0.0, 0.20))
MASS, INERTIA = 150.0, 4.0
SIZE: dict[str, Any] = {"bore": 0.08, "stroke": 0.08, "rod": 0.14, "piston_mass": 0.5, "rod_mass": 0.6}
TORQUE_ORDER = {"I2": 1.0, "I3": 1.5, "I4": 2.0, "V8": 4.0}
"""The layouts, and the lowest order of each one's torque: half of its cylinders."""
GRID = {
    "layout": list(TORQUE_ORDER),
    "frequency": [8.0, 25.0],
    "damping_ratio": [0.05, 0.1, 0.2],
    "rate": [100.0, 200.0, 500.0, 1000.0, 2000.0],
}
"""Natural frequency of the mass on its mounts (Hz), damping ratio, and how fast the speed rises (rpm/s)."""
BEYOND = 1.6
"""The run ends at so many times the speed at which the lowest order of the torque meets the rocking mode."""
ROWS = 144
"""Rows of the last turn, which every other turn has more of."""
RPM = 30 / math.pi
"""Times rad/s."""
SPEEDS = np.linspace(0.02, 1.0, 491)
"""Parts of the last speed at which the steady response is computed."""
COLOURS = (MOVED, BLUE, GREEN, PURPLE)
BEGIN, END = "<!-- run-up: written by make study-run-up -->", "<!-- end of run-up -->"
DAMPING_RATIO = 0.1
"""Damping ratio of the runs in the table."""
RATES = (100.0, 2000.0)
"""Rates of the runs in the table (rpm/s)."""


def main(words: Sequence[str]) -> None:
    """Compute the study and write its table and picture."""
    begun = time.monotonic()
    out, page = out_root() / "engines", DOCS / "engines.md"
    out.mkdir(parents=True, exist_ok=True)
    runs = study(build, GRID, measure, folder=out / "studies", save=out / "run_up.csv")
    failed = list(runs["reason"].dropna())
    if failed:
        raise SystemExit(f"run-up: {len(failed)} runs failed, the first for: {failed[0]}")
    with mpl.rc_context(STYLE):  # pyright: ignore[reportArgumentType]
        picture(runs).savefig(out / "run_up.svg", metadata={"Date": None, "Creator": None})
    write_bytes(page, replaced(page.read_text(), BEGIN, END, table(runs)).encode())
    print(f"run-up: {len(runs)} runs in {time.monotonic() - begun:.1f} s")
    print(f"run-up: {out / 'run_up.csv'}, {out / 'run_up.svg'} and the table of docs/engines.md written")


def build(layout: str, frequency: float, damping_ratio: float, rate: float) -> Mechanism:
    """Return the engine whose speed rises by ``rate`` (rpm/s) from rest.

    It has no weight, which only shifts its rest.
    """
    mounts = mounts_of_frequency(MASS, frequency, PLACES, damping_ratio)
    block = Block(MASS, INERTIA, mounts, motor_on="ground")
    m = engine(layout, **SIZE, gas=four_stroke(10.0), block=block, acceleration=rate / RPM, name=layout)
    m.gravity = None
    return m


def measure(m: Mechanism) -> dict[str, float]:
    """Return the largest displacement (mm) of the shaft and angle (mrad) of the block, with their speeds.

    ``steady``: the same at constant speed by linear theory. ``expected``: what of it a single mode run through at this
    rate reaches in closed form. Speeds in rpm.
    """
    law = m.drivers["motor"].motion
    assert law is not None  # of a driver
    rate = float(law(np.zeros(1))[0, 2])
    last = last_speed(m)
    duration = last / rate
    sol = m.simulate(duration, steps=math.ceil(ROWS * last * duration / (2 * math.pi)))
    block, speed = sol.body("block"), sol.body("crank").omega
    steady = mount_response(m, SPEEDS * last)
    moved, turned = steady.largest_displacement(), steady.largest_angle()
    out = {}
    for name, unit, now, always, of, excitation in (
        ("displacement", 1e3, np.hypot(block.x, block.y), moved, slice(0, 2), "inertia"),
        ("angle", 1e3, np.abs(block.theta), turned, slice(2, 3), "constant"),
    ):
        row, peak = int(now.argmax()), int(always.argmax())
        alone = np.linalg.norm(steady.displacement[peak, :, of], axis=1)
        order = float(steady.order[alone.argmax()])
        at = order * float(steady.speed[peak])
        mode = min(steady.modes, key=lambda mode: abs(mode.omega - at))
        passed = run_up(mode.frequency, mode.damping_ratio, rate, order, excitation)
        out |= {
            name: unit * float(now[row]),
            f"speed of {name}": RPM * float(speed[row]),
            f"steady {name}": unit * float(always[peak]),
            f"speed of steady {name}": RPM * float(steady.speed[peak]),
            f"order of {name}": order,
            f"expected {name}": unit * float(always[peak]) * passed.reached,
            f"speed of expected {name}": RPM * passed.peak_speed,
        }
    return out


def last_speed(m: Mechanism) -> float:
    """Return the speed at which a run ends (rad/s)."""
    return BEYOND * mount_response(m, [1.0]).modes[-1].omega / TORQUE_ORDER[m.name]


def table(runs: Any) -> str:
    """Return the largest displacement and angle with their speeds, of runs with one damping ratio.

    ``runs`` is a table of pandas.
    """
    rates = [f"{rate:g} rpm/s" for rate in RATES]
    lines = []
    shown = runs[runs["damping_ratio"] == DAMPING_RATIO]
    for (layout, frequency), rows in shown.groupby(["layout", "frequency"], sort=False):
        cells = [str(layout), f"{frequency:g} Hz"]
        at = rows.set_index("rate")
        for name, unit in (("displacement", "mm"), ("angle", "mrad")):
            cells.append(_cell(at.loc[RATES[0]], f"steady {name}", unit))
            cells += [_cell(at.loc[rate], name, unit) for rate in RATES]
        lines.append(cells)
    head = ("engine", "mounts", "displacement, steady", *rates, "angle, steady", *rates)
    return "\n".join(markdown_table(head, lines))


def _cell(row: Any, name: str, unit: str) -> str:
    return f"{row[name]:.3g} {unit} at {row[f'speed of {name}']:.0f}"


def picture(runs: Any) -> Figure:
    """Draw displacement and angle over the rate, as parts of the steady ones, beside the closed form."""
    with mpl.rc_context(STYLE):  # pyright: ignore[reportArgumentType]
        layouts = list(dict.fromkeys(runs["layout"]))
        figure = Figure(figsize=(2.6 * len(layouts), 7.6), layout="constrained")
        frequencies = list(dict.fromkeys(runs["frequency"]))
        axes = figure.subplots(2 * len(frequencies), len(layouts), sharex=True, sharey="row", squeeze=False)
        for column, layout in enumerate(layouts):
            for row, (name, frequency) in enumerate(
                (name, frequency) for name in ("displacement", "angle") for frequency in frequencies
            ):
                ax = axes[row, column]
                shown = runs[(runs["layout"] == layout) & (runs["frequency"] == frequency)]
                _panel(ax, shown, name)
                ax.set_title(f"{layout}, {frequency:g} Hz" if row < len(frequencies) else "")
                if column == 0:
                    ax.set_ylabel(f"{name} / steady")
        for ax in axes[-1]:
            ax.set_xlabel("rpm/s")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        return figure


def _panel(ax: Any, runs: Any, name: str) -> None:
    for colour, (damping_ratio, rows) in zip(COLOURS, runs.groupby("damping_ratio"), strict=False):
        steady = rows[f"steady {name}"]
        ax.plot(rows["rate"], rows[name] / steady, "o", color=colour, label=f"damping ratio {damping_ratio:g}")
        ax.plot(rows["rate"], rows[f"expected {name}"] / steady, "-", color=colour)
    ax.plot([], [], "-", color=QUIET, label="one mode, closed form")
    ax.axhline(1.0, color=QUIET, linewidth=0.9, linestyle=(0, (3, 3)))
    plain(ax, xscale="log", ylim=(0, 1.25))
