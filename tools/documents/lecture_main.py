"""Runs docs/lecture.ipynb in a kernel of its own and keeps its outputs: ``make docs`` or ``-m tools.lecture``."""

from __future__ import annotations

from shared.stage.console import run_cli, say
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT
from tools.lecture.notebook import executed, read, written

NOTEBOOK = ROOT / "docs" / "lecture.ipynb"


def main() -> int:
    """Write it, where it has changed."""
    content = written(executed(read(NOTEBOOK), NOTEBOOK.parent))
    if content != NOTEBOOK.read_bytes():
        write_bytes(NOTEBOOK, content)
        say("lecture", f"docs/{NOTEBOOK.name} is new: {len(content) / 1000:.0f} kB")
    return 0


if __name__ == "__main__":
    run_cli(main)
