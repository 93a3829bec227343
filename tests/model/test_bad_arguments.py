"""Every argument of every public method, law and cam given something wrong: an error of the package, never a traceback.

The methods that add joints, drivers, forces and contacts are those of the registries, called as their examples call
them, so that a new kind is tried without a word here.
"""

from __future__ import annotations

import inspect
import itertools
import math
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest

from mbsd import (
    Marker,
    Mechanism,
    MechanismError,
    angle_reaches,
    constant_rate,
    curve,
    cycloidal,
    distance_reaches,
    function,
    harmonic,
    polynomial,
    recorded,
    speed_reaches,
    table,
)
from mbsd.cams import Lift, cam_from, flat_cam, oscillating_flat_cam, oscillating_roller_cam, roller_cam
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS
from mbsd.model.mechanism import connections
from tools.models.wrong_values import NEVER, ODD


class _Recorder:
    """Stands for a mechanism and notes the method that an example calls."""

    def __init__(self, m: Mechanism) -> None:
        self._m, self.calls = m, []

    def __getattr__(self, name: str) -> Any:
        member = getattr(self._m, name)
        if not callable(member):
            return member

        def call(*given: Any, **named: Any) -> Any:
            made = member(*given, **named)
            self.calls.append((name, given, named))
            return made

        return call


def _pair() -> tuple[Mechanism, Marker, Marker]:
    m = Mechanism("pair")
    first, second = m.body("first", 1.0, (0.1, -0.2), 0.3), m.body("second", 1.5, (0.3, 0.0), 0.2)
    return m, first.at(0.11, 0.2, 0.3), second.at(-0.4, 0.5, -0.6)


def _extras(m: Any, i: Marker, j: Marker) -> None:
    """Methods that are no kinds."""
    m.body("third", 1.0, (0.0, 0.0), 1.0)
    m.bar("fourth", 1.0, 1.0, (0.5, 0.0), 1.0)
    m.set_mass("third", 1.0, (0.0, 0.0), 1.0)
    m.trace("P", i)
    m.motor("motor", i.body, j.body, curve([0, 1, 2], [3, 2, 0]))
    joint = m.revolute("pin", i, j, limits=(-1.0, 1.0))
    m.stop("stop", joint, -1.0, 1.0, 0.5)
    m.event("event", lambda t, moment: t - 1.0, 1, False, lambda moment: None)
    m.change("pin", limits=(-2.0, 2.0))
    m.known_body("third")


@cache
def _methods() -> dict[str, int]:
    """Methods of the registries and others, with the place of the example that calls each."""
    places: dict[str, int] = {}
    for k, example in enumerate(_examples()):
        m, i, j = _pair()
        recorder = _Recorder(m)
        example(recorder, i, j)
        for name, _, _ in recorder.calls:
            places.setdefault(name, k)
    return places


def _examples() -> list[Callable]:
    kinds = (*KINDS.values(), *FORCE_KINDS.values(), *CONTACT_KINDS.values())
    return [*(kind.example for kind in kinds if kind.example is not None), _extras]


def _call(method: str) -> tuple[Mechanism, dict[str, Any]]:
    """A mechanism right before the example calls ``method``, and the arguments by name."""
    m, i, j = _pair()
    recorder = _Recorder(m)

    class _Reached(Exception):
        pass

    bound: dict[str, Any] = {}

    def stop(*given: Any, **named: Any) -> None:
        arguments = inspect.signature(getattr(m, method)).bind(*given, **named)
        arguments.apply_defaults()
        bound.update(arguments.arguments)
        raise _Reached

    setattr(recorder, method, stop)
    with pytest.raises(_Reached):
        _examples()[_methods()[method]](recorder, i, j)
    return m, bound


def _given(function: Callable, arguments: dict[str, Any]) -> Any:
    """``function`` called with all ``arguments`` by name, variable ones too."""
    positional: list[Any] = []
    named: dict[str, Any] = {}
    several = False
    for p in inspect.signature(function).parameters.values():
        several = several or p.kind is p.VAR_POSITIONAL
    for p in inspect.signature(function).parameters.values():
        value = arguments[p.name]
        if p.kind is p.VAR_POSITIONAL:
            positional += list(value) if isinstance(value, list | tuple) else [value]
        elif p.kind is p.VAR_KEYWORD:
            named |= value if isinstance(value, dict) else {"mass": value}
        elif several:
            positional.append(value)
        else:
            named[p.name] = value
    return function(*positional, **named)


def _takes(parameter: inspect.Parameter, bad: str) -> bool:
    """Return True if the signature allows what is bad elsewhere."""
    words = str(parameter.annotation)
    return (bad in ("text", "empty text") and "str" in words) or (bad == "lambda" and "Callable" in words)


@pytest.mark.parametrize("method", sorted(_methods()))
def test_methods_that_add_take_nothing_that_is_not_what_they_need(method: str) -> None:
    _, valid = _call(method)
    for parameter, (bad, make) in itertools.product(valid, (NEVER | ODD).items()):
        m, arguments = _call(method)
        declared = inspect.signature(getattr(m, method)).parameters[parameter]
        what = f"{method}({parameter}={bad})"
        before = [len(part) for part in (*connections(m), m.bodies, m.traces, m.events)]
        try:
            _given(getattr(m, method), arguments | {parameter: make()})
        except MechanismError as error:
            assert len(str(error)) < 1200, f"{what}: {error}"  # noqa: PT017
            assert m.name in str(error), f"{what}: {error}"  # noqa: PT017
            after = [len(part) for part in (*connections(m), m.bodies, m.traces, m.events)]
            assert after == before, f"{what} left something behind"
            continue
        except Exception as error:
            raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
        assert bad in ODD or _takes(declared, bad), f"{what} is accepted"
        number = str(declared.annotation).split(" ")[0] in ("float", "int")
        assert not (number and bad in ("true", "numpy bool")), f"{what} is accepted"


T9 = np.linspace(0.0, 1.0, 9)
LIFT = Lift.of((math.pi, 0.02, "cycloidal"), (math.pi, 0.0, "3-4-5"))
FUNCTIONS: dict[str, tuple[Callable, dict[str, Any]]] = {
    "constant_rate": (constant_rate, {"rate": 1.0, "start": 0.0}),
    "harmonic": (harmonic, {"amplitude": 1.0, "rate": 2.0, "phase": 0.1, "mean": 0.2}),
    "cycloidal": (cycloidal, {"rise": 1.0, "duration": 2.0, "begin": 0.0, "start": 0.0}),
    "polynomial": (polynomial, {"coefficients": [1.0, 2.0]}),
    "table": (table, {"times": T9, "values": T9, "periodic": False}),
    "recorded": (recorded, {"times": T9, "values": T9, "noise": 0.0}),
    "curve": (curve, {"x": T9, "y": T9, "kind": "smooth"}),
    "function": (function, {"f": math.sin, "df": math.cos, "ddf": lambda t: -math.sin(t), "period": 6.3}),
    "lift": (Lift.table, {"angles": 6 * T9, "heights": 0.01 * np.sin(6 * T9)}),
    "lift of": (Lift.of, {"segments": [(math.pi, 0.02, "3-4-5"), (math.pi, 0.0, "3-4-5")], "start": 0.0}),
    "roller_cam": (roller_cam, {"lift": LIFT, "base_radius": 0.04, "roller_radius": 0.01, "offset": 0.0}),
    "flat_cam": (flat_cam, {"lift": LIFT, "base_radius": 0.04}),
    "oscillating_roller_cam": (
        oscillating_roller_cam,
        {"lift": LIFT, "base_radius": 0.04, "roller_radius": 0.01, "arm": 0.08, "pivot_distance": 0.1},
    ),
    "oscillating_flat_cam": (
        oscillating_flat_cam,
        {"lift": LIFT, "base_radius": 0.04, "pivot_distance": 0.1, "face_offset": 0.0},
    ),
    "cam_from": (cam_from, {"data": flat_cam(LIFT, 0.04).data}),
    "angle_reaches": (angle_reaches, {"body": Mechanism("x").bar("q", 1.0), "angle": 1.0}),
    "speed_reaches": (speed_reaches, {"body": Mechanism("x").bar("q", 1.0), "omega": 1.0}),
    "distance_reaches": (
        distance_reaches,
        {"i": Mechanism("x").ground.origin, "j": Mechanism("x").bar("q", 1.0).end, "length": 1.0},
    ),
    "mechanism": (Mechanism, {"name": "m", "gravity": (0.0, -9.81)}),
    "marker": (Mechanism("x").bar("q", 1.0).at, {"x": 0.0, "y": 0.0, "angle": 0.0}),
}


def _parameters(name: str) -> Iterator[inspect.Parameter]:
    called, valid = FUNCTIONS[name]
    return (p for p in inspect.signature(called).parameters.values() if p.name in valid)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_laws_curves_cams_and_markers_take_nothing_that_is_not_what_they_need(name: str) -> None:
    called, valid = FUNCTIONS[name]
    for parameter, (bad, make) in itertools.product(_parameters(name), (NEVER | ODD).items()):
        what = f"{name}({parameter.name}={bad})"
        arguments = dict.fromkeys(inspect.signature(called).parameters) | valid | {parameter.name: make()}
        arguments = {key: value for key, value in arguments.items() if key in valid}
        try:
            several = parameter.kind is parameter.VAR_POSITIONAL
            _given(called, arguments) if several or name == "lift of" or name == "polynomial" else called(**arguments)
        except MechanismError as error:
            assert len(str(error)) < 1200, f"{what}: {error}"  # noqa: PT017
            continue
        except Exception as error:
            raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
        kinds = {"body": "own kind", "i": "foreign marker", "j": "foreign marker"}
        assert bad in ODD or kinds.get(parameter.name) == bad or _takes(parameter, bad), f"{what} is accepted"


PLAIN = (
    "body",
    "bar",
    "revolute",
    "weld",
    "distance",
    "spring",
    "torsion_spring",
    "torque",
    "force",
    "actuator",
    "gas",
)
"""Methods that can be simulated without compiling equations of their own."""


def _accepted() -> list[tuple[str, str, str]]:
    """Return odd arguments that methods accepted: method, argument, value."""
    out = []
    for method in sorted(_methods()):
        for parameter, bad in itertools.product(_call(method)[1], ODD):
            m, arguments = _call(method)
            try:
                _given(getattr(m, method), arguments | {parameter: ODD[bad]()})
            except MechanismError:
                continue
            out.append((method, parameter, bad))
    return out


@pytest.mark.filterwarnings("ignore")
def test_odd_but_accepted_arguments_can_be_solved_or_are_refused_then() -> None:
    taken = _accepted()
    assert len(taken) > 200
    for k in np.random.default_rng(7).choice(len(taken), 25, replace=False):
        method, parameter, bad = taken[k]
        m, arguments = _call(method)
        _given(getattr(m, method), arguments | {parameter: ODD[bad]()})
        what = f"{method}({parameter}={bad})"
        try:
            m.mobility()
            if method in PLAIN:
                sol = m.simulate(1e-3, steps=1)
                assert np.isfinite(sol.q).all(), what
                assert np.isfinite(sol.lam).all(), what
        except MechanismError:
            continue
        except Exception as error:
            raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
