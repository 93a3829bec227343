"""Modelica: along the motion of this solver every equation of the file holds, with forces that are the only ones."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, harmonic, polynomial
from mechanisms.stages.export.modelica.document import CLASSES, Identifiers
from mechanisms.stages.export.modelica.text import modelica
from tests.mechanisms.export.modelica_file import UNKNOWN_UNITS, ModelicaFile, Moment
from tests.mechanisms.export.test_robot_models import (
    double_pendulum,
    four_bar,
    free_slider_crank,
    geared,
    quick_return,
    thrown,
)


def sprung() -> Any:
    """Springs of both kinds, a force that turns with its body, a torque by a law."""
    m = Mechanism("sprung")
    upper, lower = m.bar("upper", 0.3, mass=0.4), m.bar("lower", 0.2, mass=0.2)
    m.revolute("A", m.ground.at(0.1, 0.2), upper.start)
    m.revolute("B", upper.end, lower.start)
    m.spring("spring", m.ground.at(0.4, 0.2), lower.end, 20.0, damping=0.1, free_length=0.2)
    m.torsion_spring("twist", upper, lower, 0.5, damping=0.02, free_angle=0.3)
    m.force("push", lower.end, 0.7, direction=0.4, frame=lower)
    m.torque("brake", lower, harmonic(0.2, 3.0, 0.1), against=upper)
    m.start_near(upper=20, lower=60)
    m.start_moving(upper=1.0, lower=-2.0)
    return m.simulate(0.5, steps=100)


def planetary() -> Any:
    """A planet on an arm, in a ring and round a sun: the ring repeats nothing."""
    m = Mechanism("planetary")
    sun, arm, planet = (m.body(name, mass=0.2, inertia=1e-4) for name in ("sun", "arm", "planet"))
    m.revolute("S", m.ground.at(0, 0), sun.origin)
    m.revolute("O", m.ground.at(0, 0), arm.origin)
    m.revolute("P", arm.at(0.05, 0), planet.origin)
    m.gear_pair("outside", sun.origin, planet.origin, 0.03, 0.02)
    m.gear_pair("ring", m.ground.at(0, 0), planet.origin, 0.07, 0.02, internal=True)
    m.drive_angle("motor", sun, constant_rate(2.0))
    return m.sweep(0.5, steps=50)


def belted() -> Any:
    m = Mechanism("belted")
    first, second, third = (
        m.body(name, mass=0.2, inertia=1e-4, com=(0.002, 0.001)) for name in ("first", "second", "third")
    )
    for name, body, x in (("A", first, 0.0), ("B", second, 0.15), ("C", third, 0.3)):
        m.revolute(name, m.ground.at(x, 0), body.origin)
    m.belt("open", first.origin, second.origin, 0.02, 0.05)
    m.belt("crossed", second.origin, third.origin, 0.03, 0.03, crossed=True)
    m.drive_angle("motor", first, polynomial(0.0, 2.0, 3.0))
    return m.sweep(0.5, steps=50)


def racked() -> Any:
    m = Mechanism("racked")
    pinion, rack = m.body("pinion", mass=1.0, inertia=1e-3), m.body("rack", mass=1.0, inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0.02), pinion.origin)
    m.prismatic("guide", m.ground.at(0, 0), rack.origin)
    m.rack_and_pinion("mesh", rack.origin, pinion.origin, 0.02)
    m.drive_coordinate("push", m.ground.at(0, 0), rack.origin, harmonic(0.03, 2.0))
    return m.sweep(0.5, steps=50)


def lifted() -> Any:
    """An actuator lifts an arm; a tray is welded to a rod that keeps its direction, another slides askew."""
    m = Mechanism("lifted")
    arm, tray, top, cart = (
        m.bar("arm", 0.3, mass=0.4),
        m.body("tray", mass=0.2),
        m.body("top", mass=0.1),
        m.body("cart", mass=0.3),
    )
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_distance("jack", m.ground.at(0.2, -0.1), arm.at(0.2, 0.0), polynomial(0.15, 0.02))
    m.revolute("B", arm.end, tray.origin)
    m.angle_lock("level", m.ground.at(0, 0, 0.3), tray.at(0, 0, 0.1))
    m.weld("plate", tray.at(0.05, 0.01, 0.4), top.at(0.0, 0.02, 0.1))
    m.prismatic("rail", top.at(0.01, 0.0, 0.7), cart.at(0.0, 0.01, -0.2))
    m.distance("tie", arm.at(0.1, 0.05), cart.at(0.02, 0.0), 0.27)
    m.start_near(arm=10, cart=(0.33, 0.1, 40))
    return m.sweep(0.5, steps=50)


def turned_against() -> Any:
    m = Mechanism("turned against")
    upper, lower = m.bar("end", 0.3, mass=0.4), m.bar("rod 1", 0.2, mass=0.2)
    m.revolute("A", m.ground.at(0.1, 0.2), upper.start)
    m.revolute("a", upper.end, lower.start)
    m.drive_relative_angle("motor", upper, lower, harmonic(0.4, 5.0))
    m.start_near(**{"end": 20, "rod 1": 20})
    return m.simulate(0.3, steps=60)


SOLVED = [double_pendulum, free_slider_crank, quick_return, geared, four_bar, thrown, sprung, planetary, belted, racked,
          lifted, turned_against]  # fmt: skip


def state_of(sol: Any, file: ModelicaFile, k: int) -> dict[str, np.ndarray]:
    """By component: pose, rate and acceleration of the centre of mass of its body at an output."""
    out = {}
    for c in (c for c in file.components.values() if c.kind == "Body"):
        body = c.words.split("'")[1]
        view, (u, v) = sol.body(body), sol.mechanism.bodies[body].com
        cos, sin = math.cos(view.theta[k]), math.sin(view.theta[k])
        arm = np.array([cos * u - sin * v, sin * u + cos * v])
        across = np.array([-arm[1], arm[0]])
        out[c.name] = np.array([
            [*(np.array([view.x[k], view.y[k]]) + arm), view.theta[k]],
            [*(np.array([view.vx[k], view.vy[k]]) + view.omega[k] * across), view.omega[k]],
            [*(np.array([view.ax[k], view.ay[k]]) + view.alpha[k] * across - view.omega[k] ** 2 * arm), view.alpha[k]],
        ])  # fmt: skip
    return out


@pytest.mark.parametrize("solve", SOLVED, ids=lambda solve: solve.__name__)
def test_every_equation_holds_along_the_motion(solve: Any) -> None:
    sol = solve()
    text, left_out = modelica(sol)
    file = ModelicaFile(text)
    assert left_out == []
    for k in (0, len(sol.t) // 3, len(sol.t) - 1):
        miss, equations, unknowns, rank = Moment(file, state_of(sol, file, k), float(sol.t[k])).forces()
        assert miss < 1e-7
        assert rank == unknowns  # forces are the only ones
        assert equations - unknowns == sol.mobility.dof - len(sol.mechanism.drivers)


@pytest.mark.parametrize("solve", SOLVED, ids=lambda solve: solve.__name__)
def test_it_starts_from_as_many_coordinates_as_there_are_freedoms(solve: Any) -> None:
    sol = solve()
    text, _ = modelica(sol)
    declared = [c.modifiers for c in ModelicaFile(text).components.values()]
    fixed = {key: sum(given.get(key, "").count("true") for given in declared) for key in ("phi", "s", "r", "w", "v")}
    freedoms = sol.mobility.dof - len(sol.mechanism.drivers)
    assert fixed["phi"] + fixed["s"] + fixed["r"] == freedoms
    assert fixed["w"] + fixed["v"] == freedoms


def test_start_values_are_those_of_the_first_output() -> None:
    sol = free_slider_crank()
    parts = ModelicaFile(modelica(sol)[0]).components
    assert _start(parts["A"].modifiers["phi"]) == pytest.approx(sol.body("rod").theta[0] - sol.body("crank").theta[0])
    assert _start(parts["A"].modifiers["w"]) == pytest.approx(sol.body("rod").omega[0] - sol.body("crank").omega[0])
    view = sol.body("slider")
    assert _start(parts["guide"].modifiers["s"]) == pytest.approx(math.hypot(view.x[0], view.y[0]))
    assert _start(parts["guide"].modifiers["v"]) == pytest.approx(
        math.copysign(math.hypot(view.vx[0], view.vy[0]), view.vx[0])
    )


def _start(text: str) -> float:
    return float(re.findall(r"start=([^),]+)", text)[0])


def test_a_wrong_number_is_noticed() -> None:
    """The check above notices another mass or another sign."""
    sol = double_pendulum()
    text, _ = modelica(sol)
    for right, wrong in (("m=0.4", "m=0.5"), ("frame_b.fx = -f*", "frame_b.fx = f*"), ("c=0.1", "c=0.2")):
        assert right in text
        file = ModelicaFile(text.replace(right, wrong))
        assert Moment(file, state_of(sol, file, 50), float(sol.t[50])).forces()[0] > 1e-3


@pytest.mark.parametrize("name", CLASSES)
def test_classes_have_an_equation_for_each_unknown(name: str) -> None:
    _, declared, equations = CLASSES[name]
    own = re.findall(r"^    Real \w+", declared, re.MULTILINE)
    assert len(equations.strip().split("\n")) == 6 + len(own)
    efforts = re.findall(r'^    Real \w+\(unit="(?:N|N\.m)"\)', declared, re.MULTILINE)
    assert len(efforts) <= 1 <= len(UNKNOWN_UNITS)


def test_names_are_identifiers_each_once() -> None:
    names = Identifiers("crank")
    assert [names.new(*words) for words in (["end"], ["rod 1"], ["rod", "1"], ["Rod_1"], ["crank"], ["2é"], ["ж"])] == [
        "end_", "rod_1", "rod_1_2", "Rod_1_3", "crank_2", "n2", "thing",
    ]  # fmt: skip
    assert names.new("MasslessRod") == "MasslessRod_2"


def test_features_without_words_are_named_and_repeats_are_left_out() -> None:
    m = Mechanism("three planets")
    sun, arm = m.body("sun", mass=0.2, inertia=1e-4), m.body("arm", mass=0.2, inertia=1e-4)
    m.revolute("S", m.ground.at(0, 0), sun.origin)
    m.revolute("O", m.ground.at(0, 0), arm.origin)
    for k in range(2):
        planet = m.body(f"planet{k}", mass=0.1, inertia=1e-5)
        m.revolute(f"P{k}", arm.at(0.05 * math.cos(3 * k), 0.05 * math.sin(3 * k)), planet.origin)
        m.gear_pair(f"outside{k}", sun.origin, planet.origin, 0.03, 0.02)
        m.gear_pair(f"ring{k}", m.ground.at(0, 0), planet.origin, 0.07, 0.02, internal=True)
    m.torque("brake", arm, lambda t: -0.1 * np.cos(t))
    m.drive_angle("motor", sun, constant_rate(2.0))
    sol = m.sweep(0.5, steps=50)
    text, left_out = modelica(sol)
    assert left_out == ["joint 'ring1' (gear_pair), which repeats what others hold", "force 'brake' (torque)"]
    assert all(f"// Left out: {words}" in text for words in left_out)
    file = ModelicaFile(text)
    assert file.name == "three_planets"
    _, _, unknowns, rank = Moment(file, state_of(sol, file, 9), float(sol.t[9])).forces()
    assert rank == unknowns
