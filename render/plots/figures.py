"""Every plot by name."""

from __future__ import annotations

from matplotlib.figure import Figure

from render.plots.pages.energy import energy
from render.plots.pages.forces import forces, frame, hodographs, reactions
from render.plots.pages.motion import bodies, path, point, slider, turns
from render.plots.pages.pressures import gas, hydraulics
from render.plots.pages.space import figure_in_space
from render.plots.pages.spectra import spectrum_page
from render.plots.quantities import known_names
from render.plots.style import house_style
from shared.contract import AnyMotion, Motion, Motion3
from shared.contract.skeleton import Skeleton


def spectrum_of(motion: Motion, name: str) -> Figure:
    """Return the spectrum of the quantity whose name has hyphens for spaces in ``name``."""
    return spectrum_page(motion, next(known for known in known_names(motion) if known.replace(" ", "-") == name))


WHOLE = {
    "bodies": bodies,
    "reactions": reactions,
    "hodographs": hodographs,
    "forces": forces,
    "frame": frame,
    "gas": gas,
    "hydraulics": hydraulics,
    "energy": energy,
    "turns": turns,
}
ONE = {"point-": point, "slider-": slider, "spectrum-": spectrum_of}


def figure(plot: str, motion: AnyMotion, skeleton: Skeleton) -> Figure:
    """Draw a plot: a name of :data:`WHOLE`, ``point-<P>``, ``slider-<body>``, ``spectrum-<what>``, one of space.py."""
    with house_style():
        if isinstance(motion, Motion3):
            return figure_in_space(plot, motion, skeleton)
        if plot == "path":
            return path(motion, skeleton)
        if plot in WHOLE:
            return WHOLE[plot](motion)
        prefix = next(prefix for prefix in ONE if plot.startswith(prefix))
        return ONE[prefix](motion, plot.removeprefix(prefix))
