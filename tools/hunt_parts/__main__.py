"""``python -m tools.hunt_parts``: automatic parts of random mechanisms, and proof that none touch.

--n 1000 --seed 1     a thousand cases, the same each time; on all cores unless --jobs says otherwise
--kind NAME           of one kind of mechanism
--layers              no solids: sizes, layers and heights alone
--case SEED           one case in detail
--anew                forget what is known of such cases

Each case is a line in out/hunt_parts/: what was stopped goes on, and --n 2000 after --n 1000 looks at a thousand more.
Exit code 1 if parts collide, are unsound, or anything hung or failed. The report is also in out/hunt_parts.json.
"""

from __future__ import annotations

import re
from functools import partial
from itertools import chain

from shared.stage.console import run_cli, say
from shared.stage.paths import out_root
from tools.hunt.loop import follow, parser, refuse_unknown, seeds
from tools.hunt.outcome import CaseResult
from tools.hunt.pool import results
from tools.hunt.report import Tally
from tools.hunt_parts import case
from tools.hunt_parts.outcome import BUILT, REFUSED, STATES, WRONG, Kept
from tools.random_mechanisms.own_kinds import KINDS

LIMIT = 900.0
"""s of one case, some fifty times the usual."""


def main() -> int:
    """Hunt, report, and say by the exit code whether anything was found."""
    known = parser("tools.hunt_parts", __doc__, LIMIT)
    known.add_argument("--layers", action="store_true")
    known.add_argument("--anew", action="store_true")
    asked = known.parse_args()
    refuse_unknown(None if asked.kind in KINDS else asked.kind)
    if asked.case is not None:
        result = case.run(asked.case, asked.kind, not asked.layers)
        outcome = result.outcomes[-1]
        print(f"case {asked.case}: {result.family}: {outcome.state}: {outcome.reason}\n{outcome.detail}")
        print(f"{result.seconds:.1f} s")
        return int(outcome.state in WRONG)
    return hunt(asked.n, asked.seed, asked.jobs, asked.kind, not asked.layers, asked.limit, asked.anew)


def hunt(
    n: int, seed: int, jobs: int, kind: str | None = None, solids: bool = True, limit: float = LIMIT, anew: bool = False
) -> int:
    """n cases, of one kind if it is given; 0 if nothing was found. Goes on where one like it was stopped."""
    kept = Kept(out_root() / "hunt_parts" / f"{_named(seed, kind, solids)}.jsonl")
    if anew:
        kept.path.unlink(missing_ok=True)
    tally = Tally("mbsd.hunt_parts", STATES, WRONG, (BUILT, REFUSED))
    before = kept.read(seeds(seed, n))
    if before:
        others = f", {kept.others} of them by other sources (--anew looks at all again)" if kept.others else ""
        say("hunt-parts", f"{len(before)} of {n} are known{others}: {kept.path}")

    def add(result: CaseResult) -> list[str]:
        wrong = tally.add(result)
        if result not in before:
            kept.add(result)
        return [f"{outcome.state}: case {result.seed} ({result.family}): {outcome.detail}" for outcome in wrong]

    known = {result.seed for result in before}
    fresh = results(
        (s for s in seeds(seed, n) if s not in known), partial(case.run, name=kind, solids=solids), jobs, limit
    )
    follow("tools.hunt_parts", tally, out_root() / "hunt_parts.json", seed, n, chain(before, fresh), add)
    return 1 if tally.findings else 0


def _named(seed: int, kind: str | None, solids: bool) -> str:
    words = [f"seed {seed}", kind or "", "" if solids else "layers"]
    return re.sub(r"\W+", "_", " ".join(words).strip())


if __name__ == "__main__":
    run_cli(main)
