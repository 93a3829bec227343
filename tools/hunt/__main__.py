"""``python -m tools.hunt``: random mechanisms of all kinds, each solved again in other words; who disagrees is wrong.

--n 1000 --seed 1     a thousand cases, the same each time; on all cores unless --jobs says otherwise
--kind NAME           of one kind of mechanism
--case SEED           one case with all its variations, in detail

Exit code 1 if anything was wrong or hung. The report is also in out/hunt.json.
"""

from __future__ import annotations

import argparse
import math
import os
import time
from functools import partial

from shared.console import progress, run_cli, say, warn
from shared.errors import UserError
from shared.paths import out_root
from tools.hunt import case
from tools.hunt.outcome import HUNG, WRONG
from tools.hunt.pool import LIMIT, results
from tools.hunt.report import Tally

SEEDS = 1_000_000
"""Cases of one --seed have numbers from seed * SEEDS on."""
EACH = 30.0
"""s after which the report is written again, so that a hunt that is killed has not been in vain."""


def main() -> int:
    """Hunt, report, and say by the exit code whether anything was found."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.hunt", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--n", type=_positive, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=_positive, default=os.cpu_count() or 1)
    parser.add_argument("--kind")
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds of one case")
    parser.add_argument("--case", type=int)
    asked = parser.parse_args()
    if asked.kind is not None:
        _refuse_unknown(asked.kind)
    if asked.case is not None:
        return one_case(asked.case, asked.kind)
    return hunt(asked.n, asked.seed, asked.jobs, asked.limit, asked.kind)


def hunt(n: int, seed: int, jobs: int, limit: float = LIMIT, kind: str | None = None) -> int:
    """n cases, of one kind if it is given; 0 if none was wrong or hung."""
    tally, began, stopped = Tally(), time.monotonic(), False
    seeds, path, written = range(seed * SEEDS, seed * SEEDS + n), out_root() / "hunt.json", time.monotonic()
    try:
        with progress("hunt", n, "case") as shown:
            for result in results(seeds, partial(case.run, name=kind), jobs, limit, _compiling):
                for outcome in tally.add(result):
                    warn("hunt", f"{outcome.state}: case {result.seed} ({result.family}), {outcome.variation}")
                shown.advance(1, f"{len(tally.findings)} found" if tally.findings else "")
                if time.monotonic() - written > EACH:
                    tally.write(path, seed, n, time.monotonic() - began)
                    written = time.monotonic()
    except KeyboardInterrupt:
        stopped = True
    seconds = time.monotonic() - began
    tally.write(path, seed, n, seconds)
    tally.show(seconds)
    say("hunt", f"{path}; one case in detail: python -m tools.hunt --case NUMBER")
    if stopped:
        raise KeyboardInterrupt
    return 1 if tally.count(WRONG) or tally.count(HUNG) else 0


def _compiling() -> None:
    say("hunt", "compiling for this machine, which is done once for each kind of mechanism and takes minutes in all")


def one_case(seed: int, kind: str | None) -> int:
    """The mechanism of a case, and what came of each variation."""
    family, subject, _ = case.drawn(seed, kind)
    m = subject.m
    print(f"case {seed}: {family.name}, {'sweep' if subject.driven else 'simulation'} of {subject.duration:.9g} s")
    print(
        f"known: possible {subject.possible}, distance {subject.distance:.3g}, {', '.join(subject.traits) or 'usual'}"
    )
    for name, body in m.bodies.items():
        start, moving = m.starts.get(name), m.velocities.get(name)
        print(f"  body {name}: {body.mass:.9g} kg, com {body.com}, {body.inertia:.9g} kg m^2, {start}, {moving}")
    for table in (m.joints, m.drivers, m.forces, m.contacts):
        for name, one in table.items():
            ends = " - ".join(f"{e.body.name}({e.x!r}, {e.y!r}, {e.angle!r})" for e in (one.i, one.j))
            laws = getattr(one, "motion", None) or getattr(one, "laws", None) or ""
            print(f"  {one.kind.name} {name}: {ends} {dict(one.params) or ''} {laws}")
    result = case.run(seed, kind, every=True)
    for outcome in result.outcomes:
        print(f"{outcome.state:>12}  {outcome.variation}: {outcome.reason} {outcome.detail}".rstrip(" :"))
    print(f"{result.seconds:.2f} s")
    return 1 if any(outcome.state == WRONG for outcome in result.outcomes) else 0


def _positive(text: str) -> int:
    number = int(text)
    if not 0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number


def _refuse_unknown(kind: str) -> None:
    from tools.hunt.subject import all_families

    names = list(all_families())
    if kind not in names:
        raise UserError(f"there is no kind of mechanism '{kind}'; there is: {', '.join(names)}")


if __name__ == "__main__":
    run_cli(main)
