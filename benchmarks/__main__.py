"""``make bench``: every code on every problem, docs/benchmarks.md, out/bench.md and out/bench.json.

python -m benchmarks                  all of it
python -m benchmarks calls            the four-bar's sweep and calls as users make them alone, only shown
python -m benchmarks batch            25 000 designs of a four-bar in one call, only shown
python -m benchmarks clearance        a slider-crank with play beside the ideal one, only shown
python -m benchmarks dynamics         the dynamics problems alone, only shown
python -m benchmarks derivatives      gradients in ten numbers beside their motions, only shown
python -m benchmarks engines          sweeps of engines beside a four-bar's, the map of bank angles, only shown
python -m benchmarks machines         gears, a Geneva, a cam and a stiff contact alone, only shown
python -m benchmarks film [--help]     what a film costs (make bench-film)
python -m benchmarks live [--help]     from a slider of the live page to the picture (make bench-live)
python -m benchmarks cluster          what a cluster costs, a task and a worker, only shown
python -m benchmarks scaling          a long row of four-bars, cost of a body, only shown
python -m benchmarks simulations       many simulations and single ones with events beside peers, only shown
python -m benchmarks synthesis        lengths for a path alone, only shown
python -m benchmarks space            a top, loops and chains in space beside peers, only shown
python -m benchmarks start            the table of start-up (make bench-start)
python -m benchmarks table            the tables again from the last run
python -m benchmarks tolerances        four-bars whose lengths stray beside numpy and a loop with scipy, only shown
python -m benchmarks tune [names]     the sweeps for the best settings, of some codes or problems
"""

from __future__ import annotations

import sys

from benchmarks import batch, clearance, derivatives, engines, rows, start, synthesis, tolerances
from benchmarks.calls import measure as calls
from benchmarks.dynamics import measure as dynamics
from benchmarks.dynamics.settings import tune_all
from benchmarks.film import measure as film
from benchmarks.film import timing
from benchmarks.machines import measure as machines
from benchmarks.rows import Bar, Row
from benchmarks.simulations import measure as simulations
from benchmarks.space import measure as space
from shared.stage.console import run_cli, say
from shared.stage.errors import UserError

PARTS = {
    "calls": calls.measured,
    "batch": batch.measured,
    "simulations": simulations.measured,
    "tolerances": tolerances.measured,
    "synthesis": synthesis.measured,
    "derivatives": derivatives.measured,
    "machines": machines.measured,
    "engines": engines.measured,
    "clearance": clearance.measured,
    "dynamics": dynamics.measured,
    "space": space.measured,
    "scaling": dynamics.scaling,
}
"""Benchmarks that run alone, by their word."""
OTHERS = ("cluster", "film", "live", "start", "table", "tune [names]")


def main() -> int:
    """Run what is asked for; 1 if a bar is missed."""
    match sys.argv[1:]:
        case []:
            return _all()
        case [part] if part in PARTS:
            rows_of_part, bars = PARTS[part]()
            rows.show_all(rows_of_part)
            return _tell(bars)
        case ["film", *words]:
            return film.measured(words)
        case ["live", *words]:
            from benchmarks import live

            return live.measured(words)
        case ["cluster"]:
            from benchmarks import cluster

            return cluster.measured()
        case ["start"]:
            return start.measured()
        case ["table"]:
            rows.write_tables(*rows.read())
        case ["tune", *names]:
            tune_all(names)
        case other:
            raise UserError(
                f"bench: {' '.join(other)}? There is: {', '.join(sorted([*PARTS, *OTHERS]))}, or nothing for all"
            )
    return 0


def _all() -> int:
    everything: list[Row] = []
    bars: list[Bar] = []
    for part in PARTS.values():
        more, more_bars = part()
        everything += more
        bars += more_bars
    films, missed = timing.rows_of_films()
    rows.show_all(everything + films)
    rows.write(everything + films, bars)
    rows.write_tables(everything, bars)
    for line in missed:
        say("bench", f"missed: {line}")
    say("bench", "out/bench.md, out/bench.json and the table of docs/benchmarks.md written")
    return _tell(bars) or (1 if missed else 0)


def _tell(bars: list[Bar]) -> int:
    for bar in bars:
        say("bench", f"{'met' if bar.met else 'missed'}: {bar}")
    return 0 if all(bar.met for bar in bars) else 1


if __name__ == "__main__":
    run_cli(main)
