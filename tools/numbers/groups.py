"""Runs of every closed form of kinematics/groups/kinds in its three uses, by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.kinematics.design_sweeps import DesignSweeps, Moved, in_closed_form
from mbsd.kinematics.prepared import prepare
from tools.models.assur_models import MODELS

INTERVAL = 0.3
"""s"""


def runs() -> Iterator[tuple[str, Callable[[], Any]]]:
    """All, by name."""
    for name, make in MODELS.items():
        yield f"group {name}, driven", partial(_driven, make)
        yield f"group {name}, free", partial(_free, make)
        yield f"group {name}, hung on", partial(_hung_on, make)
        yield f"group {name}, designs", partial(_designs, make)


def _driven(make: Callable[[], Mechanism]) -> Any:
    return make().sweep(INTERVAL, steps=30)


def _free(make: Callable[[], Mechanism]) -> Any:
    m = make()
    m.drivers.clear()
    m.gravity = (0.5, -9.81)
    return m.simulate(INTERVAL, steps=12)


def _hung_on(make: Callable[[], Mechanism]) -> Any:
    """With its drivers, and a pendulum on its last body."""
    m = make()
    m.gravity = (0.5, -9.81)
    last = list(m.bodies.values())[-1]
    bob = m.bar("bob", 0.2, 0.5)
    m.revolute("hang", last.at(0.05, 0.02), bob.start)
    m.start_near(bob=-60)
    return m.simulate(INTERVAL, steps=12)


def _designs(make: Callable[[], Mechanism]) -> Any:
    """A few, in which one marker is elsewhere."""
    m = make()
    ready = prepare(m, 0.0, INTERVAL)
    if not in_closed_form(ready):
        return None
    sweeps = DesignSweeps(m, ready, np.linspace(0.0, INTERVAL, 20), [Moved(markers=[(1, 0)])], [*m.bodies])
    made = sweeps(np.linspace(-1e-3, 1e-3, 3)[:, None], threads=1)
    return [made.angles[name] for name in m.bodies], made.closes
