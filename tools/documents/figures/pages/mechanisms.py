"""A spectrum as ``make plot-<name>`` draws it: what the slider-crank that shakes its machine pushes on the frame."""

from __future__ import annotations

from types import SimpleNamespace

from matplotlib.figure import Figure

from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.vibration_slider_crank.mechanism import Params, build
from render.plots.pages.spectra import spectrum_page
from render.plots.style import house_style


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page. No joint of this mechanism needs masses other than its own."""
    m = build(Params())
    motion = to_motion(m.sweep(), None, "", {}, dict.fromkeys(m.bodies, "mechanism"))
    with house_style():
        return {"spectrum.svg": spectrum_page(motion, "shaking force")}
