"""The page on which the spectra of several motions of one mechanism stand beside each other, a colour each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from render.plots.pages.beside import PANELS, legend
from render.plots.pages.spectra import NOTHING, shown_orders
from render.plots.quantities import known_names, quantity
from render.plots.spectrum import spectrum
from render.plots.style import colour, house_style, page
from shared.contract import Motion
from shared.contract.quantity import labelled

Series = tuple[np.ndarray, np.ndarray]
"""Orders and amplitudes."""


def spectra_figure(name: str, motions: Mapping[str, Motion], asked: Sequence[str]) -> Figure | None:
    """A panel for each component of what is asked for; None where no motion has any, or none repeats."""
    panels = _panels(motions, asked)[:PANELS]
    if not panels:
        return None
    with house_style():
        figure = page(name, "amplitudes of the harmonics", f"{len(motions)} motions; orders of the crank or the period")
        columns = 1 if len(panels) == 1 else 2 if len(panels) in (2, 4) else 3
        grid = figure.subplots(math.ceil(len(panels) / columns), columns, squeeze=False)
        figure.subplots_adjust(left=0.075, right=0.975, top=0.79, bottom=0.085, wspace=0.24, hspace=0.34)
        for axes, (title, spectra_of_panel) in zip(grid.ravel(), panels, strict=False):
            axes.set_title(title, fontsize=10, loc="left")
            _stems(axes, spectra_of_panel, len(motions))
        for axes in grid.ravel()[len(panels) :]:
            axes.set_visible(False)
        for axes in list(grid.ravel()[: len(panels)])[-columns:]:
            axes.set_xlabel("order")
        legend(figure, list(motions))
    return figure


def _panels(motions: Mapping[str, Motion], asked: Sequence[str]) -> list[tuple[str, dict[int, Series]]]:
    """Title, and the orders and amplitudes of each motion by its number."""
    panels: dict[str, dict[int, Series]] = {}
    for what in asked:
        for number, motion in enumerate(motions.values()):
            if what not in known_names(motion):
                continue
            series = quantity(motion, what)
            spectra = spectrum(motion, series.rows)
            if not spectra.harmonic:
                continue
            last = shown_orders(spectra)
            for column, component in enumerate(series.components):
                part = f" {component}" if component in ("x", "y") else ""
                panel = panels.setdefault(labelled(f"{what}{part}", series.unit), {})
                panel[number] = spectra.at[1 : last + 1], spectra.amplitudes[1 : last + 1, column]
    return [(title, spectra) for title, spectra in panels.items() if any(sizes.any() for _, sizes in spectra.values())]


def _stems(axes: Axes, spectra: dict[int, Series], count: int) -> None:
    """Those of all motions side by side at each order."""
    largest = max(float(sizes.max()) for _, sizes in spectra.values())
    end = max(float(at[-1]) for at, _ in spectra.values())
    for number, (at, sizes) in spectra.items():
        there = sizes > NOTHING * largest
        places = at + (number - (count - 1) / 2) * float(at[0]) * min(0.15, 0.7 / count)
        axes.vlines(places[there], 0.0, sizes[there], color=colour(number), linewidth=2.6)
        axes.plot(places[there], sizes[there], "o", color=colour(number), markersize=4.5)
    axes.set_xlim(0.4, end + 0.6)
    axes.set_ylim(0.0, 1.08 * largest)
    axes.locator_params(axis="x", integer=True, nbins=12)
    axes.locator_params(axis="y", nbins=5)
    axes.grid(visible=False, axis="x")
