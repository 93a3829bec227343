"""Whatever is asked of a model or a solution, given something wrong: an error of the package, never a traceback."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

from mbsd import Mechanism, MechanismError, constant_rate, curve
from mbsd.cams import Lift
from tools.models.wrong_values import NEVER, ODD


@cache
def _swing() -> dict[str, Any]:
    """A driven pendulum with a traced point, another that is free, and what they solve to."""
    driven, free = Mechanism("driven"), Mechanism("free")
    for m in (driven, free):
        rod = m.bar("rod", 0.5, mass=1.0)
        m.revolute("A", m.ground.origin, rod.start)
        m.torque("push", rod, 0.1)
        m.trace("P", rod.end)
    driven.drive_angle("motor", driven.bodies["rod"], constant_rate(1.0))
    return {"driven": driven, "free": free, "swept": driven.sweep(steps=4), "run": free.simulate(0.01, steps=2)}


def _draw_of(name: str) -> Callable:
    def draw(**given: Any) -> Any:
        return _swing()[name].draw(**given)

    return draw


CALLS: dict[str, tuple[str, dict[str, Any]]] = {
    "driven.sweep": ("duration steps times", {"duration": 0.1, "steps": 2}),
    "free.simulate": (
        "duration steps times method tolerance step progress event_rows formulation options",
        {"duration": 0.01, "steps": 2},
    ),
    "free.equilibrium": ("time nearest", {}),
    "free.linearise": ("at t inputs", {}),
    "free.mobility": ("", {}),
    "driven.batch": (
        "lengths places angles duration steps threads",
        {"lengths": {"rod": [0.5, 0.6]}, "duration": 0.1, "steps": 2},
    ),
    "driven.inverse_dynamics": ("motion actuators", {"actuators": ["motor"]}),
    "driven.with_efforts": ("motor efforts", {}),
    "driven.change": ("name mass com inertia", {"name": "rod"}),
    "driven.start_near": ("rod", {}),
    "driven.start_moving": ("rod", {}),
    "driven.known_body": ("name", {}),
    "driven.save": ("path", {}),
    "driven.load": ("path", {}),
    "run.at": ("times", {}),
    "run.body": ("name", {}),
    "run.point": ("name", {}),
    "run.joint": ("name", {}),
    "swept.driver": ("name", {}),
    "run.contact": ("name", {}),
    "run.friction": ("name", {}),
    "run.force": ("name", {}),
    "run.draw": ("t step ax frames names", {"t": 0.0}),
    "run.animate": ("path show rate fps size names progress", {"path": "run.gif", "size": (320, 180), "fps": 1.0}),
}
MAY: dict[str, tuple[str, ...]] = {"driven.start_near(rod)": ("three",), "driven.start_moving(rod)": ("three",)}


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("call", CALLS)
def test_requests_of_models_and_solutions_take_no_wrong_types(
    call: str, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    of, name = call.split(".")
    parameters, valid = CALLS[call]
    for parameter, (bad, make) in itertools.product(parameters.split(), (NEVER | ODD).items()):
        what, target = f"{call}({parameter}={bad})", _swing()[of]
        if (parameter, bad) == ("progress", "lambda"):
            continue  # what it raises ends the run as it is
        before = {part: dict(getattr(target, part)) for part in ("starts", "velocities")} if of == "driven" else {}
        arguments = valid | ({"motion": _swing()["swept"]} if name == "inverse_dynamics" else {}) | {parameter: make()}
        try:
            getattr(target, name)(**arguments)
        except MechanismError as error:
            assert len(str(error)) < 1200, f"{what}: {error}"  # noqa: PT017
            continue
        except Exception as error:
            raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
        finally:
            for part, values in before.items():
                setattr(target, part, values)
        assert bad in ODD or bad in MAY.get(f"{call}({parameter})", ()) or (bad, name) == ("text", "save"), (
            f"{what} is accepted"
        )


def test_misspelt_names_come_with_what_was_meant() -> None:
    swing = _swing()
    rod = swing["free"].bodies["rod"]
    for call, meant in [
        (lambda: swing["free"].known_body("rodd"), "rod"),
        (lambda: swing["run"].body("Rod"), "rod"),
        (lambda: swing["swept"].driver("moter"), "motor"),
        (lambda: swing["free"].simulate(0.1, method="dop583"), "dop853"),
        (lambda: swing["free"].simulate(0.1, formulation="independant"), "independent"),
        (lambda: swing["free"].simulate(0.1, method="radau", rhoo=1.0), None),
        (lambda: swing["free"].linearise("equilibirum"), "equilibrium"),
        (lambda: swing["free"].linearise(inputs=["psh"]), "push"),
        (lambda: swing["free"].change("rodd", mass=1.0), "rod"),
        (lambda: swing["free"].change("rod", maas=1.0), "mass"),
        (lambda: swing["free"].with_efforts(pusch=1.0), "push"),
        (lambda: swing["free"].spring("s", rod.start, rod.end, stifness=1.0), "stiffness"),
        (lambda: swing["free"].friction("f", "B", 0.1), None),
        (lambda: curve([0, 1], [0, 1], "linaer"), "linear"),
        (lambda: Lift.of((math.pi, 0.02, "cyclodial"), (math.pi, 0.0, "3-4-5")), "cycloidal"),
    ]:
        with pytest.raises(MechanismError, match=f"did you mean '{meant}'" if meant else "there is no"):
            call()


@pytest.mark.parametrize(
    ("solve", "says"),
    [
        (
            lambda s: s["driven"].sweep(1.0, steps=10**12),
            r"driven: results at 1e\+12 times need about .* GB, this machine",
        ),
        (lambda s: s["free"].simulate(1.0, steps=10**12), r"free: results at 1e\+12 times need about .* GB"),
        (lambda s: s["driven"].sweep(times=range(10**10)), r"driven: results at 1e\+10 times need about"),
        (lambda s: s["free"].simulate(times=range(10**10)), r"free: results at 1e\+10 times need about"),
        (lambda s: s["driven"].batch({"rod": [0.5]}, duration=1.0, steps=10**12), "need about"),
        (lambda s: s["driven"].sweep(1e300), "duration .*1e[+]300"),
        (lambda s: s["free"].simulate(1e80), r"duration is 1e\+80 s; it must be within"),
        (lambda s: s["free"].simulate(1e-80), "duration is 1e-80 s; it must be within"),
        (lambda s: s["free"].simulate(1.0, tolerance=1e-99), "tolerance is 1e-99"),
        (lambda s: s["free"].simulate(1.0, method="rk4", step=1e-99), "step is 1e-99 s"),
        (lambda s: s["driven"].sweep(times=[0.0, 1.0, 0.5]), r"times\[2\] = 0.5 s does not come after 1 s"),
        (lambda s: s["driven"].sweep(times=[0.0, "1.0"]), r"times\[1\] is '1.0'; it must be a number"),
        (lambda s: s["driven"].sweep(1e17), "turns to 1 × 10¹⁷ rad"),
    ],
)
def test_extreme_numbers_end_in_a_sentence(solve: Callable, says: str) -> None:
    with pytest.raises(MechanismError, match=says):
        solve(_swing())
