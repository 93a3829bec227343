"""A page with a skeleton in motion."""

from __future__ import annotations

import html


class View:
    """A page that a notebook shows where it stands; ``html`` is the page."""

    def __init__(self, page: str, height: int) -> None:
        self.html, self._height = page, height

    def _repr_html_(self) -> str:
        inside = html.escape(self.html)
        return (
            f'<iframe srcdoc="{inside}" sandbox="allow-scripts" style="width:100%;height:{self._height}px;border:1px '
            'solid #9aa5b355;border-radius:8px" title="the mechanism in motion"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<View, {len(self.html) / 1e3:.0f} kB of HTML>"
