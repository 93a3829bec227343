"""Joints of machines against published tables and closed forms: Geneva, rolling cart, V-engine."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, constant_rate, curve
from mbsd.results.solution import Solution
from tools.models.guided import geneva

FOLDER = Path(__file__).parent / "reference"


def _case(name: str) -> dict[str, Any]:
    return json.loads((FOLDER / f"{name}.json").read_text())


# -- Geneva -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("row", _case("analytic_geneva")["expected"]["table"], ids=lambda row: str(row["slots"]))
def test_geneva_by_its_table(row: dict[str, float]) -> None:
    slots = int(row["slots"])
    entry = math.radians(row["motion_deg"]) / 2
    peak = math.radians(row["angle_of_alpha_max_deg"])
    start = -math.pi + 0.01
    near = 1e-7
    angles = np.sort(
        np.concatenate(
            [
                np.linspace(start, start + 2 * math.pi, 1001),
                [0, peak, -peak, -entry - near, -entry + near, entry - near],
            ]
        )
    )
    sol = geneva(slots, start=start).sweep(times=np.concatenate([[0.0], angles[1:] - start]))
    angle, wheel = sol.body("crank").theta, sol.body("wheel")
    lam = row["crank_over_centre"]
    driven = np.abs(angle) < entry
    square = 1 - 2 * lam * np.cos(angle) + lam**2
    speed = np.where(driven, lam * (np.cos(angle) - lam) / square, 0.0)
    acceleration = np.where(driven, -lam * (1 - lam**2) * np.sin(angle) / square**2, 0.0)
    np.testing.assert_allclose(wheel.omega, -speed, atol=1e-9)  # an external wheel turns against its crank
    np.testing.assert_allclose(wheel.alpha, -acceleration, atol=1e-8 * row["alpha_max_over_w1sq"])
    assert np.ptp(wheel.theta) == pytest.approx(2 * math.pi / slots, rel=1e-9)
    assert np.mean(~driven) == pytest.approx(row["dwell_fraction"], abs=0.01)
    at = {key: int(np.argmin(np.abs(angle - value))) for key, value in (("peak", peak), ("middle", 0.0))}
    assert abs(wheel.omega[at["middle"]]) == pytest.approx(row["wmax_over_w1"], rel=1e-9)
    assert abs(wheel.alpha[at["peak"]]) == pytest.approx(row["alpha_max_over_w1sq"], rel=1e-8)
    before, after = int(np.argmin(np.abs(angle + entry + near))), int(np.argmin(np.abs(angle + entry - near)))
    assert wheel.alpha[before] == 0.0 or abs(wheel.alpha[before]) < 1e-9
    assert abs(wheel.alpha[after]) == pytest.approx(row["alpha_at_entry_over_w1sq"], rel=1e-5)
    np.testing.assert_allclose(sol.joint("index").torque[~driven], 0.0, atol=1e-9)  # nothing accelerates in the dwell


def test_a_geneva_goes_on_turn_after_turn_and_needs_its_radius() -> None:
    sol = geneva(4, start=-2.0).sweep(duration=10 * math.pi, steps=3000)
    wheel = sol.body("wheel").theta
    assert wheel[-1] - wheel[0] == pytest.approx(-5 * math.pi / 2, abs=1e-9)
    m = Mechanism("geneva")
    crank, other = m.body("crank"), m.body("wheel")
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(0.1, 0), other.origin)
    m.geneva("index", crank.origin, other.origin, 4, 0.05)
    m.drive_angle("motor", crank, constant_rate(1.0))
    with pytest.raises(AssemblyError, match=r"geneva: geneva 'index': .* hit the slots.*0.0707107 m, not 0.05"):
        m.sweep()


# -- rolling ----------------------------------------------------------------------------------------------------


def _cart() -> Mechanism:
    """Two wheels hold the cart's height and tilt; one freedom is left."""
    m = Mechanism("cart", gravity=(0.0, -9.81))
    cart = m.body("cart", 20, (0, 0), 5)
    for name, x in (("driven", -0.3), ("free", 0.3)):
        wheel = m.body(name, 2, (0, 0), 0.5)
        m.revolute(f"{name} axle", cart.at(x, -0.1), wheel.origin)
        m.rolling_disc(f"{name} road", m.ground.origin, wheel.origin, 0.1)
    m.start_near(cart=(0.5, 0.2, 0), driven=(0.2, 0.1, 0), free=(0.8, 0.1, 0))
    return m


def _assert_cart(sol: Solution, rows: np.ndarray, position: float, velocity: float) -> None:
    for b, name in enumerate(("cart", "driven", "free")):
        view = sol.body(name)
        got = np.stack([view.x, view.y, view.theta], axis=1)
        np.testing.assert_allclose(got, rows[:, 1 + 3 * b : 4 + 3 * b], atol=position)
        got = np.stack([view.vx, view.vy, view.omega], axis=1)
        np.testing.assert_allclose(got, rows[:, 10 + 3 * b : 13 + 3 * b], atol=velocity)


def test_rolling_cart_of_nikravesh() -> None:
    rows = np.array(_case("nikravesh_cart_a_rolling")["expected"][0]["rows"])
    m = _cart()
    m.drive_relative_angle("motor", m.bodies["cart"], m.bodies["driven"], constant_rate(-2 * math.pi))
    assert (m.mobility().dof, m.mobility().redundant_rows) == (1, 0)
    sol = m.sweep(times=rows[:, 0])
    _assert_cart(sol, rows, 1e-11, 1e-11)
    weight = 9.81 * 24
    carried = sol.joint("driven road").fy + sol.joint("free road").fy
    np.testing.assert_allclose(carried, weight, rtol=1e-9)


def test_rolling_cart_of_nikravesh_on_its_motor() -> None:
    """The torque falls straight with the speed, so the cart nears its top speed as 1 - exp(-t / T)."""
    case = _case("nikravesh_cart_c_rolling")
    rows, limits = np.array(case["expected"][0]["rows"]), case["expected"][0]
    m = _cart()
    line = curve([-4 * math.pi, 0.0], [0.0, -20.0], "linear")
    m.motor("motor", m.bodies["cart"], m.bodies["driven"], line)
    sol = m.simulate(times=rows[:, 0], tolerance=1e-10)
    _assert_cart(sol, rows, limits["tol_abs_pos"], limits["tol_abs_vel"])
    top = 0.1 * 4 * math.pi
    constant = (24 + 2 * 0.5 / 0.1**2) * top / (20 / 0.1)  # inertia seen by the cart over torque / radius
    speed = top * (1 - np.exp(-sol.t / constant))
    np.testing.assert_allclose(sol.body("cart").vx, speed, atol=1e-8)
    np.testing.assert_allclose(sol.body("cart").x, 0.5 + top * sol.t - constant * speed, atol=1e-8)


# -- V-engine ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("row", _case("analytic_v_engine")["expected"]["table"], ids=lambda row: f"V{row['V']}")
def test_v_engine_shaking_force(row: dict[str, float]) -> None:
    """Harmonics of the force on the frame; the second one with the next terms of its series in r / l."""
    r, rod, mass, speed = 0.05, 0.2, 1.0, 10.0
    m = Mechanism("v_engine", gravity=None)
    crank = m.bar("crank", r)
    m.revolute("main", m.ground.origin, crank.start)
    half = math.radians(row["V"]) / 2
    for name, lean in (("left", half), ("right", -half)):
        axis = math.pi / 2 + lean
        conrod, piston = m.bar(f"{name} rod", rod), m.body(f"{name} piston", mass)
        m.revolute(f"{name} pin", crank.end, conrod.start)
        m.revolute(f"{name} wrist", conrod.end, piston.origin)
        m.prismatic(f"{name} bore", m.ground.at(0, 0, axis), piston.at(0, 0, axis))
        bottom = r * math.cos(axis), r * math.sin(axis)
        m.start_near(
            **{
                f"{name} rod": math.degrees(axis),
                f"{name} piston": ((rod + r) * bottom[0] / r, (rod + r) * bottom[1] / r, 0),
            }
        )
    m.drive_angle("motor", crank, constant_rate(speed, math.pi / 2))  # angle 0 is the middle of the V
    m.start_near(crank=90)
    steps = 256
    sol = m.sweep(duration=2 * math.pi / speed, steps=steps)
    pistons = [sol.body(f"{name} piston") for name in ("left", "right")]
    force = -mass * np.array([sum(view.ax for view in pistons), sum(view.ay for view in pistons)])
    harmonics = np.fft.rfft(force[:, :-1], axis=1) / steps * 2 / (mass * r * speed**2)
    n = rod / r
    second = 1 + 1 / (4 * n**2) + 15 / (128 * n**4) + 35 / (512 * n**6)  # of F0 / n
    assert harmonics[1, 1].real == pytest.approx(row["primary_vertical"], abs=1e-9)
    assert abs(harmonics[0, 1].imag) == pytest.approx(abs(row["primary_horizontal"]), abs=1e-9)
    assert harmonics[1, 2].real * n / second == pytest.approx(row["secondary_vertical"], abs=2e-5)
    assert abs(harmonics[0, 2].imag) * n / second == pytest.approx(abs(row["secondary_horizontal"]), abs=2e-5)
