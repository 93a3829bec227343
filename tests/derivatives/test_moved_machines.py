"""Derivatives of a machine that is elsewhere, turned, mirrored, larger or renamed are those of the machine itself."""

from __future__ import annotations

import copy
import importlib
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate, harmonic, optimise, tolerances
from mbsd.measures import final, largest
from mbsd.model.body import Marker

DURATION = 0.3
NOWHERE = 3.7e-17
"""m: what cos(90 degrees) leaves of a place."""
GALLERY = ("four_bar", "slider_crank", "quick_return", "windshield_wiper", "v_twin")


def four_bar(
    at: complex = 0.0,
    turn: float = 0.0,
    scale: float = 1.0,
    mirrored: bool = False,
    prefix: str = "",
    driven: bool = True,
) -> Mechanism:
    """One whose second pin is at 0.12 + 3.7e-17 i m before it is moved."""
    sign = -1.0 if mirrored else 1.0

    def put(x: float, y: float) -> tuple[float, float]:
        z = at + scale * complex(math.cos(turn), math.sin(turn)) * complex(x, sign * y)
        return z.real, z.imag

    def angle(degrees: float) -> float:
        return math.degrees(turn) + sign * degrees

    m = Mechanism(f"{prefix}four_bar", gravity=None)
    a, b, c = (
        m.bar(f"{prefix}{name}", length * scale, mass=mass)
        for name, length, mass in (("a", 0.04, 0.2), ("b", 0.12, 0.3), ("c", 0.09, 0.2))
    )
    m.revolute(f"{prefix}A", m.ground.at(*put(NOWHERE, 0)), a.start)
    m.revolute(f"{prefix}B", a.end, b.start)
    m.revolute(f"{prefix}C", b.end, c.end)
    m.revolute(f"{prefix}D", m.ground.at(*put(0.12, NOWHERE)), c.start)
    m.trace(f"{prefix}P", b.at(0.06 * scale, sign * 0.03 * scale))
    if driven:
        m.drive_angle(f"{prefix}motor", a, constant_rate(sign * 6.0, math.radians(angle(20.0))))
    else:
        m.start_moving(**{f"{prefix}a": sign * 6.0})
    m.start_near(**{f"{prefix}a": angle(20.0), f"{prefix}b": angle(45.0), f"{prefix}c": angle(100.0)})
    return m


def slopes(m: Mechanism, prefix: str = "") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(T, 2, 2) of the traced point by the place of D, (T, 2) of it by the crank's length, (T, 2) of c.omega by D."""
    of = [f"{prefix}{name}" for name in ("P.x", "P.y", "c.omega")]
    s = m.sensitivities(of, [f"{prefix}{name}" for name in ("D.x", "D.y", "a.length")], DURATION, 6)
    path = np.stack([s[of[0]], s[of[1]]], axis=1)
    return path[:, :, :2], path[:, :, 2], s[of[2]][:, :2]


@settings(max_examples=12, deadline=None)
@given(
    far=st.sampled_from([0.0, 1e3]),
    towards=st.floats(0.0, 6.3),
    turn=st.floats(-3.1, 3.1),
    scale=st.sampled_from([1e-3, 1.0, 1e3]),
    mirrored=st.booleans(),
    driven=st.booleans(),
)
def test_derivatives_go_with_the_machine(
    far: float, towards: float, turn: float, scale: float, mirrored: bool, driven: bool
) -> None:
    at = far * scale * complex(math.cos(towards), math.sin(towards))
    before = slopes(four_bar(driven=driven))
    after = slopes(four_bar(at, turn, scale, mirrored, "other ", driven), "other ")
    sign = -1.0 if mirrored else 1.0
    matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]) @ np.diag([1.0, sign])
    expected = matrix @ before[0] @ matrix.T, before[1] @ matrix.T, sign / scale * before[2] @ matrix.T
    for own, known in zip(after, expected, strict=True):
        assert np.abs(own - known).max() < (1e-6 if far else 3e-7) * np.abs(known).max()


@pytest.mark.parametrize("driven", [True, False])
def test_a_place_of_next_to_nothing_has_the_derivatives_of_any_place(driven: bool) -> None:
    """Moving both pins moves all; its y alone turns the ground link about the other pin."""
    m = four_bar(driven=driven)
    s = m.sensitivities(["P.x", "P.y"], ["A.x", "D.x", "A.y", "D.y"], DURATION, 6)
    assert np.abs(s.of("P.x", "A.x") + s.of("P.x", "D.x") - 1.0).max() < 1e-6
    assert np.abs(s.of("P.y", "A.y") + s.of("P.y", "D.y") - 1.0).max() < 1e-6
    assert np.abs(s.of("P.x", "A.y") + s.of("P.x", "D.y")).max() < 1e-6


def elsewhere(m: Mechanism, x: float, y: float) -> Mechanism:
    """A copy whose ground is moved."""
    out = copy.deepcopy(m)

    def moved(marker: Marker) -> Marker:
        return replace(marker, x=marker.x + x, y=marker.y + y) if marker.body.name == "ground" else marker

    tables: tuple[Any, ...] = out.joints, out.drivers, out.forces, out.contacts
    for table in tables:
        for name, entry in table.items():
            params = {key: moved(value) if isinstance(value, Marker) else value for key, value in entry.params.items()}
            table[name] = replace(entry, i=moved(entry.i), j=moved(entry.j), params=params)
    for name, start in out.starts.items():
        if start.place is not None:
            out.starts[name] = replace(start, place=(start.place[0] + x, start.place[1] + y))
    return out


@pytest.mark.parametrize("name", GALLERY)
def test_machines_of_the_gallery_have_the_same_derivatives_a_kilometre_away(name: str) -> None:
    module = importlib.import_module(f"mechanisms.{name}.mechanism")
    m = module.build(module.Params())
    body = next(key for key in list(m.bodies)[::-1] if key != "ground")
    of = [f"{body}.x", f"{body}.y", f"{body}.omega"]
    numbers = [f"{name}.{axis}" for name, joint in m.joints.items() if joint.kind.name == "revolute" for axis in "xy"][
        :6
    ]
    here = m.sensitivities(of, numbers, steps=12)
    there = elsewhere(m, 1000.0, -2000.0).sensitivities(of, numbers, times=here.t)
    for label in of:
        size = np.abs(here[label]).max() or 1.0
        assert np.abs(here[label] - there[label]).max() < 3e-6 * max(size, 1.0), label


def test_a_law_whose_number_acts_over_a_long_time_has_the_derivative_of_its_formula() -> None:
    """x'' = A sin(w t) / m: a thousand radians after the start a part of w is many turns."""
    m = Mechanism("pushed", gravity=None)
    cart = m.body("cart", mass=2.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.force("push", cart.origin, harmonic(3.0, 40.0))
    m.start_near(cart=(0, 0, 0))
    s = m.sensitivities("cart.vx", ["push.rate", "push.amplitude"], 20.0, 50)
    turn = 40.0 * s.t
    expected = 3.0 / 2.0 * (s.t * np.sin(turn) / 40.0 - (1.0 - np.cos(turn)) / 40.0**2)
    assert np.abs(s.of("cart.vx", "push.rate") - expected).max() < 1e-6 * np.abs(expected).max()
    assert np.abs(s.of("cart.vx", "push.amplitude") - (1.0 - np.cos(turn)) / 80.0).max() < 1e-9


def test_an_argument_of_the_author_that_begins_at_nothing_is_moved_within_its_bounds() -> None:
    def build(rise: float = NOWHERE) -> Mechanism:
        m = Mechanism("arm")
        arm = m.bar("arm", 0.1, mass=1.0)
        m.revolute("A", m.ground.at(0, rise), arm.start)
        m.drive_angle("motor", arm, constant_rate(1.0))
        m.trace("P", arm.end)
        return m

    best = optimise(build(), final("P.y"), {"rise": (-0.05, 0.05)}, build=build, duration=1.0, steps=10)
    assert best.gradient["rise"] == pytest.approx(1.0, abs=1e-9)
    assert best.values["rise"] == pytest.approx(-0.05)


def test_tolerances_of_a_picometre_a_kilometre_away_have_the_slopes_of_wider_ones_here() -> None:
    module = importlib.import_module("mechanisms.four_bar.mechanism")
    m = module.build(module.Params())
    here, there = (
        tolerances(machine, {"crank": size, "D": {"x": size, "y": size}}, largest("P.y"), n=50)
        for machine, size in ((m, 1e-5), (elsewhere(m, 1000.0, -2000.0), 1e-12))
    )
    assert np.abs(there.slopes - here.slopes).max() < 1e-5
