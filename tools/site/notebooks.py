"""A notebook as a page: its text, its code, what the code printed and drew."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from tools.documents.figures.dark import dark


def page_of_notebook(path: Path) -> tuple[str, dict[str, bytes]]:
    """The page, and its pictures by name; a line below the title leads to the notebook itself."""
    pictures: dict[str, bytes] = {}
    cells = json.loads(path.read_text())["cells"]
    text = "\n\n".join(_cell(cell, path.stem, pictures) for cell in cells)
    title, _, rest = text.partition("\n")
    return f"{title}\n\n[{path.name}]({path.name}) is this page as a notebook.\n{rest}\n", pictures


def _cell(cell: dict[str, Any], stem: str, pictures: dict[str, bytes]) -> str:
    source = "".join(cell["source"])
    if cell["cell_type"] != "code":
        return source
    return "\n\n".join([f"```python\n{source}\n```", *(_output(output, stem, pictures) for output in cell["outputs"])])


def _output(output: dict[str, Any], stem: str, pictures: dict[str, bytes]) -> str:
    data = output.get("data", {"text/plain": output.get("text", "")})
    if "image/svg+xml" in data:
        return _pair("".join(data["image/svg+xml"]).encode(), stem, pictures)
    if "text/html" in data:
        return re.sub(r"\n\s*\n", "\n", "".join(data["text/html"]))
    return f"``` {{ .text .printed }}\n{''.join(data.get('text/plain', '')).rstrip()}\n```"


def _pair(svg: bytes, stem: str, pictures: dict[str, bytes]) -> str:
    """The two pictures, as pages of docs/ have them."""
    light, on_dark = (f"{stem}_{len(pictures) // 2 + 1}{paper}.svg" for paper in ("", "_dark"))
    pictures |= {light: svg, on_dark: dark(svg)}
    return (
        f'<picture><source media="(prefers-color-scheme: dark)" srcset="{on_dark}">'
        f'<img alt="What the cell draws" src="{light}"></picture>'
    )
