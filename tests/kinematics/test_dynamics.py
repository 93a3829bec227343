"""Reactions, efforts, energy: power, massless links, views by name, tables and notebooks."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate, harmonic
from tools.models import four_bars

Lengths = tuple[float, float, float, float]
Masses = dict[str, tuple[float, tuple[float, float], float]]


@settings(max_examples=20)
@given(lengths=four_bars.crank_rockers(), masses=four_bars.mass_sets(), speed=st.floats(0.2, 10.0))
def test_the_driver_pays_for_every_change_of_energy(lengths: Lengths, masses: Masses, speed: float) -> None:
    sol = four_bars.model(lengths, speed, masses).sweep(steps=720)
    scale = max(1.0, float(np.abs(sol.driver("motor").power).max()))
    assert sol.stats.power_residual < 1e-9 * scale
    h = sol.t[1] - sol.t[0]
    e = sol.energy.total
    change = (e[:-4] - 8 * e[1:-3] + 8 * e[3:-1] - e[4:]) / (12 * h)
    np.testing.assert_allclose(change, sol.driver("motor").power[2:-2], atol=5e-3 * scale)


def test_massless_links_carry_no_load() -> None:
    sol = four_bars.model((4.0, 1.0, 3.5, 3.0), 5.0).sweep()
    assert np.abs(sol.driver("motor").torque).max() == 0.0
    assert sol.joint("B").magnitude.max() == 0.0


def test_views_name_what_there_is() -> None:
    sol = four_bars.model((4.0, 1.0, 3.5, 3.0)).sweep(steps=4)
    with pytest.raises(ModelError, match="no body 'arm'; there is: ground, crank, coupler, rocker"):
        sol.body("arm")
    with pytest.raises(ModelError, match="no joint 'E'; there is: A, B, C, D"):
        sol.joint("E")
    with pytest.raises(ModelError, match="has a torque, not a force"):
        _ = sol.driver("motor").force
    with pytest.raises(ModelError, match="traced point 'P'; there is: none"):
        sol.point("P")


def test_frame_and_notebook_views() -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0))
    m.trace("P", m.bodies["coupler"].at(1, 1))
    sol = m.sweep(steps=6)
    frame = sol.to_frame()
    assert frame.shape == (7, len(sol.columns()))
    assert frame["coupler.theta [rad]"].to_numpy() == pytest.approx(sol.body("coupler").theta)
    assert {"P.ax [m/s^2]", "B.fx [N]", "motor.effort [N m]", "kinetic [J]"} <= set(frame.columns)
    shown = sol._repr_html_()
    assert "coupler.theta [rad]" in shown
    assert "1 degree of freedom" in shown
    assert "random" in repr(sol)


def test_a_cranked_motor_reports_its_power() -> None:
    m = Mechanism("wheel")
    wheel = m.body("wheel", 2.0, (0, 0), 0.1)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.drive_angle("motor", wheel, constant_rate(3.0))
    sol = m.sweep(steps=8)
    np.testing.assert_allclose(sol.driver("motor").power, 0.0, atol=1e-12)
    np.testing.assert_allclose(sol.energy.kinetic, 0.45)


def test_columns_of_things_with_one_name_stay_apart() -> None:
    m = Mechanism("namesakes")
    slider = m.body("slider", 2.0)
    m.prismatic("slider", m.ground.origin, slider.at(0.0, 0.3))
    m.trace("slider", slider.at(0.1, 0.2))
    m.trace("way", slider.origin)
    m.drive_coordinate("way", m.ground.origin, slider.origin, harmonic(0.1, 2.0))
    columns = m.sweep(1.0, steps=4).columns()
    assert {
        "slider.x [m]",
        "trace slider.x [m]",
        "joint slider.x [m]",
        "trace way.x [m]",
        "driver way.effort [N]",
    } <= set(columns)
    places = [columns[f"{what}slider.y [m]"] for what in ("", "trace ", "joint ")]
    np.testing.assert_allclose(np.ptp(places, axis=1), 0.0, atol=1e-15)
    assert len({round(float(place[0]), 9) for place in places}) == 3
    assert len(columns) == 9 + 2 * 6 + 5 + 3 + 2
