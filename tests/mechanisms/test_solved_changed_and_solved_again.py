"""A mechanism whose number changes after it was solved in every way has the digits of one that was built with it."""

from __future__ import annotations

import functools
import gc
import importlib
import random
import zlib
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from mbsd import Mechanism, MechanismError
from mbsd.base.running import Kept
from mbsd.measures import final, largest
from mbsd.model.mechanism import connections
from mbsd.numbers.names import Number, known_numbers, number_in
from shared.stage.paths import mechanism_names

MASS, INERTIA = 0.3, 2e-4
"""Those of bodies whose parts would have them (kg, kg m^2)."""
COUNT = 2
"""So many numbers of each mechanism change."""


def built(name: str) -> Mechanism:
    module = importlib.import_module(f"mechanisms.{name}.mechanism")
    m = module.build(module.Params())
    for body in list(m.bodies.values())[1:]:
        body.mass, body.inertia = body.mass or MASS, body.inertia or INERTIA
    return m


def numbers(m: Mechanism) -> Iterator[tuple[str, str]]:
    """Things and names of their numbers that can change in place, in a random order that is always the same."""
    things = [*(key for table in connections(m) for key in table), *m.bodies, *m.traces, "gravity"]
    every = [(thing, number) for thing in things for number in dict.fromkeys(known_numbers(m, thing))]
    random.Random(zlib.crc32(m.name.encode())).shuffle(every)
    for thing, name in every:
        try:
            number = number_in(m, thing, name, "the test")
            changed(number, m)
        except MechanismError:  # of a group that must change together
            continue
        if number.built is None:
            yield thing, name


def changed(number: Number, m: Mechanism) -> None:
    number.put(m, 1.003 * number.value if number.value else 1e-3)


def solved(m: Mechanism) -> dict[str, list[np.ndarray] | str]:
    """What each way of solving gives, or why it does not."""
    body = list(m.bodies)[1]
    every = {body: {"mass": [MASS, 1.1 * MASS]}}
    measures = {"last": final(f"{body}.x"), "far": largest(f"{body}.theta")}

    def many() -> list[np.ndarray]:
        runs = m.simulate_many(0.01, vary=every, measure=measures, steps=4)
        return [runs["last"], runs["far"]]

    def at_rest() -> list[np.ndarray]:
        rest = m.equilibrium()
        return [rest.solution.q, rest.solution.lam, rest.stiffness]

    def motion(solve: Callable[[], object]) -> Callable[[], list[np.ndarray]]:
        def arrays() -> list[np.ndarray]:
            sol = solve()
            return [getattr(sol, part) for part in ("t", "q", "v", "a", "lam")]

        return arrays

    ways: dict[str, Callable[[], list[np.ndarray]]] = {
        "sweep": motion(lambda: m.sweep(0.05, steps=3)),
        "simulate": motion(lambda: m.simulate(0.02, steps=3)),
        "independent": motion(lambda: m.simulate(0.02, steps=3, formulation="independent")),
        "equilibrium": at_rest,
        "modes": lambda: [np.array([mode.eigenvalue for mode in m.modes()])],
        "many": many,
    }
    out: dict[str, list[np.ndarray] | str] = {}
    for way, solve in ways.items():
        try:
            out[way] = solve()
        except MechanismError as error:
            out[way] = str(error)
    return out


def forget() -> None:
    """Drop everything that was kept of mechanisms solved before."""
    for thing in gc.get_objects():
        if type(thing) is Kept:
            thing._results.clear()
        elif type(thing) is functools._lru_cache_wrapper and str(thing.__module__).startswith("mbsd"):
            thing.cache_clear()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", mechanism_names())
def test_digits_are_those_of_one_built_so(name: str) -> None:
    tried = 0
    for thing, number in numbers(built(name)):
        m, fresh = built(name), built(name)
        before = solved(m)
        changed(number_in(m, thing, number, "the test"), m)
        changed(number_in(fresh, thing, number, "the test"), fresh)
        again = solved(m)
        forget()
        anew = solved(fresh)
        assert any(not isinstance(value, str) for value in before.values()), before
        for way, wanted in anew.items():
            got = again[way]
            if isinstance(wanted, str) or isinstance(got, str):
                assert got == wanted, (way, thing, number)
            else:
                assert all(map(np.array_equal, got, wanted)), (way, thing, number)
        tried += 1
        if tried == COUNT:
            break
    assert tried == COUNT
