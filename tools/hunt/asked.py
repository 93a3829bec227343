"""What a hunt is asked for on the command line, by all hunts alike."""

from __future__ import annotations

import argparse
import math
import os

from shared.stage.errors import UserError
from tools.hunt.pool import LIMIT


def parser(program: str, about: str | None, limit: float = LIMIT) -> argparse.ArgumentParser:
    """--n, --seed, --jobs, --kind, --limit and --case; ``limit``: seconds of one case if nothing is said."""
    made = argparse.ArgumentParser(
        prog=f"python -m {program}", description=about, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    made.add_argument("--n", type=_positive, default=1000)
    made.add_argument("--seed", type=int, default=1)
    made.add_argument("--jobs", type=_positive, default=os.cpu_count() or 1)
    made.add_argument("--kind")
    made.add_argument("--limit", type=float, default=limit, help="seconds of one case")
    made.add_argument("--case", type=int)
    return made


def refuse_unknown(kind: str | None) -> None:
    """Raise UserError for a kind of mechanism that there is not; None means all."""
    from tools.hunt.families import all_families

    if kind is None:
        return
    names = list(all_families())
    if kind not in names:
        raise UserError(f"there is no kind of mechanism '{kind}'; there is: {', '.join(names)}")


def _positive(text: str) -> int:
    number = int(text)
    if not 0 < number < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return number
