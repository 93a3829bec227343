"""The slider-crank in motion, with the reactions of its joints and the velocities of its pins."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace


def pictures(page: SimpleNamespace) -> dict[str, bytes]:
    """Return the pictures of the page."""
    return {"animation.gif": Path(page.folder / "slider_crank.gif").read_bytes()}
