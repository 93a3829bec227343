"""``python -m mbsd compile``: compile all kernels now, so that the first real run does not wait for it."""

from __future__ import annotations

import sys
import time


def main() -> int:
    """Compile by solving a small mechanism that uses every entry point."""
    if sys.argv[1:] != ["compile"]:
        print("usage: python -m mbsd compile", file=sys.stderr)
        return 2
    import dataclasses

    import numpy as np

    from mbsd import Mechanism, constant_rate
    from mbsd.prepared import prepare

    started = time.perf_counter()
    m = Mechanism("compile")
    crank = m.bar("crank", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.sweep(steps=4)
    dataclasses.replace(prepare(m), groups=None).march(
        np.linspace(0.0, 1.0, 4)
    )  # Newton-Raphson, where groups do not serve
    m.trace("P", crank.end)
    m.batch(lengths={"crank": [1.0]}, steps=4)
    m.simulate(0.1, steps=4)
    free = Mechanism("free")
    rod = free.bar("rod", 1.0, mass=1.0)
    free.revolute("A", free.ground.at(0, 0), rod.start)
    free.simulate(0.1, steps=4)  # independent coordinates
    print(f"mbsd: kernels ready in {time.perf_counter() - started:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
