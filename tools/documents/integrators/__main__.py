"""Measures the integrators anew: docs/integrators.json and the tables of docs/integrators.md (``make integrators``).

Orders and costs take two minutes, ten thousand periods by each method another three. The picture is drawn from the
numbers by tools/figures. Methods of packages that are not installed keep their old numbers.
"""

from __future__ import annotations

import json
from pathlib import Path

from tools.integrators import accuracy, long_runs
from tools.integrators.tables import with_tables

DOCS = Path(__file__).resolve().parent.parent.parent / "docs"
FILE = DOCS / "integrators.json"


def tell(line: str) -> None:
    """As it goes."""
    print(line, flush=True)


def main() -> None:
    """Measure and write."""
    kept = json.loads(FILE.read_text())["accuracy"] if FILE.exists() else {}
    measured = {"accuracy": kept | accuracy.measured(tell), "long": long_runs.measured(tell)}
    for runs in measured["long"].values():
        unit = runs["dop853"]["seconds"]
        for run in runs.values():
            run["seconds"] = float(f"{run['seconds'] / unit:.2g}")
    FILE.write_text(json.dumps(measured, indent=1) + "\n")
    page = DOCS / "integrators.md"
    page.write_text(with_tables(page.read_text(), json.loads(json.dumps(measured))))


if __name__ == "__main__":
    main()
