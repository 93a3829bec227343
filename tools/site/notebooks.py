"""A notebook as a page: its text, its code, what the code printed and drew."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

from tools.figures.dark import dark


def page_of_notebook(path: Path) -> str:
    """The page; a line below its title leads to the notebook itself."""
    cells = json.loads(path.read_text())["cells"]
    text = "\n\n".join(_cell(cell) for cell in cells)
    title, _, rest = text.partition("\n")
    return f"{title}\n\n[{path.name}]({path.name}) is this page as a notebook.\n{rest}\n"


def _cell(cell: dict[str, Any]) -> str:
    source = "".join(cell["source"])
    if cell["cell_type"] != "code":
        return source
    return "\n\n".join([f"```python\n{source}\n```", *map(_output, cell["outputs"])])


def _output(output: dict[str, Any]) -> str:
    if "text" in output:
        return f"```text\n{''.join(output['text']).rstrip()}\n```"
    data = output.get("data", {})
    if "image/svg+xml" in data:
        return _pair("".join(data["image/svg+xml"]))
    if "text/html" in data:
        return re.sub(r"\n\s*\n", "\n", "".join(data["text/html"]))
    return f"```text\n{''.join(data.get('text/plain', '')).rstrip()}\n```"


def _pair(svg: str) -> str:
    light, on_dark = (_address(content) for content in (svg.encode(), dark(svg.encode())))
    return (
        f'<picture><source media="(prefers-color-scheme: dark)" srcset="{on_dark}">'
        f'<img alt="What the cell draws" src="{light}"></picture>'
    )


def _address(svg: bytes) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
