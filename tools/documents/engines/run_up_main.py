"""``make study-run-up``: engines on their mounts run through resonance, every combination of GRID on all cores.

Writes out/engines/run_up.csv, out/engines/run_up.svg and the table of docs/engines.md; what is known is kept in
out/engines/studies/.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import matplotlib as mpl

from mbsd import study
from mbsd.base.files import write_whole
from tools.engine_run_up.picture import picture
from tools.engine_run_up.runs import GRID, build, measure
from tools.engine_run_up.table import with_table

mpl.use("Agg")

ROOT = Path(__file__).resolve().parents[2]


def main() -> None:
    """Compute and write."""
    begun = time.monotonic()
    out = Path(os.environ.get("MBSD_OUT") or ROOT / "out") / "engines"
    out.mkdir(parents=True, exist_ok=True)
    runs = study(build, GRID, measure, folder=out / "studies", save=out / "run_up.csv")
    failed = list(runs["reason"].dropna())
    if failed:
        raise SystemExit(f"run-up: {len(failed)} runs failed, the first for: {failed[0]}")
    with mpl.rc_context({"svg.hashsalt": "mbsd", "svg.fonttype": "path"}):
        picture(runs).savefig(out / "run_up.svg", metadata={"Date": None, "Creator": None})
    page = ROOT / "docs" / "engines.md"
    write_whole(page, with_table(page.read_text(), runs).encode())
    print(f"run-up: {len(runs)} runs in {time.monotonic() - begun:.1f} s")
    print(f"run-up: {out / 'run_up.csv'}, {out / 'run_up.svg'} and the table of docs/engines.md written")


if __name__ == "__main__":
    main()
