"""``python -m tools.hunt_parts``: parts by themselves for random mechanisms, and the proof that none touch.

--n 1000 --seed 1     a thousand cases, the same each time; on all cores unless --jobs says otherwise
--kind NAME           of one kind of mechanism
--layers              no solids: sizes, layers and heights alone
--case SEED           one case in detail

Exit code 1 if parts collide, are unsound, or anything hung or failed. The report is also in out/hunt_parts.json.
"""

from __future__ import annotations

import argparse
import os
import time
from functools import partial

from shared.console import progress, run_cli, say, warn
from shared.paths import out_root
from tools.hunt.__main__ import SEEDS
from tools.hunt.pool import results
from tools.hunt_parts import case
from tools.hunt_parts.outcome import WRONG
from tools.hunt_parts.report import Tally

LIMIT = 900.0
"""s of one case, some fifty times the usual."""
EACH = 30.0
"""s after which the report is written again."""


def main() -> int:
    """Hunt, report, and say by the exit code whether anything was found."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.hunt_parts", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--n", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--kind")
    parser.add_argument("--layers", action="store_true")
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds of one case")
    parser.add_argument("--case", type=int)
    asked = parser.parse_args()
    if asked.case is not None:
        found = case.run(asked.case, asked.kind, not asked.layers)
        outcome = found.outcomes[-1]
        print(f"case {asked.case}: {found.family}: {outcome.state}: {outcome.reason}\n{outcome.detail}")
        print(f"{found.seconds:.1f} s")
        return int(outcome.state in WRONG)
    return hunt(asked.n, asked.seed, asked.jobs, asked.kind, not asked.layers, asked.limit)


def hunt(n: int, seed: int, jobs: int, kind: str | None = None, solids: bool = True, limit: float = LIMIT) -> int:
    """n cases, of one kind if it is given; 0 if nothing was found."""
    tally, began = Tally(), time.monotonic()
    seeds, path, written = range(seed * SEEDS, seed * SEEDS + n), out_root() / "hunt_parts.json", began
    with progress("hunt-parts", n, "case") as shown:
        for result in results(seeds, partial(case.run, name=kind, solids=solids), jobs, limit):
            outcome = tally.add(result)
            if outcome.state in WRONG:
                warn("hunt-parts", f"{outcome.state}: case {result.seed} ({result.family}): {outcome.detail}")
            shown.advance(1, f"{len(tally.findings)} found" if tally.findings else "")
            if time.monotonic() - written > EACH:
                tally.write(path, seed, n, time.monotonic() - began)
                written = time.monotonic()
    seconds = time.monotonic() - began
    tally.write(path, seed, n, seconds)
    tally.show(seconds)
    say("hunt-parts", f"{path}; one case in detail: python -m tools.hunt_parts --case NUMBER")
    return 1 if tally.findings else 0


if __name__ == "__main__":
    run_cli(main)
