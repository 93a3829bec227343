"""Numbers of many runs, compared with those recorded or kept.

``python -m tools.numbers`` check [TEXT] | record | keep [TEXT] | within TOLERANCE [TEXT], and
``python -m tools.numbers events`` check [TEXT] | record [TEXT] | loop [TEXT]: see tools/numbers/events.

Python's, numpy's and the C library's functions and BLAS choose their code by the processor, which changes last digits.
So this starts itself anew with what every x86-64 has: BLAS and numpy without AVX, the C library without FMA.
"""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

FILE = Path(__file__).parent / "recorded.txt"
KEPT = Path(__file__).resolve().parents[2] / ".cache" / "numbers.msgpack"
SAME_EVERYWHERE = {
    "OPENBLAS_CORETYPE": "Prescott",
    "OPENBLAS_NUM_THREADS": "1",
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable,-FMA4_Usable",
    "PYTHONHASHSEED": "0",
    "CI": "true",
    "STRICT": "0",
}
"""CI: hypothesis then draws the same examples each time; STRICT: no program of the system is needed for that."""


def main() -> int:
    """Returns 1 where numbers differ."""
    from tools.numbers import kept
    from tools.numbers.contents import digest

    match sys.argv[1:]:
        case ["check", *only] if len(only) <= 1:
            return _check(only[0] if only else "")
        case ["record"]:
            FILE.write_text("".join(f"{name}: {value}\n" for name, value in sorted(_measured("", digest).items())))
            return 0
        case ["keep", *only] if len(only) <= 1:
            kept.keep(KEPT, _measured(only[0] if only else "", kept.kept))
            print(f"numbers: kept in {KEPT}")
            return 0
        case ["within", tolerance, *only] if len(only) <= 1:
            return _within(float(tolerance), only[0] if only else "")
        case ["events", "check" | "record" | "loop" as what, *only] if len(only) <= 1:
            return _events(what, only[0] if only else "")
    print(
        "usage: python -m tools.numbers check [TEXT] | record | keep [TEXT] | within TOLERANCE [TEXT]\n"
        "       python -m tools.numbers events check [TEXT] | record [TEXT] | loop [TEXT]",
        file=sys.stderr,
    )
    return 2


def _events(what: str, only: str) -> int:
    from tools.numbers.events import commands

    if what == "loop":
        commands.show(only)
        return 0
    return commands.check(only) if what == "check" else commands.record(only)


def _measured(only: str, measure: Callable[[Any], Any]) -> dict[str, Any]:
    from tools.numbers import blocks, groups, published, runs
    from tools.numbers.contents import outcome

    measured, started = {}, time.perf_counter()
    for source in (runs, groups, blocks, published):
        for name, run in source.runs():
            if only in name:
                with warnings.catch_warnings(action="ignore"):
                    measured[name] = measure(outcome(run))
    if not only or any(name.startswith("published") and only in name for name in _recorded()):
        measured.update((name, value) for name, value in published.published(only, measure) if only in name)
    print(f"numbers: {len(measured)} runs in {time.perf_counter() - started:.0f} s")
    return measured


def _recorded() -> dict[str, str]:
    return dict(line.rsplit(": ", 1) for line in FILE.read_text().splitlines()) if FILE.exists() else {}


def _check(only: str) -> int:
    from tools.numbers.contents import digest

    recorded = {name: value for name, value in _recorded().items() if only in name}
    now = _measured(only, digest)
    differ = [name for name, value in now.items() if recorded.get(name, value) != value]
    for name in differ:
        print(f"numbers: {name} differs")
    missing = _missing(recorded, now, "recorded")
    print(f"numbers: {len(differ)} of {len(now)} differ")
    return 1 if differ or missing else 0


def _within(tolerance: float, only: str) -> int:
    """Compare with the numbers that were kept; those that differ at all are listed, the farthest last."""
    from tools.numbers import kept

    try:
        before = {name: run for name, run in kept.read(KEPT).items() if only in name}
    except (OSError, ValueError) as error:
        print(
            f"numbers: there are none to compare with ({error}); make keep-numbers before the change", file=sys.stderr
        )
        return 2
    now = _measured(only, kept.kept)
    apart = {name: kept.farthest(before[name], run) for name, run in now.items() if name in before}
    moved = sorted((difference, name, where) for name, (difference, where) in apart.items() if difference > 0.0)
    for difference, name, where in moved:
        print(f"numbers: {name} differs by {difference:.1e} of its size in {where}")
    missing = _missing(before, now, "kept")
    beyond = sum(difference > tolerance for difference, *_ in moved)
    print(f"numbers: {len(moved)} of {len(now)} differ, {beyond} by more than {tolerance:g}")
    return 1 if beyond or missing else 0


def _missing(before: dict[str, Any], now: dict[str, Any], past: str) -> bool:
    """Name what is on one side alone; returns whether there is any."""
    for words, names in (
        (f"is {past} and was not run", before.keys() - now.keys()),
        (f"is not {past}", now.keys() - before.keys()),
    ):
        for name in sorted(names):
            print(f"numbers: {name} {words}")
    return before.keys() != now.keys()


if __name__ == "__main__":
    if any(os.environ.get(name) != value for name, value in SAME_EVERYWHERE.items()):
        os.execve(sys.executable, [sys.executable, "-m", "tools.numbers", *sys.argv[1:]], os.environ | SAME_EVERYWHERE)
    sys.exit(main())
