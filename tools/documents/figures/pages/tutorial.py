"""The pendulum, free and damped: drawn by the page itself."""

from __future__ import annotations

from types import SimpleNamespace

from matplotlib.figure import Figure


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """See tools/figures/__main__.py."""
    return {"tutorial_pendulum.svg": page.figure}
