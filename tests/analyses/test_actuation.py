"""Inverse dynamics with given actuators, and motions made by efforts."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, MobilityError, ModelError, cycloidal, harmonic, table

G = 9.81


def slider_crank() -> Mechanism:
    """The slider's motion is given; a torque on the crank is to make it. Springs and friction of air beside gravity."""
    m = Mechanism("slider-crank", gravity=(0.0, -G))
    crank, rod = m.bar("crank", 0.1, mass=0.8), m.bar("rod", 0.35, mass=0.6)
    slider = m.body("slider", 1.5, inertia=0.01)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.origin, slider.origin)
    m.spring("spring", m.ground.at(0.6, 0.05), slider.origin, 150.0, damping=8.0, free_length=0.2)
    m.torque("motor", crank, 0.0)
    m.start_near(crank=60, rod=-15, slider=(0.38, 0, 0))
    return m


def test_a_torque_makes_the_motion_that_a_slider_driver_imposed() -> None:
    m = slider_crank()
    m.drive_coordinate("way", m.ground.origin, m.bodies["slider"].origin, harmonic(0.03, 5.0, 0.2, 0.37))
    sol = m.sweep(2.0, steps=600)
    made = m.inverse_dynamics(sol, ["motor"])
    assert made.residual < 1e-10
    imposed = sol.driver("way").power
    np.testing.assert_allclose(made.efforts["motor"] * sol.body("crank").omega, imposed, atol=1e-9)
    free = m.with_efforts(way=None, motor=table(sol.t, made.efforts["motor"]))
    assert not free.drivers
    free.start_near(crank=math.degrees(sol.body("crank").theta[0]))
    free.start_moving(crank=float(sol.body("crank").omega[0]))
    again = free.simulate(times=sol.t, tolerance=1e-10)
    np.testing.assert_allclose(again.body("slider").x, sol.body("slider").x, atol=1e-6)
    np.testing.assert_allclose(again.joint("B").reaction, made.solution.joint("B").reaction, atol=1e-3)
    assert np.abs(made.solution.joint("B").reaction - sol.joint("B").reaction).max() > 1.0, "another load path"
    assert not m.forces["motor"].laws, "the model itself is left alone"


def test_a_driver_among_the_actuators_keeps_its_effort() -> None:
    m = slider_crank()
    m.drive_angle("servo", m.bodies["crank"], cycloidal(1.0, 0.5, 0.1, math.radians(60)))
    sol = m.sweep(0.8, steps=200)
    made = m.inverse_dynamics(sol, "servo")
    np.testing.assert_allclose(made.efforts["servo"], sol.driver("servo").torque, atol=1e-9)
    np.testing.assert_allclose(made.solution.joint("guide").reaction, sol.joint("guide").reaction, atol=1e-9)


def test_a_distance_driver_becomes_an_actuator() -> None:
    m = Mechanism("boom", gravity=(0.0, -G))
    boom = m.bar("boom", 1.0, mass=5.0)
    m.revolute("A", m.ground.origin, boom.start)
    m.drive_distance("cylinder", m.ground.at(0.3, -0.4), boom.at(0.6, 0), cycloidal(0.1, 1.0, 0.0, 0.55))
    m.start_near(boom=20)
    sol = m.sweep(1.0, steps=400)
    free = m.with_efforts(cylinder=table(sol.t, sol.driver("cylinder").force))
    free.start_near(boom=math.degrees(sol.body("boom").theta[0]))
    again = free.simulate(times=sol.t, tolerance=1e-10)
    np.testing.assert_allclose(again.body("boom").theta, sol.body("boom").theta, atol=1e-6)


def test_two_actuators_on_one_freedom_share() -> None:
    m = slider_crank()
    m.force("push", m.bodies["slider"].origin, 0.0)
    m.drive_angle("servo", m.bodies["crank"], harmonic(0.3, 4.0, 0.0, math.radians(60)))
    sol = m.sweep(1.0, steps=100)
    made = m.inverse_dynamics(sol, ["motor", "push"])
    power = made.efforts["motor"] * sol.body("crank").omega + made.efforts["push"] * sol.body("slider").vx
    np.testing.assert_allclose(power, sol.driver("servo").power, atol=1e-9)
    assert np.abs(made.efforts["motor"]).max() > 0.1
    assert np.abs(made.efforts["push"]).max() > 0.1


def test_a_simulated_motion_needs_no_effort() -> None:
    m = slider_crank()
    sol = m.simulate(0.5, steps=50)
    made = m.inverse_dynamics(sol, ["motor"])
    np.testing.assert_allclose(made.efforts["motor"], 0.0, atol=1e-9)


def test_tasks_beyond_actuators_are_reported() -> None:
    m = Mechanism("arm", gravity=(0.0, -G))
    upper, lower = m.bar("upper", 0.4, mass=1.0), m.bar("lower", 0.3, mass=1.0)
    m.revolute("shoulder", m.ground.origin, upper.start)
    m.revolute("elbow", upper.end, lower.start)
    m.drive_angle("a", upper, harmonic(0.5, 3.0))
    m.drive_relative_angle("b", upper, lower, harmonic(0.4, 2.0))
    sol = m.sweep(1.0)
    both = m.inverse_dynamics(sol, ["a", "b"])
    np.testing.assert_allclose(both.efforts["b"], sol.driver("b").torque, atol=1e-10)
    with pytest.raises(MobilityError, match=r"arm: a cannot make this motion: .* each of the 2 degrees of freedom"):
        m.inverse_dynamics(sol, ["a"])


def test_wrong_arguments_are_refused() -> None:
    m = slider_crank()
    sol = m.simulate(0.1, steps=4)
    with pytest.raises(ModelError, match="no driver or force 'engine'; there is: spring, motor"):
        m.with_efforts(engine=3.0)
    with pytest.raises(ModelError, match="'spring' is a spring; only drivers"):
        m.with_efforts(spring=3.0)
    with pytest.raises(ModelError, match="names of actuators"):
        m.inverse_dynamics(sol, [])
    with pytest.raises(ModelError, match="not of this mechanism"):
        slider_crank().inverse_dynamics(sol, ["motor"])


def test_a_copy_has_contacts_and_events_of_its_own() -> None:
    m = slider_crank()
    copy = m.with_efforts(motor=1.0)
    copy.rigid_contact("floor", copy.ground.at(0.0, -1.0), copy.bodies["crank"].end)
    copy.event("late", lambda t, _: t - 1.0)
    assert not m.contacts
    assert not m.events
    assert copy.with_efforts(motor=None).contacts.keys() == {"floor"}
