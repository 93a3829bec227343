"""Places, numbers of laws and others in many simulations: the digits of mechanisms that are built with them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, cycloidal, harmonic, polynomial
from mbsd.measures import final, largest, samples
from mbsd.model.body import Marker
from mbsd.numbers.names import number_named, with_values
from tests.dynamics.many_models import STEPS
from tools.models.stops import barrier

PLACES = np.array([[0.4, 0.02], [0.41, 0.0], [0.38, 0.05]])


def press(
    pivot: tuple[float, float] = (0.0, 0.0),
    end: float = 0.05,
    point: float = 0.1,
    amplitude: float = 0.6,
    rate: float = 9.0,
    torque: float = 0.4,
    gravity: float = -9.80665,
    com: float = 0.075,
    start: float = 0.3,
) -> Mechanism:
    """A slider-crank whose crank swings by a law, with a pendulum on its rod that a torque turns."""
    m = Mechanism("press", gravity=(0.0, gravity))
    crank, rod, slider = (
        m.bar("crank", 0.05, mass=0.2),
        m.bar("rod", 0.15, 0.3, (com, 0.0), 1e-3),
        m.body("slider", 0.5),
    )
    hand = m.bar("hand", 0.08, mass=0.1)
    m.revolute("O", m.ground.at(*pivot), crank.start)
    m.revolute("A", crank.at(end, 0.0), rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.revolute("H", rod.at(0.1, 0.0), hand.start)
    m.torque("twist", hand, harmonic(torque, 5.0), rod)
    m.drive_angle("motor", crank, harmonic(amplitude, rate, 0.2))
    m.trace("P", rod.at(point, 0.02))
    m.start_near(crank=10, rod=0, hand=math.degrees(start))
    return m


@pytest.mark.parametrize(
    ("vary", "built"),
    [
        ({"O": {"x": [0.0, 1e-3, -2e-3], "y": [0.0, 2e-3, 1e-3]}}, lambda x, y: press(pivot=(x, y))),
        ({"crank": {"A.x": [0.05, 0.049, 0.052]}}, lambda x: press(end=x)),
        ({"A": {"i.x": [0.05, 0.049, 0.052]}}, lambda x: press(end=x)),
        ({"P": {"x": [0.1, 0.05, 0.12]}}, lambda x: press(point=x)),
        (
            {"motor": {"amplitude": [0.6, 0.5, 0.4], "rate": [9.0, 8.0, 10.0]}},
            lambda a, r: press(amplitude=a, rate=r),
        ),
        ({"twist": {"amplitude": [0.4, -0.4, 0.2]}}, lambda a: press(torque=a)),
        ({"gravity": {"y": [-9.80665, 0.0, 3.0]}}, lambda g: press(gravity=g)),
        ({"rod": {"com.x": [0.075, 0.07, 0.08]}}, lambda c: press(com=c)),
        ({"hand": {"start.angle": [0.3, -1.0, 2.0]}}, lambda s: press(start=s)),
    ],
)
def test_any_number_has_the_digits_of_a_mechanism_built_with_it(vary: Any, built: Callable[..., Mechanism]) -> None:
    measures = {
        "x": final("P.x"),
        "f": largest("B.fy"),
        "w": samples("hand.omega", [0.2, 0.4]),
        "e": final("motor.effort"),
    }
    many = press().simulate_many(0.4, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * 3
    assert many.good.all()
    columns = [column for values in vary.values() for column in values.values()]
    for k, numbers in enumerate(zip(*columns, strict=True)):
        sol = built(*numbers).simulate(0.4, steps=STEPS)
        np.testing.assert_allclose(many["x"][k], sol.point("P").x[-1], rtol=0, atol=1e-14)
        np.testing.assert_allclose(many["w"][k], sol.body("hand").omega[[10, 20]], rtol=1e-13)
        np.testing.assert_allclose(many["f"][k], sol.joint("B").fy.max(), rtol=1e-12)
        np.testing.assert_allclose(many["e"][k], sol.driver("motor").effort[-1], rtol=1e-12)


@pytest.mark.parametrize(
    ("law", "vary", "at_once"),
    [
        (harmonic(0.5, 9.0, 0.1), {"amplitude": [0.5, 0.2, 0.7], "phase": [0.1, 0.0, 3.0]}, True),
        (polynomial(0.1, 0.5), {"coefficients.1": [0.5, -0.2, 0.0]}, True),
        (cycloidal(0.4, 0.2, 0.05), {"rise": [0.4, -0.3, 0.1]}, True),
        (cycloidal(0.4, 0.2, 0.05), {"duration": [0.2, 0.1, 0.05]}, False),
    ],
)
@pytest.mark.parametrize("formulation", ["auto", "reference"])
def test_numbers_of_a_force_s_law_are_put_in_place_where_steps_end_as_before(
    law: Any, vary: dict[str, list[float]], at_once: bool, formulation: str
) -> None:
    def pushed() -> Mechanism:
        m = barrier()
        m.torque("push", m.bodies["rocker"], law)
        return m

    measure = {"x": final("rocker.theta"), "f": final("D.fx")}
    many = pushed().simulate_many(0.3, vary={"push": vary}, measure=measure, steps=STEPS, formulation=formulation)
    assert many.alone == [None] * 3
    assert ("prepared" in many.way) != at_once
    for k in range(3):
        m = pushed()
        numbers = [number_named(m, f"push.{key}") for key in vary]
        sol = with_values(m, numbers, [values[k] for values in vary.values()]).simulate(
            0.3, steps=STEPS, formulation=formulation
        )
        assert many["x"][k] == sol.body("rocker").theta[-1]
        np.testing.assert_allclose(many["f"][k], sol.joint("D").fx[-1], rtol=1e-12)


def test_two_numbers_of_one_law_change_together() -> None:
    m = press()
    numbers = [number_named(m, f"motor.{key}") for key in ("amplitude", "rate")]
    assert with_values(m, numbers, [0.5, 8.0]).drivers["motor"].motion == harmonic(0.5, 8.0, 0.2)


def test_places_beside_stops_and_lengths_are_those_of_a_mechanism_built_with_them() -> None:
    """The start is closed anew for each; limits of angles are counted from there."""
    lengths, vary = [0.38, 0.37, 0.39], {"D": {"x": PLACES[:, 0], "y": PLACES[:, 1]}}
    vary["coupler"] = {"length": lengths}  # type: ignore[assignment]
    vary["rocker"] = {"mass": [2.0, 2.1, 1.9]}  # type: ignore[assignment]
    many = barrier(stops=True).simulate_many(0.5, vary=vary, measure={"x": final("rocker.theta")}, steps=STEPS)
    assert many.alone == [None] * 3
    for k, (x, y) in enumerate(PLACES):
        m = barrier(stops=True)
        placed(m, "D", x, y)
        m.change("coupler", length=lengths[k])
        m.change("rocker", mass=(2.0, 2.1, 1.9)[k])
        sol = m.simulate(0.5, steps=STEPS)
        assert len(sol.events) > 0
        np.testing.assert_allclose(many["x"][k], sol.body("rocker").theta[-1], atol=1e-9)


def placed(m: Mechanism, name: str, x: float, y: float) -> None:
    """Put a joint's place on ground elsewhere, as built there."""
    object.__setattr__(m.joints[name], "i", Marker(m.ground, x, y, 0.0))


def test_rows_do_not_depend_on_those_before_them() -> None:
    """A longer bar takes along what is at its end, and only that."""

    def with_point() -> Mechanism:
        m = barrier()
        m.trace("Q", m.bodies["coupler"].at(0.39, 0.0))
        return m

    vary, measure = {"coupler": {"length": [0.38, 0.39, 0.385]}, "C": {"y": [0.0, 1e-3, 0.0]}}, {"x": final("Q.x")}
    many = with_point().simulate_many(0.1, vary=vary, measure=measure, steps=4)
    last = {name: {key: values[-1:] for key, values in own.items()} for name, own in vary.items()}
    assert with_point().simulate_many(0.1, vary=last, measure=measure, steps=4)["x"][0] == many["x"][2]


def test_numbers_that_a_row_refuses_are_its_reason() -> None:
    m = Mechanism("lift", gravity=None)
    arm = m.bar("arm", 0.2, mass=1.0)
    m.revolute("pivot", m.ground.at(0, 0), arm.start)
    m.torque("motor", arm, cycloidal(0.5, 0.2))
    many = m.simulate_many(0.3, vary={"motor": {"duration": [0.2, -0.1, 0.1]}}, measure={"x": final("arm.theta")})
    assert many.good.tolist() == [True, False, True]
    assert "duration is -0.1 s; it must be positive" in str(many.reason[1])
    many = press().simulate_many(0.1, vary={"O": {"y": [0.0, 0.5]}}, measure={"x": final("P.x")}, steps=4)
    assert many.good.tolist() == [True, False]
    assert "AssemblyError" in str(many.reason[1])


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"vary": {"O": {"z": [1.0]}}}, "vary: 'O': there is no number 'z'; there is: x, y, angle"),
        ({"vary": {"O.x": [1.0]}}, r"give its numbers and their values: \{'O': \{'x': \[...\]\}\}"),
        ({"vary": {"O": {"x": [math.inf]}}}, "must be finite"),
        ({"vary": {"O": {"x": [[0.0, 1.0]]}}}, "x of 'O' is a single number"),
        ({"vary": {"O": {"x": [0.0, 1.0], "y": [0.0, 1.0, 2.0]}}}, "y of 'O' has 3 values|equally long"),
        ({"vary": {"motor": {"law": [1.0, 2.0]}}}, r"is a law and no number; .* \{'motor': \{'amplitude': \[...\]\}\}"),
        ({"vary": {"motor": {"rat": [1.0]}}}, "did you mean 'rate'"),
        ({"vary": {"rod": {"com": [[0.1, 0.0]], "com.x": [0.1]}}}, "'com.x' is a part of 'com'"),
        ({"vary": {"O": {"x": [0.1], "i.x": [0.1]}}}, "'O.x' and 'O.i.x' are the same number"),
        ({"vary": {"crank": {"start.angle": [0.1]}}}, "driver 'motor' says where 'crank' is"),
        ({"vary": {"hand": {"start.angle": [0.1]}}, "start": {"hand": [5.0]}}, "also given by start="),
        ({"vary": {"hand": {"moving.omega": [0.1]}}}, "no such number before start_moving gives it"),
        ({"vary": {"ground": {"x": [0.1]}}}, "there is no number 'x'"),
    ],
)
def test_what_cannot_vary_is_refused(asked: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        press().simulate_many(0.1, measure={"x": final("P.x")}, **asked)


def crowded(order: tuple[int, ...]) -> Mechanism:
    """Return a pendulum under forces of several terms, two of which share a law."""
    m = Mechanism("crowded")
    rod, tip = m.bar("rod", 0.4, mass=1.0), m.body("tip", 0.3, inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.revolute("B", rod.end, tip.origin)
    law = harmonic(0.3, 4.0)
    add: list[Callable[[], object]] = [
        lambda: m.torsion_spring("k", m.ground, rod, stiffness=1.0, damping=0.1, free_angle=0.2),
        lambda: m.spring("s", m.ground.at(0.3, 0.3), rod.end, 20.0, damping=0.5, free_length=0.2),
        lambda: m.torque("first", rod, law),
        lambda: m.torque("second", tip, law, rod),
        lambda: m.spring("t", m.ground.at(-0.3, 0.1), tip.at(0.02, 0.0), 5.0, free_length=0.3),
    ]
    for k in order:
        add[k]()
    m.start_near(rod=-40)
    return m


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (3, 0, 4, 1, 2)])
@pytest.mark.parametrize(
    "vary",
    [
        {"s": {"stiffness": [20.0, 25.0, 15.0], "damping": [0.5, 0.1, 0.9]}},
        {"t": {"free_length": [0.3, 0.25, 0.35]}},
        {"second": {"amplitude": [0.3, 0.1, -0.2]}},
        {
            "first": {"phase": [0.0, 1.0, 2.0]},
            "second": {"amplitude": [0.3, 0.5, 0.1]},
            "k": {"damping": [0.1, 0.2, 0.3]},
        },
    ],
)
def test_numbers_of_one_force_among_many_are_put_in_its_own_place(vary: Any, order: tuple[int, ...]) -> None:
    m = crowded(order)
    many = m.simulate_many(0.3, vary=vary, measure={"r": final("rod.theta"), "t": final("tip.theta")}, steps=STEPS)
    assert "prepared" not in many.way
    names = [f"{whole}.{key}" for whole, values in vary.items() for key in values]
    columns = [column for values in vary.values() for column in values.values()]
    for k in range(3):
        sol = with_values(m, [number_named(m, name) for name in names], [c[k] for c in columns]).simulate(
            0.3, steps=STEPS
        )
        np.testing.assert_allclose(many["r"][k], sol.body("rod").theta[-1], rtol=1e-12)
        np.testing.assert_allclose(many["t"][k], sol.body("tip").theta[-1], rtol=1e-12)
