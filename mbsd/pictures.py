"""A drawing that a notebook shows without being asked and a script saves."""

from __future__ import annotations

import base64
import html
import io
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


DPI = 150


@dataclass(frozen=True, eq=False)
class Picture(Suggesting):
    """A drawing in matplotlib axes. ``save(path)`` writes png, svg or pdf by the path's suffix."""

    ax: Axes
    own: bool
    """True if the figure was made for this drawing; if not, its owner shows it."""

    @property
    def figure(self) -> Figure:
        """The whole figure."""
        figure = self.ax.get_figure(root=True)
        if figure is None:
            raise ModelError("the axes of this drawing were removed from their figure; draw again")
        return figure

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the figure, the same bytes each time; the suffix chooses png, svg or pdf."""
        suffix = os.path.splitext(path)[1].removeprefix(".").lower()
        if suffix not in _UNDATED:
            raise ModelError(f"{os.fspath(path)}: a drawing is saved as {', '.join(_UNDATED)}; end the path with one")
        content = self._content(suffix)
        from mbsd.base.files import write_whole

        write_whole(path, content)

    def _content(self, suffix: str) -> bytes:
        import matplotlib as mpl

        buffer = io.BytesIO()
        settings: dict[Any, Any] = {"svg.hashsalt": "mbsd", "svg.fonttype": "path"}
        if self.own:
            settings["text.parse_math"] = False  # of names at ticks, which are made now
        with mpl.rc_context(settings):
            self.figure.savefig(buffer, format=suffix, dpi=DPI, metadata=_UNDATED[suffix])
        return buffer.getvalue()

    def _repr_png_(self) -> bytes | None:
        return self._content("png") if self.own else None

    def _repr_svg_(self) -> str | None:
        return self._content("svg").decode() if self.own else None


_UNDATED: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}


@dataclass(frozen=True)
class Svg(Suggesting):
    """A diagram as SVG text."""

    text: str

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the diagram as an .svg file."""
        from mbsd.base.files import write_whole

        if not os.fspath(path).lower().endswith(".svg"):
            raise ModelError(f"{os.fspath(path)}: a topology diagram is saved as svg; end the path with .svg")
        write_whole(path, self.text.encode())

    def _repr_svg_(self) -> str:
        return self.text


@dataclass(frozen=True)
class Animation(Suggesting):
    """A file that was written; a notebook shows it."""

    path: Path
    pictures: int
    """Drawn; an MP4 repeats those of a short round."""
    seconds: float
    """Seconds on the screen, once through."""
    rate: float
    """Seconds of the motion in a second on the screen."""

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> dict[str, object]:
        code = base64.b64encode(self.path.read_bytes()).decode()
        if self.path.suffix.lower() == ".gif":
            return {"text/html": f'<img src="data:image/gif;base64,{code}">'}
        return {"text/html": f'<video controls loop autoplay muted src="data:video/mp4;base64,{code}"></video>'}


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
