"""Draws the pictures of docs/ from what the code of their pages computes: ``make docs``, or ``-m tools.figures NAME``.

Each file of ``pages/`` belongs to the page of its name. Its ``pictures`` gets the variables that the page's code
leaves behind and returns figures by file name.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import pkgutil
import re
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

from matplotlib import pyplot
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

import tools.figures.pages
from mbsd.pictures.picture import Picture, Svg
from tools.figures.dark import dark, name_of
from tools.figures.dark_gif import dark_gif
from tools.figures.look import STYLE

ROOT = Path(__file__).resolve().parent.parent.parent
BLOCK = re.compile(r"^```python\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
PAGES = tuple(sorted(m.name for m in pkgutil.iter_modules(tools.figures.pages.__path__)))


def drawn(page: str) -> dict[str, bytes]:
    """The pictures of a page by file name, each also on dark paper."""
    with mpl.rc_context(STYLE):  # pyright: ignore[reportArgumentType]
        variables = _run(page)
        out = {}
        for name, picture in importlib.import_module(f"tools.figures.pages.{page}").pictures(variables).items():
            out[name] = _bytes(picture)
            out[name_of(name)] = (dark_gif if name.endswith(".gif") else dark)(out[name])
        pyplot.close("all")
    return out


def _run(page: str) -> SimpleNamespace:
    """What the Python of a page leaves behind, run from the project's folder."""
    code = "\n".join(BLOCK.findall((ROOT / "docs" / f"{page}.md").read_text()))
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
    """Lay it out now and round where the axes are: the last bits change from run to run, and names in SVG with them."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for ax in figure.axes:
        ax.set_position(Bbox.from_bounds(*(round(value, 6) for value in ax.get_position(original=True).bounds)))


def main() -> int:
    """Write the pictures of the pages named, or of all."""
    for page in sys.argv[1:] or PAGES:
        for name, content in drawn(page).items():
            path = ROOT / "docs" / name
            if not path.exists() or path.read_bytes() != content:
                path.write_bytes(content)
                print(f"{os.path.relpath(path)} is new")
    return 0


if __name__ == "__main__":
    sys.exit(main())
