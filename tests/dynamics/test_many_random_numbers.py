"""Any numbers of random machines vary at once: motions of single simulations, and their reasons."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.simulate_many import Simulations
from mbsd.measures import final, samples
from mbsd.model.mechanism import connections
from mbsd.numbers.names import Number, known_numbers, number_in, with_values
from tools.models import assur_models, linkages
from tools.models.random_linkages import linkage
from tools.models.random_rough import five_bar_with_stops

pytestmark = pytest.mark.slow

TIMES = [0.1, 0.2]
AWAY, FEW = (1.0, 1.0007, 0.9991), 1e-4
"""Parts of numbers, and what stands for those that are zero."""
PREPARED, MET = 1e-12, 3e-6
"""How far motions may differ, beside 1: arrays are the same; at events impulses are solved by another elimination."""
DRIVEN = [assur_models.four_bar, assur_models.slotted_rod, linkages.watt, linkages.slider_crank, linkages.crank_shaper]


def machine(seed: int) -> tuple[Mechanism, float]:
    """One of three sorts, and how far motions may differ."""
    draw = random.Random(seed)
    if seed % 3 == 0:
        return five_bar_with_stops(draw)[0], MET
    return linkage(seed, 1 + seed % 2, damping=True).m if seed % 3 == 1 else draw.choice(DRIVEN)(), PREPARED


def numbers_of(m: Mechanism, seed: int) -> list[tuple[str, str, Number]]:
    """Some numbers of it, of several things, each under one of its names."""
    things = dict.fromkeys([*(name for table in connections(m) for name in table), *m.bodies, *m.traces, "gravity"])
    known = [(whole, key) for whole in things for key in known_numbers(m, whole) if "start" not in key]
    random.Random(seed).shuffle(known)
    out: list[tuple[str, str, Number]] = []
    for whole, key in known:
        if all(whole != other for other, _, _ in out) and len(out) < 3:
            out.append((whole, key, number_in(m, whole, key, "test")))
    return out


@given(seed=st.integers(0, 10**6))
@settings(max_examples=40, deadline=None)
def test_numbers_of_random_machines_have_the_motions_of_single_simulations(seed: int) -> None:
    m, allowed = machine(seed)
    body, varied = list(m.bodies)[-1], numbers_of(m, seed)
    columns = [
        [number.value * part if number.value else FEW * (part - 1.0) for part in AWAY] for _, _, number in varied
    ]
    vary: dict[str, dict[str, list[float]]] = {}
    for (whole, key, _), column in zip(varied, columns, strict=True):
        vary.setdefault(whole, {})[key] = column
    measure = {
        "x": samples(f"{body}.x", TIMES),
        "angle": samples(f"{body}.theta", TIMES),
        "omega": final(f"{body}.omega"),
    }
    many = m.simulate_many(TIMES[-1], vary=vary, measure=measure, steps=20, threads=1)
    for k, row in enumerate(zip(*columns, strict=True)):
        assert_row(many, k, partial(with_values, m, [number for _, _, number in varied], row), body, allowed)


def assert_row(many: Simulations, k: int, alone: Callable[[], Mechanism], body: str, allowed: float) -> None:
    """Raise AssertionError unless row ``k`` has the motion of ``body`` in a single one, or its reason."""
    try:
        sol = alone().simulate(TIMES[-1], steps=20)
    except MechanismError as error:
        assert str(error).partition(". ")[0] in str(many.reason[k])  # noqa: PT017
        return
    assert many.reason[k] is None
    motion = sol.body(body)
    mine = np.array([*many["x"][k], *many["angle"][k], many["omega"][k]])
    single = np.array([*motion.x[[10, 20]], *motion.theta[[10, 20]], motion.omega[-1]])
    np.testing.assert_allclose(mine, single, rtol=0.0, atol=allowed * max(1.0, float(np.abs(single).max())))
