"""Builds what docs/ shows: ``python -m tools.documents KIND [WORDS...]``.

figures [PAGE...]      pictures of the pages named, or of all, from what their code computes (make docs)
lecture                docs/lecture.ipynb run cell by cell, its outputs kept (make docs)
bank-angles            V engines over their bank angles (make study-engines)
run-up                 engines on mounts run through resonance (make study-run-up)
integrators            order, cost and long runs of the integrators (make integrators)
readme-loop [--help]   the loop at the top of README.md, filmed in Chromium (make readme-loop)
sound NAME...          waves and spectrograms of films, after make run-<name> of each
"""

from __future__ import annotations

import importlib
import sys

from shared.stage.console import run_cli
from shared.stage.errors import UserError

KINDS = {
    "figures": "figures.figures",
    "lecture": "lecture",
    "bank-angles": "bank_angles",
    "run-up": "run_up",
    "integrators": "integrators",
    "readme-loop": "readme_loop",
    "sound": "sound_picture",
}
"""Module that builds each kind: its ``main`` gets the other words."""


def main() -> int:
    """Build the documents of one kind."""
    kind, *words = sys.argv[1:] or [""]
    if kind not in KINDS:
        raise UserError(f"documents: there is no kind {kind!r}; choose one of: {', '.join(KINDS)}")
    importlib.import_module(f"tools.documents.{KINDS[kind]}").main(words)
    return 0


if __name__ == "__main__":
    run_cli(main)
