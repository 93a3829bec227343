"""``python -m tools.hunt``: random mechanisms, each solved again in other words; no two may differ.

--n 1000 --seed 1     a thousand cases, the same each time; on all cores unless --jobs says otherwise
--kind NAME           of one kind of mechanism
--case SEED           one case with all its variations, in detail

Exit code 1 if anything was wrong or hung. The report is also in out/hunt.json.
"""

from __future__ import annotations

from functools import partial

from shared.stage.console import run_cli, say
from shared.stage.paths import out_root
from tools.hunt import case
from tools.hunt.loop import follow, parser, refuse_unknown, seeds
from tools.hunt.outcome import HUNG, WRONG, CaseResult
from tools.hunt.pool import LIMIT, results
from tools.hunt.report import Tally


def main() -> int:
    """Hunt, report, and say by the exit code whether anything was found."""
    asked = parser("tools.hunt", __doc__).parse_args()
    refuse_unknown(asked.kind)
    if asked.case is not None:
        return one_case(asked.case, asked.kind)
    return hunt(asked.n, asked.seed, asked.jobs, asked.limit, asked.kind)


def hunt(n: int, seed: int, jobs: int, limit: float = LIMIT, kind: str | None = None) -> int:
    """n cases, of one kind if it is given; 0 if none was wrong or hung."""
    tally = Tally()

    def add(result: CaseResult) -> list[str]:
        return [f"{o.state}: case {result.seed} ({result.family}), {o.variation}" for o in tally.add(result)]

    outcomes = results(seeds(seed, n), partial(case.run, name=kind), jobs, limit, _compiling)
    follow("tools.hunt", tally, out_root() / "hunt.json", seed, n, outcomes, add)
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
        for name, entry in table.items():
            ends = " - ".join(f"{e.body.name}({e.x!r}, {e.y!r}, {e.angle!r})" for e in (entry.i, entry.j))
            laws = getattr(entry, "motion", None) or getattr(entry, "laws", None) or ""
            print(f"  {entry.kind.name} {name}: {ends} {dict(entry.params) or ''} {laws}")
    result = case.run(seed, kind, every=True)
    for outcome in result.outcomes:
        print(f"{outcome.state:>12}  {outcome.variation}: {outcome.reason} {outcome.detail}".rstrip(" :"))
    print(f"{result.seconds:.2f} s")
    return 1 if any(outcome.state == WRONG for outcome in result.outcomes) else 0


if __name__ == "__main__":
    run_cli(main)
