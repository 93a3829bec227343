"""Pictures of docs/, drawn from what the code of their pages computes.

A page's function has its name, gets the variables that the page's code leaves behind and returns figures by file name.
"""

from __future__ import annotations

import contextlib
import io
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

from matplotlib import pyplot
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from mbsd.pictures import Picture, Svg
from shared.stage.paths import ROOT
from tools.documents.figures import designs, loads, motions, simulations
from tools.documents.figures.dark import dark, dark_gif, name_of
from tools.documents.figures.look import STYLE
from tools.documents.pages import DOCS, write_changed

BLOCK = re.compile(r"^```python\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
DRAWN: dict[str, Callable[[SimpleNamespace], Mapping[str, Figure | Picture | Svg | bytes]]] = {
    draw.__name__: draw for chapter in (motions, loads, simulations, designs) for draw in chapter.PAGES
}
PAGES = tuple(sorted(DRAWN))


def drawn(page: str) -> dict[str, bytes]:
    """Return the pictures of a page by file name, each also on dark paper."""
    with mpl.rc_context(STYLE):  # pyright: ignore[reportArgumentType]
        variables = _run(page)
        out = {}
        for name, picture in DRAWN[page](variables).items():
            out[name] = _bytes(picture)
            out[name_of(name)] = (dark_gif if name.endswith(".gif") else dark)(out[name])
        pyplot.close("all")
    return out


def _run(page: str) -> SimpleNamespace:
    """Return the variables that the Python of a page leaves behind, run from the project's folder."""
    code = "\n".join(BLOCK.findall((DOCS / f"{page}.md").read_text()))
    variables: dict[str, Any] = {"__name__": "__main__"}
    with contextlib.chdir(ROOT), contextlib.redirect_stdout(io.StringIO()):
        exec(compile(code, f"docs/{page}.md", "exec"), variables)
    return SimpleNamespace(**variables)


def _bytes(picture: Figure | Picture | Svg | bytes) -> bytes:
    """SVG without a date, the same each time; a file's bytes as they are."""
    if isinstance(picture, bytes):
        return picture
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.svg"
        if isinstance(picture, Figure):
            _settle(picture)
            picture.savefig(path, metadata={"Date": None, "Creator": None})
        else:
            if isinstance(picture, Picture):
                _settle(picture.figure)
            picture.save(path)
        return path.read_bytes()


def _settle(figure: Figure) -> None:
    """Lay a figure out now and round where its axes are.

    The last bits change from run to run, and names in SVG with them.
    """
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for ax in figure.axes:
        ax.set_position(Bbox.from_bounds(*(round(value, 6) for value in ax.get_position(original=True).bounds)))


def main(words: Sequence[str]) -> None:
    """Write the pictures of the pages named, or of all."""
    for page in words or PAGES:
        for name, content in drawn(page).items():
            write_changed(DOCS / name, content)
