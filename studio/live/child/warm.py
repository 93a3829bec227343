"""Code that the warm process loads before any author's: solver with kernels, stages, payload.

Importing it does the work; children are forked from the process that has, and run ``serve``.
"""

from __future__ import annotations

import math
import os

# One thread: a child is forked from here, and small matrices gain nothing from more.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import scipy.optimize  # noqa: E402, F401  (a fit needs it, and it takes long)

import mechanisms.stages.loading.inputs  # noqa: E402
import mechanisms.stages.solve.masses  # noqa: E402
import mechanisms.stages.solve.solving  # noqa: E402, F401
from mbsd import Mechanism, constant_rate, fit_path  # noqa: E402
from mechanisms.stages.solve.masses import give_masses  # noqa: E402
from render.view.document import encode  # noqa: E402
from studio.live.child.author import Shown  # noqa: E402
from studio.live.child.main import main as serve  # noqa: E402, F401  (runs in each process that is forked)


def _driven() -> Mechanism:
    m = Mechanism("warm")
    crank, coupler, rocker = m.bar("crank", 0.1), m.bar("coupler", 0.3), m.bar("rocker", 0.25)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.3, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(math.tau))
    m.trace("P", coupler.at(0.1, 0.1))
    m.start_near(crank=0, coupler=45, rocker=100)
    return m


def _free() -> Mechanism:
    m = Mechanism("warm")
    m.revolute("A", m.ground.at(0, 0), m.bar("rod", 0.3, mass=1.0).start)
    m.start_near(rod=30)
    return m


def _warm() -> None:
    """Load everything that the first sweep, simulation and fit need."""
    driven = _driven()
    give_masses(driven, None)
    encode(Shown().payload(driven.sweep(), None, {}, None, False), compress=False)
    fit_path(driven, [(0.1, 0.2), (0.2, 0.2)], {"crank": (0.05, 0.12)}, starts=1, generations=1)
    encode(Shown().payload(_free().simulate(0.2, event_rows=True), None, {}, None, False), compress=False)


_warm()
