"""A four-bar as a skeleton, and a parallelogram as a diagram of bodies and joints."""

from __future__ import annotations

from types import SimpleNamespace

from mbsd import Mechanism
from mbsd.pictures import Picture, Svg


def pictures(page: SimpleNamespace) -> dict[str, Picture | Svg]:
    """Return the pictures of the page."""
    four_bar = Mechanism.load(page.folder / "four_bar.json")  # before the page took its motor away
    four_bar.forces.clear()  # the spring that the page adds later
    return {"model_drawing.svg": four_bar.draw(), "model_topology.svg": page.wide.topology()}
