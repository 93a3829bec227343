"""``python -m tools.numbers check [TEXT]`` or ``record``: see the package.

Python's, numpy's and the C library's functions and BLAS choose their code by the processor, which changes last digits.
So this starts itself anew with what every x86-64 has: BLAS and numpy without AVX, the C library without FMA.
"""

from __future__ import annotations

import os
import sys
import time
import warnings
from pathlib import Path

FILE = Path(__file__).parent / "recorded.txt"
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
    match sys.argv[1:]:
        case ["check", *only] if len(only) <= 1:
            return _check(only[0] if only else "")
        case ["record"]:
            FILE.write_text("".join(f"{name}: {value}\n" for name, value in sorted(_found("").items())))
            return 0
    print("usage: python -m tools.numbers check [TEXT] | record", file=sys.stderr)
    return 2


def _found(only: str) -> dict[str, str]:
    from tools.numbers import blocks, gallery, groups, runs
    from tools.numbers.digest import attempt
    from tools.numbers.published import published

    found, started = {}, time.perf_counter()
    for source in (runs, groups, blocks, gallery):
        for name, run in source.runs():
            if only in name:
                with warnings.catch_warnings(action="ignore"):
                    found[name] = attempt(run)
    if not only or any(name.startswith("published") and only in name for name in _recorded()):
        found.update((name, value) for name, value in published(only) if only in name)
    print(f"numbers: {len(found)} runs in {time.perf_counter() - started:.0f} s")
    return found


def _recorded() -> dict[str, str]:
    return dict(line.rsplit(": ", 1) for line in FILE.read_text().splitlines()) if FILE.exists() else {}


def _check(only: str) -> int:
    recorded = {name: value for name, value in _recorded().items() if only in name}
    found = _found(only)
    differ = [name for name, value in found.items() if recorded.get(name, value) != value]
    for words, names in (
        ("differs", differ),
        ("is recorded and was not run", sorted(recorded.keys() - found.keys())),
        ("is not recorded", sorted(found.keys() - recorded.keys())),
    ):
        for name in names:
            print(f"numbers: {name} {words}")
    print(f"numbers: {len(differ)} of {len(found)} differ")
    return 1 if differ or recorded.keys() != found.keys() else 0


if __name__ == "__main__":
    if any(os.environ.get(name) != value for name, value in SAME_EVERYWHERE.items()):
        os.execve(sys.executable, [sys.executable, "-m", "tools.numbers", *sys.argv[1:]], os.environ | SAME_EVERYWHERE)
    sys.exit(main())
