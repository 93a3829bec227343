"""``python -m tools.hunt_space``: random mechanisms in space against Newton and Euler by numpy and scipy.

--n 200 --seed 1     two hundred cases, the same each time; in both formulations where both can
--case SEED          one case in detail

Exit code 1 if accelerations or reactions of one disagree, or it fails. The report is also in out/hunt_space.json.
"""

from __future__ import annotations

import argparse
import json
import warnings

from mbsd.base.errors import MechanismError
from mbsd.base.files import write_whole
from shared.stage.console import run_cli, say
from shared.stage.paths import out_root
from tools.hunt_space.mechanisms import random_mechanism
from tools.hunt_space.newton_euler import differences

DURATION, OUTPUTS, TOLERANCE = 0.4, 4, 1e-11
WITHIN = {"open": 1e-9, "acceleration": 1e-6, "reaction": 1e-6}
"""Bounds of what is left: differences of the independent implementation have about eight digits."""


def case(seed: int) -> dict[str, object]:
    """Return the differences of a case by formulation, and whether all are within bounds."""
    m, out = random_mechanism(seed), dict[str, object]()
    good = True
    for formulation in ("reference", "tree"):
        try:
            with warnings.catch_warnings(action="ignore"):
                sol = m.simulate(duration=DURATION, steps=OUTPUTS, tolerance=TOLERANCE, formulation=formulation)
            worst = differences(m, sol)
        except MechanismError as error:
            out[formulation], good = str(error), False
            continue
        out[formulation] = worst
        good = good and all(value <= WITHIN[key] for key, value in worst.items())
    return {"case": seed, "name": m.name, "good": good, **out}


def main() -> int:
    """Hunt, report, and say by the exit code whether anything was wrong."""
    parser = argparse.ArgumentParser("tools.hunt_space", description=__doc__)
    parser.add_argument("--n", type=int, default=200)
    parser.add_argument("--seed", type=lambda text: int(text or 1), default=1)
    parser.add_argument("--case", type=int)
    asked = parser.parse_args()
    if asked.case is not None:
        print(json.dumps(case(asked.case), indent=1))
        return 0
    wrong = []
    for k in range(asked.n):
        result = case(1_000_000 * asked.seed + k)
        if not result["good"]:
            wrong.append(result)
            say("hunt_space", f"case {result['case']} ({result['name']}): {result['reference']}, {result['tree']}")
    say("hunt_space", f"{asked.n - len(wrong)} of {asked.n} mechanisms agree")
    out_root().mkdir(parents=True, exist_ok=True)
    write_whole(out_root() / "hunt_space.json", (json.dumps(wrong, indent=1) + "\n").encode())
    return 1 if wrong else 0


if __name__ == "__main__":
    run_cli(main)
