"""``python -m tools.hunt_imports``: damaged files of other programs, and how they are imported.

--n 1000 --seed 1     a thousand cases, the same each time; on all cores unless --jobs says otherwise
--kind NAME           of one kind of file: asmt, dxf, json, linkage2, pmks, pmks+ (addresses), txt
--case SEED           one case in detail; --keep FILE writes its file

Each is read, refused in a sentence, or found: a traceback, a file that would not load, or more than --limit seconds.
Exit code 1 if anything was found. The report is also in out/hunt_imports.json.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from shared.stage.console import run_cli
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import out_root
from tools.hunt.loop import follow, parser, seeds
from tools.hunt.outcome import HUNG, WRONG, CaseResult
from tools.hunt.pool import results
from tools.hunt.report import Tally
from tools.hunt_imports import case
from tools.hunt_imports.mutations import damaged, samples

LIMIT = 60.0
"""s of one case, a thousand times the usual."""


def main() -> int:
    """Hunt, report, and say by the exit code whether anything was found."""
    known = parser("tools.hunt_imports", __doc__, LIMIT)
    known.add_argument("--keep", type=Path)
    asked = known.parse_args()
    if asked.kind is not None and asked.kind not in samples():
        raise UserError(f"there is no kind of file '{asked.kind}'; there is: {', '.join(sorted(samples()))}")
    if asked.case is not None:
        return show(asked.case, asked.kind, asked.keep)
    return hunt(asked.n, asked.seed, asked.jobs, asked.kind, asked.limit)


def hunt(n: int, seed: int, jobs: int, kind: str | None = None, limit: float = LIMIT) -> int:
    """Import n damaged files, of one kind if it is given; 0 if nothing was found."""
    tally = Tally()

    def add(result: CaseResult) -> list[str]:
        wrong = tally.add(result)
        return [f"{outcome.state}: case {result.seed} ({result.family}): {outcome.detail}" for outcome in wrong]

    arrived = results(seeds(seed, n), partial(case.run, kind=kind), jobs, limit)
    follow("tools.hunt_imports", tally, out_root() / "hunt_imports.json", seed, n, arrived, add)
    return int(bool(tally.findings))


def show(seed: int, kind: str | None, kept: Path | None) -> int:
    """Print one case; ``kept`` is where its file is written."""
    given = damaged(seed, kind)
    if kept is not None:
        write_bytes(kept, given.content)
    result = case.run(seed, kind)
    outcome = result.outcomes[-1]
    print(f"case {seed}: {given.kind} ({given.name or 'an address'}), {given.mutation}: {outcome.state}")
    print(f"{outcome.reason}\n{outcome.detail}\n{result.seconds:.1f} s")
    return int(outcome.state in (WRONG, HUNG))


if __name__ == "__main__":
    run_cli(main)
