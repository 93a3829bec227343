"""Energy over ten thousand periods by each integrator, and what a pin is open by with Baumgarte's stabilisation."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GOLD, GREEN, INK, MOVED, PURPLE, QUIET, plain

MEASURED = Path(__file__).resolve().parents[4] / "docs" / "integrators.json"
CLOSED = 1e-15
"""Less is rounding (m)."""
COLOURS = {
    "dop853": BLUE,
    "dop853, tight": BLUE,
    "radau": PURPLE,
    "rk4": GOLD,
    "symplectic": GREEN,
    "rattle": MOVED,
    "generalized_alpha": INK,
    "baumgarte": QUIET,
}


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    runs = json.loads(MEASURED.read_text())["long"]
    energy = Figure(figsize=(9.6, 4.8), layout="constrained")
    left, right = energy.subplots(1, 2, sharey=True)
    for ax, (name, methods) in zip((left, right), runs.items(), strict=True):
        for method, run in methods.items():
            style = (0, (4, 2)) if "tight" in method else "-"
            ax.loglog(run["periods"], run["errors"], color=COLOURS[method], linestyle=style, label=method)
        plain(ax, xlabel="periods", xlim=(1, 1e4), ylim=(1e-12, 2))
        ax.set_title(f"{name}: largest energy error so far")
    left.set_ylabel("parts of the largest kinetic energy")
    energy.legend(
        *left.get_legend_handles_labels(), loc="outside lower center", ncols=8, columnspacing=1.0, handlelength=1.6
    )
    return {"integrators.svg": energy, "integrators_baumgarte.svg": _openings(page)}


def _openings(page: SimpleNamespace) -> Figure:
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    ax = figure.subplots()
    for (name, gap), colour in zip(page.gap.items(), (MOVED, BLUE, GREEN), strict=True):
        gap = np.maximum(gap, CLOSED)
        ax.semilogy(page.times, gap, color=colour, linewidth=1.2)
        place = np.exp(np.mean(np.log(gap[-100:])))
        name = f"{name}:\nbelow {CLOSED:.0e} m" if np.isclose(place, CLOSED, atol=0.0) else name
        ax.annotate(name, (page.times[-1], place), (6, 0), textcoords="offset points", color=colour, va="center")
    plain(ax, xlabel="time, s", ylabel="pin C is open by, m", xlim=(0, 60), ylim=(1e-16, 1))
    ax.set_title("four-bar, RK4 with a step of 10 ms: let drift, stabilised, projected")
    return figure
