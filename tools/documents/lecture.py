"""docs/lecture.ipynb: its code, its run by Jupyter's client, and the same bytes each time."""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tools.documents.pages import DOCS, write_changed

NOTEBOOK = DOCS / "lecture.ipynb"
SETTINGS = "svg.hashsalt: mbsd\nsvg.fonttype: path\npath.simplify_threshold: 0.1\n"
KEPT = ("image/svg+xml", "text/plain")
"""Kinds of output, of which the first that a cell has is kept."""
PATH = re.compile(r'(?<= d=")[^"]*(?=")')
LONG = re.compile(r"-?\d+\.\d{2,}")
LIMIT = 300
"""s: for each cell; the first sweep may compile."""


def read(path: Path) -> dict[str, Any]:
    """Return the JSON of a notebook."""
    return json.loads(path.read_text())


def code(notebook: dict[str, Any]) -> list[str]:
    """Return the code of its cells, in order."""
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


def executed(notebook: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the notebook with the outputs of a run in ``folder``.

    Raises UserError with the traceback of a cell.
    """
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    with tempfile.TemporaryDirectory() as temporary:
        style = Path(temporary) / "matplotlibrc"
        style.write_text(SETTINGS)
        environment = os.environ | {"MATPLOTLIBRC": str(style), "SOURCE_DATE_EPOCH": "0", "PYTHONPATH": str(ROOT)}
        run = NotebookClient(
            nbformat.reads(json.dumps(notebook), as_version=4),
            timeout=LIMIT,
            resources={"metadata": {"path": str(folder)}},
            extra_arguments=["--InlineBackend.figure_formats={'svg'}", "--log-level=ERROR"],
        )
        try:
            run.execute(env=environment)
        except CellExecutionError as error:
            raise UserError(f"lecture: a cell failed: {error}") from error
    return _settled(json.loads(nbformat.writes(run.nb)))


def written(notebook: dict[str, Any]) -> bytes:
    """Return the bytes of its file."""
    return (json.dumps(notebook, indent=1, ensure_ascii=False) + "\n").encode()


def _settled(notebook: dict[str, Any]) -> dict[str, Any]:
    """Return the notebook without what differs from run to run or between computers."""
    for cell in notebook["cells"]:
        cell["metadata"] = {}
        if cell["cell_type"] == "code":
            cell["outputs"] = [_plain(output) for output in _joined(cell["outputs"])]
    notebook["metadata"]["language_info"] = {"name": "python"}
    return notebook


def _joined(outputs: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the outputs with prints of several messages joined."""
    out: list[dict[str, Any]] = []
    for output in outputs:
        if out and output.get("name") == out[-1].get("name") == "stdout":
            out[-1]["text"] = [*out[-1]["text"], *output["text"]]
        else:
            out.append(output)
    return out


def _plain(output: dict[str, Any]) -> dict[str, Any]:
    data = output.get("data")
    if data is None:
        return output
    kind = next(kind for kind in KEPT if kind in data)
    text = "".join(data[kind])
    if kind == "image/svg+xml":
        text = PATH.sub(_rounded, re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL))
        text = re.sub(r">\s+<", "><", text)
    return output | {"data": {kind: text.splitlines(keepends=True)}, "metadata": {}}


def _rounded(path: re.Match[str]) -> str:
    """Return a path in tenths of a point: half the bytes, the same picture."""
    return " ".join(LONG.sub(lambda number: f"{float(number[0]):.1f}", path[0]).split())


def main(words: Sequence[str]) -> None:
    """Run the notebook in a kernel of its own and keep its outputs."""
    write_changed(NOTEBOOK, written(executed(read(NOTEBOOK), NOTEBOOK.parent)))
