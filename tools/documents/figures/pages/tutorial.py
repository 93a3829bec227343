"""The pendulum, free and damped: drawn by the page itself."""

from __future__ import annotations

from types import SimpleNamespace

from matplotlib.figure import Figure


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    return {"tutorial_pendulum.svg": page.figure}
