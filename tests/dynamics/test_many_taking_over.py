"""Events in the compiled loop that release joints which stick or which others repeat: as in single simulations."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest

from mbsd import Mechanism, angle_reaches, constant_rate, polynomial, speed_reaches
from mbsd.measures import samples
from tests.dynamics.test_many_releases import chain, sling
from tests.dynamics.test_many_repeated import cranks, dry

STEPS, DURATION = 40, 1.2


def dry_chain() -> Mechanism:
    """A chain in dry bearings: they come to rest, hold, and are released while they hold and while they turn."""
    m = chain()
    m.friction("dry", "A", 0.2, radius=0.1, preload=120.0, sticks=True)
    m.friction("dry axle", "axle", 0.1, radius=0.02, sticks=True)
    return m


def held_up() -> Mechanism:
    """Two bars that their dry pins hold where they are, until both are released at once; then one falls on a floor."""
    m = Mechanism("shelf", gravity=(0, -9.81))
    a, b, disc = m.bar("a", 0.4, mass=0.5), m.bar("coupler", 0.3, mass=0.4), m.body("disc", mass=1.0, inertia=1.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("axle", m.ground.at(2, 0), disc.origin)
    m.drive_angle("clock", disc, constant_rate(1.0))
    for pin in "AB":
        m.friction(f"rub {pin}", pin, 0.3, radius=0.1, preload=150.0, sticks=True)
    m.rigid_contact("floor", m.ground.at(0, -0.3), b.end, radius=0.01, restitution=0.3, friction=0.2)
    m.event("B breaks", angle_reaches(disc, 0.3), releases="B")
    m.event("A breaks", angle_reaches(disc, 0.5), releases="A")
    m.event("too", angle_reaches(disc, 0.5), releases=("A", "B"))
    m.start_near(a=10, coupler=20, disc=(2, 0, 0))
    return m


def twin_hinges() -> Mechanism:
    """A sling whose second hinge takes over."""
    m = sling()
    m.revolute("twin", m.ground.at(0, 1), m.bodies["arm"].start)
    m.event("twin breaks", angle_reaches(m.bodies["arm"], math.radians(80)), releases="twin")
    return m


def broken_cranks(m: Mechanism) -> Mechanism:
    """Of three equal cranks each breaks in turn; then the coupler is free."""
    for k, (angle, joints) in enumerate(((-75, "A1"), (-80, ("B0", "A2")))):
        m.event(f"breaks {k}", angle_reaches(m.bodies["crank0"], math.radians(angle)), releases=joints)
    m.event("last", speed_reaches(m.bodies["crank2"], 0.5), releases="B2")
    return m


def motor_and_cranks() -> Mechanism:
    """The crank with the motor lets go of the coupler, which the others carry, and then the motor itself."""
    m = cranks()
    m.drive_angle("motor", m.bodies["crank1"], polynomial(math.radians(-60), -2.0))
    m.event("off", angle_reaches(m.bodies["crank1"], math.radians(-80)), releases="B1")
    m.event("stops", angle_reaches(m.bodies["crank1"], math.radians(-120)), releases="motor")
    return m


Build = Callable[[], Mechanism]
CASES: dict[str, tuple[Build, str, str, Sequence[str]]] = {
    "dry chain": (dry_chain, "a", "arm", ("A.fx", "hinge.fy", "axle.fy")),
    "held up": (held_up, "coupler", "coupler", ("A.fy", "A.torque", "B.fx", "clock.effort")),
    "twin hinges": (twin_hinges, "arm", "arm", ("hinge.fy", "twin.fx")),
    "cranks": (lambda: broken_cranks(cranks()), "coupler", "coupler", ("A0.fx", "A1.fy", "B1.fx", "B2.fy")),
    "stops": (lambda: broken_cranks(cranks(stops=True)), "coupler", "coupler", ("A0.fx", "A1.fy", "B2.fy")),
    "friction": (lambda: broken_cranks(dry(False)), "coupler", "coupler", ("A0.fx", "A2.fx", "B0.fy")),
    "sticks": (lambda: broken_cranks(dry(True)), "coupler", "coupler", ("A0.fx", "A2.fx", "B0.fy")),
    "motor": (motor_and_cranks, "crank2", "crank1", ("A0.fx", "B1.fx", "motor.effort")),
}


@pytest.mark.parametrize("case", CASES)
def test_joints_let_go_as_in_single_simulations(case: str) -> None:
    build, varied, body, reactions = CASES[case]
    times, masses = np.linspace(0.0, DURATION, STEPS + 1), [0.5, 0.9, 1.4]
    names = [f"{body}.{part}" for part in ("x", "theta", "omega")]
    measure = {name: samples(name, times.tolist()) for name in (*names, *reactions)}
    many = build().simulate_many(times=times, vary={varied: {"mass": masses}}, measure=measure)
    assert many.alone == [None] * len(masses), many.way
    met = 0
    for k, mass in enumerate(masses):
        m = build()
        m.change(varied, mass=mass)
        sol = m.simulate(times=times)
        met += sum(event.what == "event" for event in sol.events)
        columns = dict(zip([c.rpartition(" [")[0] for c in sol.columns()], sol.columns().values(), strict=True))
        for name in (*names, *reactions):
            allowed = 1e-8 if name in names else 1e-6 * max(1.0, float(np.abs(columns[name]).max()))
            np.testing.assert_allclose(many[name][k], columns[name], rtol=0.0, atol=allowed, err_msg=name)
    assert met >= len(masses)


def test_a_row_in_which_nothing_breaks_is_that_of_the_whole_machine() -> None:
    whole, broken = cranks(), broken_cranks(cranks())
    times, own = np.linspace(0.0, 0.1, 5), samples("A1.fy", [0.05, 0.1])
    vary = {"coupler": {"mass": [0.5, 2.0]}}
    ways = [m.simulate_many(times=times, vary=vary, measure={"own": own}) for m in (whole, broken)]
    assert ways[1].alone == [None, None]
    np.testing.assert_allclose(ways[0]["own"], ways[1]["own"], rtol=1e-8)


def test_rows_begin_with_all_joints_and_any_number_of_threads_gives_the_same() -> None:
    masses = [0.5, 1.4, 0.5, 0.9, 0.5]
    given = [
        dry_chain().simulate_many(
            DURATION, vary={"a": {"mass": masses}}, measure={"x": samples("arm.x", [0.6, 1.2])}, steps=6, threads=n
        )["x"]
        for n in (1, 2)
    ]
    np.testing.assert_array_equal(given[0], given[1])
    np.testing.assert_array_equal(given[0][0], given[0][2])
    np.testing.assert_array_equal(given[0][0], given[0][4])
