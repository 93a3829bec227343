"""Every integrator, found by itself: order, constraints at outputs, restart, energy; and what each is made for."""

from __future__ import annotations

import dataclasses
import math
from functools import cache

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError
from mbsd.dynamics.integrators.kind import INTEGRATORS, register
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.motion import integrate
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import NEXT, PAUSED, REACHED, TIME, output_for, start_state
from mbsd.testing import check_integrator, integrators
from mbsd.testing.integrators import (
    AMPLITUDE,
    GRAVITY,
    OUTPUTS,
    errors_of,
    exact_pendulum,
    four_bar,
    order_of,
    pendulum,
)

METHODS = sorted(method.name for method in integrators() if method.installed)
PROJECTED = [name for name in METHODS if name != "baumgarte"]
"""Methods that promise closed constraints at outputs."""


@cache
def fine_four_bar(duration: float) -> np.ndarray:
    sol = four_bar().simulate(duration, steps=OUTPUTS, method="rk4", step=1e-4 * duration**0.5)
    return sol.body("rocker").theta


@pytest.mark.parametrize("name", METHODS)
def test_order_on_a_pendulum(name: str) -> None:
    check_integrator(INTEGRATORS[name])


@pytest.mark.parametrize("name", METHODS)
def test_order_on_a_closed_chain(name: str) -> None:
    """By halved steps, or by tolerances divided by ten."""
    method = INTEGRATORS[name]
    steps, errors = errors_of(method, four_bar, "rocker", lambda t: fine_four_bar(float(t[-1])))
    if method.fixed_step:
        assert order_of(steps, errors) > method.order - 0.25
        assert (errors[1:] < 0.7 * errors[:-1]).all()
        return
    assert errors[-1] < (1e-6 if method.order else 1e-4)
    assert errors[-1] < 1e-3 * errors[0]
    assert (steps[1:] > steps[:-1]).all()
    if method.order:
        assert order_of(steps, errors) > method.order - 1.0, (
            "steps are not equal: the slope is not the order to a digit"
        )


def test_a_method_of_a_lower_order_than_it_claims_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    method = dataclasses.replace(INTEGRATORS["rk4"], name="claimed", order=6)
    monkeypatch.setitem(INTEGRATORS, "claimed", method)
    with pytest.raises(AssertionError, match=r"claimed: the measured order is [34]\.\d+; it must be above 5\.75"):
        check_integrator(method)


def test_a_method_that_leaves_constraints_open_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    rk4 = INTEGRATORS["rk4"]

    def advance(dyn, scratch, state, out, *steps):
        status = rk4.advance(dyn, scratch, state, out, *steps)
        out.y[-1, 0, 6:] += 1e-3  # the second body and the third, which the pendulum does not have
        return status

    method = dataclasses.replace(rk4, name="open", advance=advance)
    monkeypatch.setitem(INTEGRATORS, "open", method)
    with pytest.raises(AssertionError, match=r"open: position residuals of a four-bar's outputs reach 0\.00"):
        check_integrator(method)


@pytest.mark.parametrize("name", PROJECTED)
def test_constraints_hold_at_every_output(name: str) -> None:
    """Outputs fall on and between steps."""
    sol = four_bar().simulate(times=[0.0, 0.1, 0.1234, 0.35, 0.5], method=name, step=2e-3)
    assert sol.stats.position_residual < 1e-12
    assert sol.stats.velocity_residual < 1e-9
    assert sol.stats.acceleration_residual < 1e-7
    assert sol.stats.power_residual < 1e-7
    assert np.ptp(sol.energy.total) < 1e-2


@pytest.mark.parametrize("name", METHODS)
def test_a_run_in_two_parts_is_the_run_in_one(name: str) -> None:
    """Stopped after three steps, then at half time, and gone on from there."""
    method = INTEGRATORS[name]
    ready = prepare_dynamics(four_bar(), 0.0, 1.0)
    times = np.linspace(0.0, 1.0, 9)
    whole, out = integrate(ready, method, times, 1e-7, 2e-3, formulation="reference")
    state = start_state(np.stack([ready.initial.q, ready.initial.v]), len(ready.packed.ws.phi), 0.0)
    parts = output_for(times, len(ready.initial.q), len(ready.packed.ws.phi))
    run, again = (Run(ready, method, 1e-7, 2e-3, 1.0, {}) for _ in range(2))
    assert method.advance(ready.dynamics, run.scratch, state, parts, run.settings, 0.5, 3) == PAUSED
    assert 0.0 < state.clock[TIME] < 0.5
    for end in (0.5, 1.0):
        assert method.advance(ready.dynamics, again.scratch, state, parts, run.settings, end, 10**6) == REACHED
        assert state.clock[TIME] == end
    assert state.count[NEXT] == len(times)
    near = 1e-5 if method.order else 2e-4  # from half time on, methods that choose their order take other steps
    np.testing.assert_allclose(state.y, whole.y, atol=near)
    np.testing.assert_allclose(parts.y, out.y, atol=near)
    np.testing.assert_allclose(parts.lam, out.lam, atol=10 * near + 1e-3)


@pytest.mark.parametrize("name", METHODS)
def test_work_of_a_driver_goes_into_the_energy(name: str) -> None:
    from mbsd import harmonic

    m = four_bar()
    m.drive_angle("motor", m.bodies["crank"], harmonic(0.8, 3.0, 0.1, math.radians(50)))
    sol = m.simulate(1.0, steps=10, method=name, step=2e-3)
    assert sol.work is not None
    assert np.ptp(sol.energy.total) > 0.1
    np.testing.assert_allclose(sol.energy.total - sol.work, sol.energy.total[0], atol=1e-4)
    np.testing.assert_allclose(
        sol.body("crank").theta, sol.driver("motor").value, atol=1e-4 if name == "baumgarte" else 1e-12
    )


# -- symplectic ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "bound"), [("rattle", 5e-2), ("symplectic", 1e-4)])
def test_energy_stays_bounded(name: str, bound: float) -> None:
    """The error of the last fifth of 100 s is that of the first: it swings and does not grow."""
    sol = four_bar().simulate(100.0, steps=5000, method=name, step=0.01)
    error = np.abs(sol.energy.total - sol.energy.total[0])
    assert error.max() < bound
    assert error[-1000:].max() < 1.05 * error[:1000].max()


@pytest.mark.parametrize("name", ["rattle", "symplectic"])
def test_time_runs_backward_along_the_same_path(name: str) -> None:
    """From the end with velocities turned round, the run returns to its start: to rounding, however long the steps."""
    method = INTEGRATORS[name]
    ready = prepare_dynamics(four_bar(), 0.0, 2.0)
    there, _ = integrate(ready, method, np.array([0.0, 2.0]), 1e-7, 0.01)
    ready.initial.q[:], ready.initial.v[:] = there.y[0], -there.y[1]
    back, _ = integrate(ready, method, np.array([0.0, 2.0]), 1e-7, 0.01)
    start = prepare_dynamics(four_bar(), 0.0, 2.0).initial
    np.testing.assert_allclose(back.y[0], start.q, atol=1e-10)
    np.testing.assert_allclose(back.y[1], -start.v, atol=1e-9)


def test_rattle_needs_no_mass() -> None:
    """A coupler without mass, and a point mass without inertia, keep the order."""
    m = Mechanism("bob", gravity=(0.0, -GRAVITY))
    bob = m.body("bob", 1.0)
    m.revolute("A", m.ground.at(0, 0), bob.at(0, 1.0))
    m.start_near(bob=math.degrees(AMPLITUDE))
    sol = m.simulate(1.0, steps=1, method="symplectic", step=2e-3)
    assert sol.body("bob").theta[-1] - math.pi / 2 == pytest.approx(exact_pendulum(1.0), abs=1e-9)


# -- stiff --------------------------------------------------------------------------------------------------------


def stiff_four_bar() -> Mechanism:
    """With a stiff bush for the pin C."""
    m = Mechanism("stiff", gravity=(0.0, -GRAVITY))
    crank, coupler, rocker = m.bar("crank", 0.3, 1.0), m.bar("coupler", 0.9, 0.5), m.bar("rocker", 0.7, 2.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("D", m.ground.at(0.8, 0), rocker.start)
    start = four_bar().simulate(1e-3, steps=1)
    m.start_near(**{name: math.degrees(float(start.body(name).theta[0])) for name in ("crank", "coupler", "rocker")})
    m.bushing("C", coupler.end, rocker.end, (1e7, 1e7, 0.0), (1e5, 1e5, 0.0))
    return m


def test_implicit_methods_pass_what_makes_explicit_ones_creep() -> None:
    explicit = stiff_four_bar().simulate(0.1, steps=10)
    implicit = stiff_four_bar().simulate(0.1, steps=10, method="radau")
    fixed = stiff_four_bar().simulate(0.1, steps=10, method="generalized_alpha", step=1e-3)
    assert implicit.stats.steps < 0.05 * explicit.stats.steps
    assert fixed.stats.steps == 100
    np.testing.assert_allclose(implicit.body("rocker").theta, explicit.body("rocker").theta, atol=1e-6)
    np.testing.assert_allclose(fixed.body("rocker").theta, explicit.body("rocker").theta, atol=1e-4)


@pytest.mark.parametrize("name", ["rk4", "baumgarte"])
def test_an_explicit_run_that_blows_up_is_refused(name: str) -> None:
    with pytest.raises(SimulationError, match=r"step of 0\.001 s.*radau"):
        stiff_four_bar().simulate(0.1, steps=10, method=name, step=1e-3)


@pytest.mark.parametrize("name", ["rattle", "symplectic"])
def test_symplectic_methods_refuse_stiff_dampers(name: str) -> None:
    with pytest.raises(SimulationError, match="smaller step"):
        stiff_four_bar().simulate(0.1, steps=10, method=name, step=1e-3)


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.8, 1.0])
def test_generalised_alpha_leaves_rho_of_what_is_infinitely_fast(rho: float) -> None:
    """A mass on a spring, 10 000 rad a step: x_n = (a + b n + c n^2) (+-rho)^n, a threefold eigenvalue."""
    m = Mechanism("oscillator", gravity=None)
    mass = m.body("mass", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, mass.origin)
    m.bushing("spring", m.ground.origin, mass.origin, (1e12, 0.0, 0.0))
    m.start_near(mass=(1e-3, 0.0, 0.0))
    x = m.simulate(0.2, steps=20, method="generalized_alpha", step=0.01, rho=rho).body("mass").x
    if rho == 0.0:
        assert np.abs(x[9:]).max() < 1e-12 * x[0]
        return
    scaled = x / (math.copysign(rho, x[20] * x[19]) ** np.arange(21))
    np.testing.assert_allclose(np.diff(scaled, 3), 0.0, atol=1e-6 * np.abs(scaled).max())


# -- use ----------------------------------------------------------------------------------------------------------


def test_options_are_named_and_checked() -> None:
    with pytest.raises(ModelError, match="method 'rk4': there is no option 'rho'; there is: duration, steps"):
        pendulum().simulate(1.0, method="rk4", rho=0.5)
    with pytest.raises(ModelError, match="no option 'tolerence'"):
        pendulum().simulate(1.0, tolerence=1e-3)


def test_a_method_of_a_missing_package_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    foreign = dataclasses.replace(INTEGRATORS["rk4"], name="foreign", package="no_such_package")
    monkeypatch.setitem(INTEGRATORS, "foreign", foreign)
    with pytest.raises(
        ModelError, match="method 'foreign' needs the package 'no_such_package', which is not installed"
    ):
        pendulum().simulate(1.0, method="foreign")


@pytest.mark.parametrize("name", [name for name in METHODS if "-" in name])
def test_other_libraries_find_the_same_motion(name: str) -> None:
    """Reactions, work and all, with forces that depend on velocity, a driver and outputs between the steps."""
    m = four_bar()
    m.spring("damper", m.ground.at(0.2, 0.6), m.bodies["coupler"].end, 40.0, 2.0, 0.5)
    own = m.simulate(1.0, steps=50, tolerance=1e-10)
    sol = m.simulate(1.0, steps=50, method=name, tolerance=1e-9)
    np.testing.assert_allclose(sol.q, own.q, atol=2e-6)
    np.testing.assert_allclose(sol.joint("C").reaction, own.joint("C").reaction, atol=1e-3)
    assert own.work is not None
    assert sol.work is not None
    np.testing.assert_allclose(sol.work, own.work, atol=1e-5)
    assert np.abs(own.work).max() > 0.1


@pytest.mark.parametrize("name", [name for name in METHODS if "-" in name])
def test_rates_that_are_no_numbers_stop_other_libraries(name: str) -> None:
    """They would go on for ever, or tell nothing."""
    m = pendulum()
    m.user_force("push", lambda t, q, v: [0.0, 0.0, math.log(0.5 - t)], m.bodies["rod"])
    with pytest.raises((ModelError, SimulationError), match="push"):
        m.simulate(1.0, method=name)


def test_a_name_is_taken_once() -> None:
    with pytest.raises(ValueError, match="registered twice"):
        register(INTEGRATORS["rk4"])


def test_a_step_without_solution_is_told() -> None:
    """A point on a string of 1 m cannot go 5 m to the side."""
    m = Mechanism("string")
    bob = m.body("bob", 1.0, inertia=1.0)
    m.distance("string", m.ground.at(0, 0), bob.at(0, 0), 1.0)
    m.start_near(bob=(0.0, -1.0, 0.0))
    m.start_moving(bob=(10.0, 0.0, 0.0))
    with pytest.raises(SimulationError, match="smaller step"):
        m.simulate(1.0, steps=2, method="rattle")


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.ModelWarning")
@pytest.mark.parametrize("name", ["rk4", "generalized_alpha"])
@pytest.mark.parametrize("step", [2e-3, 5e-4])
def test_a_step_too_long_for_the_joints_to_close_is_told(name: str, step: float) -> None:
    """Light links that a heavy one pulls straight snap in microseconds; the pins must not come open in silence."""
    m = Mechanism("whip")
    a, b, c = m.bar("a", 0.3, mass=1.0), m.bar("b", 0.3, mass=1.0), m.bar("c", 0.5, mass=1e9)
    m.revolute("A", m.ground.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.start)
    m.start_near(a=-60, b=-20, c=-80)
    with pytest.raises(SimulationError, match=rf"stops at t = 0\.10.* step of {step:.3g} s .* smaller step.*dop853"):
        m.simulate(0.2, steps=20, method=name, step=step)
