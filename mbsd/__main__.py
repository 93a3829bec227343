"""The program ``mbsd``, also ``python -m mbsd``: ``mbsd run excavator``, and what ``--help`` lists.

``mbsd compile`` compiles all kernels now, so that the first real run does not wait for it. Each part of that solves a
small mechanism that uses some entry points, in a process of its own: as many at a time as there are cores. What two
parts share is compiled by whoever comes first. Kernels that they might call are compiled, too.
"""

from __future__ import annotations

import logging
import os
import runpy
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mbsd import Mechanism

OLDEST = (3, 12)
"""The first Python of the rooms beside the solver."""
STUDIO = "studio.command.__main__"
"""The program beside the solver, where its rooms are there."""


def _driven() -> Mechanism:
    from mbsd import Mechanism, constant_rate

    m = Mechanism("compile")
    crank = m.bar("crank", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(1.0))
    return m


def _reference() -> None:
    """Simulations in reference coordinates."""
    _driven().simulate(0.1, steps=4)


def _independent() -> None:
    """Simulations in independent coordinates."""
    from mbsd import Mechanism

    free = Mechanism("free")
    rod = free.bar("rod", 1.0, mass=1.0)
    free.revolute("A", free.ground.at(0, 0), rod.start)
    free.simulate(0.1, steps=4)


def _newton() -> None:
    """Sweeps by Newton-Raphson, where closed forms do not serve."""
    import dataclasses

    import numpy as np

    from mbsd import Mechanism, constant_rate
    from mbsd.kinematics.march import march_along
    from mbsd.kinematics.prepared import prepare

    m = Mechanism("slide")
    slider = m.body("slider")
    m.prismatic("A", m.ground.at(0, 0), slider.origin)
    m.drive_coordinate("feed", m.ground.at(0, 0), slider.origin, constant_rate(1.0))
    march_along(dataclasses.replace(prepare(m), groups=None), np.linspace(0.0, 1.0, 4))


def _parts() -> None:
    """Sweeps in closed form with parts by Newton-Raphson between."""
    m = _driven()
    wheel = m.body("wheel")
    m.revolute("B", m.ground.at(1.0, 0.0), wheel.origin)
    m.geneva("index", m.bodies["crank"].start, wheel.origin, 4, 0.5**0.5)
    m.start_near(crank=180.0, wheel=45.0)
    m.sweep(0.1, steps=4)


def _closed() -> None:
    """Sweeps in closed form, and batches of designs."""
    m = _driven()
    m.sweep(steps=4)
    m.trace("P", m.bodies["crank"].at(1.0, 0.0))
    m.batch(lengths={"crank": [1.0]}, steps=4)


def _surfaces() -> None:
    """Friction of joints, contact with a surface and a point on a curve."""
    from mbsd import Mechanism, curve

    hill = curve([-2.0, 0.0, 2.0], [1.0, 0.0, 1.0])
    m = Mechanism("rolling")
    wheel = m.body("wheel", mass=1.0, inertia=1.0)
    m.contact("tread", m.ground.origin, wheel.origin, 1e5, radius=0.1, profile=hill)
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", wheel.origin, rod.start)
    m.friction("dry", "A", 0.1, radius=0.1)
    m.start_near(wheel=(0.0, 0.2, 0.0), rod=0.0)
    m.simulate(0.01, steps=4)


def _events() -> None:
    """Contacts, stops, friction that sticks, and all integrators behind one name."""
    from mbsd import Mechanism

    m = Mechanism("ball")
    ball, rod = m.body("ball", mass=0.2, inertia=1e-5), m.bar("rod", 1.0, mass=1.0)
    m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.01, friction=0.3)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.friction("dry", "A", 0.1, radius=0.1, sticks=True)
    m.start_near(ball=(0.0, 0.02, 0.0), rod=0.0)
    m.simulate(0.1, steps=4)


PARTS: dict[str, Callable[[], None]] = {
    "events": _events,
    "reference": _reference,
    "newton": _newton,
    "independent": _independent,
    "parts": _parts,
    "closed": _closed,
    "surfaces": _surfaces,
}
"""Kernels by name, longest first; but the first two, which begin together, share little."""


def main() -> int:
    """Compile all parts, which returns 1 where one of them failed; all other commands are the program's."""
    match sys.argv[1:]:
        case ["compile"]:
            started = time.perf_counter()
            print(
                "mbsd: compiling the solver for this machine: about 80 s on two idle cores, and once only", flush=True
            )
            if not _all_at_once(os.cpu_count() or 1):
                print("mbsd: error: kernels could not be compiled; the reason stands above", file=sys.stderr)
                return 1
            print(f"mbsd: kernels ready in {time.perf_counter() - started:.1f} s")
        case ["compile", part] if part in PARTS:
            from mbsd.compiling.lazy_kernel import compile_all

            logging.getLogger("mbsd").setLevel(logging.ERROR)  # one word for all parts is enough
            PARTS[part]()
            compile_all()
        case _:
            return _studio()
    return 0


def _studio() -> int:
    """Run the program in this process; 2 where its rooms or packages are not installed."""
    rooms = Path(__file__).parent / "rooms"
    if not rooms.is_dir():
        rooms = Path(__file__).parent.parent  # a clone
    if (rooms / "studio" / "command").is_dir():
        if sys.version_info < OLDEST:
            print(
                f"mbsd: error: the solver runs on Python {sys.version_info[0]}.{sys.version_info[1]}, the program mbsd "
                "needs Python 3.12 or later, and 3.13 for pictures and films: uv tool install --python 3.13 "
                "'mbsd[studio]'",
                file=sys.stderr,
            )
            return 2
        if find_spec("msgspec") is None:
            print("mbsd: error: this needs more packages: pip install 'mbsd[studio]'", file=sys.stderr)
            return 2
        sys.path.insert(0, str(rooms))
        os.environ.setdefault("MBSD_FACE", "mbsd")
        runpy.run_module(STUDIO, run_name="__main__", alter_sys=True)
        return 0
    print(
        "usage: mbsd compile\nthe solver alone is installed; pip install 'mbsd[studio]' brings all else",
        file=sys.stderr,
    )
    return 2


def _all_at_once(cores: int) -> bool:
    """Compile the parts in up to ``cores`` processes; True if all are ready."""
    waiting, running, good = list(PARTS), [], True
    try:
        while waiting or running:
            while waiting and len(running) < cores:
                running.append(subprocess.Popen([sys.executable, "-m", "mbsd", "compile", waiting.pop(0)]))
            ended = [process for process in running if process.poll() is not None]
            good = good and all(process.returncode == 0 for process in ended)
            running = [process for process in running if process not in ended]
            time.sleep(0.05)
    finally:
        for process in running:
            process.kill()
            process.wait()
    return good


if __name__ == "__main__":
    sys.exit(main())
