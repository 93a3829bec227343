"""Laws, events and forces of the user that raise or give no number are told with their name and the time."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, Motion, constant_rate, function


def _raises(*given: Any) -> Any:
    raise ZeroDivisionError("no such place")


BAD: dict[str, tuple[Callable[..., Any], str]] = {
    "raises": (_raises, "ZeroDivisionError: no such place"),
    "none": (lambda *given: None, "gives None"),
    "text": (lambda *given: "0.5", "gives '0.5'"),
    "list": (lambda *given: [1.0, 2.0, 3.0, 4.0, 5.0], r"gives (\[1.0, 2.0, 3.0, 4.0, 5.0\]|5 numbers)"),
    "ragged": (lambda *given: [[1.0], [2.0, 3.0]], r"gives (rows of unequal length, )?\[\[1.0\], \[2.0, 3.0\]\]"),
    "true": (lambda *given: True, "gives True"),
    "nan": (lambda *given: math.nan, "gives nan|gives .nan.|1 numbers; 3"),
    "huge": (lambda *given: 10**400, "gives inf|gives .?1000|1 numbers; 3"),
    "complex": (lambda *given: 1j, "gives 1j|fails: TypeError|gives an? "),
}


def _pendulum() -> Mechanism:
    m = Mechanism("swing")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    return m


def _driven(f: Callable) -> Mechanism:
    m = _pendulum()
    m.drive_angle("thing", m.bodies["rod"], f)
    return m


def _loaded(f: Callable) -> Mechanism:
    m = _pendulum()
    m.torque("thing", m.bodies["rod"], f)
    return m


def _sprung(f: Callable) -> Mechanism:
    m = _pendulum()
    m.spring("thing", m.ground.at(0.1, 0.3), m.bodies["rod"].end, f)
    return m


def _pushed(f: Callable) -> Mechanism:
    m = _pendulum()
    m.user_force("thing", f, m.bodies["rod"])
    return m


def _tied(f: Callable) -> Mechanism:
    m = _pendulum()
    m.constraint("thing", m.ground.at(0.1, 0.3), m.bodies["rod"].end, f)
    return m


PLACES: dict[str, tuple[str, Callable[[Callable], Mechanism], Callable[[Mechanism], object]]] = {
    "driver swept": ("driver", _driven, lambda m: m.sweep(1.0)),
    "driver simulated": ("driver", _driven, lambda m: m.simulate(1.0)),
    "driver at rest": ("driver", _driven, lambda m: m.equilibrium(0.25)),
    "driver with derivatives": ("driver", lambda f: _driven(function(math.sin, f, math.cos)), lambda m: m.sweep(1.0)),
    "torque": ("force", _loaded, lambda m: m.simulate(1.0)),
    "torque at rest": ("force", _loaded, lambda m: m.equilibrium()),
    "spring": ("force", _sprung, lambda m: m.simulate(1.0)),
    "user force": ("force", _pushed, lambda m: m.simulate(1.0)),
    "user force at rest": ("force", _pushed, lambda m: m.equilibrium()),
    "constraint": ("joint", _tied, lambda m: m.mobility()),
}


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("place", PLACES)
def test_a_function_that_gives_no_number_is_told_with_its_name_and_the_time(place: str, bad: str) -> None:
    (f, says), (what, build, solve) = BAD[bad], PLACES[place]
    m = build(f)
    at = r"at \[" if place == "constraint" else r"t = [0-9.e-]+ s"  # a constraint knows places, no time
    with pytest.raises(ModelError, match=rf"^swing: {what} 'thing'.*{at}") as told:
        solve(m)
    with pytest.raises(ModelError, match=says):
        raise told.value
    assert isinstance(told.value.__cause__, ZeroDivisionError) == (bad == "raises")


@pytest.mark.parametrize("bad", BAD)
def test_an_event_that_gives_no_number_is_told_with_its_name_and_the_time(bad: str) -> None:
    f, _ = BAD[bad]
    m = _pendulum()
    m.event("thing", lambda t, moment: f() if t > 0.2 else 1.0)
    with pytest.raises(ModelError, match=r"^swing: event 'thing'.*t = 0\.2") as told:
        m.simulate(1.0)
    assert isinstance(told.value.__cause__, ZeroDivisionError) == (bad == "raises")


def test_an_action_that_raises_is_told_with_its_name_and_the_time() -> None:
    m = _pendulum()
    m.event("thing", lambda t, moment: t - 0.25, action=_raises)
    with pytest.raises(ModelError, match=r"^swing: event 'thing': its action fails at t = 0\.25 s: Zero") as told:
        m.simulate(1.0)
    assert isinstance(told.value.__cause__, ZeroDivisionError)
    other = _pendulum()
    other.event("thing", lambda t, moment: t - 0.25, action=lambda moment: moment.release("B"))
    with pytest.raises(ModelError, match=r"^swing: event 'thing': its action fails .*there is no joint to release 'B'"):
        other.simulate(1.0)


def test_an_interrupt_in_a_function_stays_one() -> None:
    def stop(*given: Any) -> float:
        raise KeyboardInterrupt

    for build in (_driven, _loaded, _pushed):
        with pytest.raises(KeyboardInterrupt):
            build(stop).simulate(1.0)


class _Short(Motion):
    def __call__(self, times: np.ndarray) -> np.ndarray:
        return np.zeros((len(times), 2))


class _Raising(Motion):
    def __call__(self, times: np.ndarray) -> np.ndarray:
        raise KeyError("row")


class _Text(Motion):
    def __call__(self, times: np.ndarray) -> np.ndarray:
        return np.full((len(times), 3), "0")  # pyright: ignore[reportReturnType]


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (_Short(), r"its law gives .* of shape \(17, 2\) for 17 times; it must give \(17, 3\)"),
        (_Raising(), "its law fails: KeyError: 'row'"),
        (_Text(), "its law gives .* numbers"),
        (constant_rate(1e60), "turns to 1 × 10⁶⁰ rad"),
    ],
)
def test_a_law_of_the_users_own_class_is_told_with_its_driver(law: Motion, says: str) -> None:
    for solve in (lambda m: m.sweep(1.0), lambda m: m.simulate(1.0)):
        with pytest.raises(ModelError, match=f"^swing: driver 'thing'.*{says}"):
            solve(_driven(law))
