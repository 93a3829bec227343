"""Freedoms, redundant joints, missing and superfluous drivers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, MobilityError, ModelError, SingularPoseError, constant_rate
from tests.dynamics.test_simulate import n_four_bar
from tools.models import linkages


def four_bar(
    ground: float = 0.12, crank: float = 0.04, coupler: float = 0.12, rocker: float = 0.09, drive: bool = True
) -> Mechanism:
    """The plain four-bar A-B-C-D with uniform rods of 1 kg/m."""
    lengths = crank, coupler, rocker
    return linkages.four_bar(ground, *lengths, masses=lengths, law=linkages.TURN if drive else None)


def parallelogram(extra: bool = True) -> Mechanism:
    """Two equal cranks and a coupler, a third crank in the middle repeating what the others hold."""
    m = Mechanism("parallelogram")
    left, right, coupler = m.bar("left", 0.1, 0.2), m.bar("right", 0.1, 0.2), m.bar("coupler", 0.3, 0.3)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", m.ground.at(0.3, 0), right.start)
    m.revolute("C", left.end, coupler.start)
    m.revolute("D", right.end, coupler.end)
    if extra:
        middle = m.bar("middle", 0.1, 0.2)
        m.revolute("E", m.ground.at(0.15, 0), middle.start)
        m.revolute("F", middle.end, coupler.at(0.15, 0))
        m.start_near(middle=60)
    m.start_near(left=60, right=60, coupler=0)
    return m


def test_four_bar_has_one_freedom() -> None:
    mobility = four_bar(drive=False).mobility()
    assert (mobility.nominal, mobility.dof, mobility.redundant, mobility.singular) == (1, 1, (), False)
    assert mobility.free_bodies == ("crank", "coupler", "rocker")


def test_a_third_parallel_crank_is_redundant_and_named() -> None:
    mobility = parallelogram().mobility()
    assert (mobility.nominal, mobility.dof, mobility.redundant_rows, mobility.redundant) == (0, 1, 1, ("F",))


def test_redundant_joints_move_and_share_the_load() -> None:
    m = parallelogram()
    m.drive_angle("motor", m.bodies["left"], constant_rate(0.5, math.radians(60)))
    sol = m.sweep(duration=1.0)
    np.testing.assert_allclose(sol.body("middle").theta, sol.body("left").theta, atol=1e-11)
    np.testing.assert_allclose(sol.body("coupler").theta, 0.0, atol=1e-11)
    assert sol.stats.power_residual < 1e-9
    lean = parallelogram(extra=False)
    lean.drive_angle("motor", lean.bodies["left"], constant_rate(0.5, math.radians(60)))
    lifted = 0.2 * 0.05 * 9.80665 * np.cos(sol.body("left").theta)  # the middle crank's own weight
    np.testing.assert_allclose(
        sol.driver("motor").torque, lean.sweep(duration=1.0).driver("motor").torque + lifted, atol=1e-9
    )


def test_redundant_joints_that_disagree_are_refused() -> None:
    m = parallelogram(extra=False)
    middle = m.bar("middle", 0.101)
    m.revolute("E", m.ground.at(0.15, 0), middle.start)
    m.revolute("F", middle.end, m.bodies["coupler"].at(0.15, 0))
    m.start_near(middle=60)
    m.drive_angle("motor", m.bodies["left"], constant_rate(0.5, math.radians(60)))
    with pytest.raises((AssemblyError, MobilityError), match=r"F|E"):
        m.sweep(duration=1.0)


def test_missing_driver_is_named_with_what_can_move() -> None:
    with pytest.raises(MobilityError, match=r"1 of 1 degree of freedom is not driven: crank, coupler, rocker"):
        four_bar(drive=False).sweep()


def test_two_drivers_on_one_freedom_are_named() -> None:
    m = four_bar()
    m.drive_angle("servo", m.bodies["rocker"], constant_rate(1.0, 1.7))
    m.start_near(rocker=100)
    with pytest.raises((MobilityError, AssemblyError), match="servo"):
        m.sweep()


def test_two_agreeing_drivers_are_refused_too() -> None:
    m = four_bar()
    m.drive_angle("copy", m.bodies["crank"], constant_rate(2 * math.pi))
    with pytest.raises(
        MobilityError, match="driver 'copy' drives a freedom that the joints and driver 'motor' already fix"
    ):
        m.sweep()


def test_links_that_cannot_close_say_by_how_much() -> None:
    with pytest.raises(
        AssemblyError, match=r"four_bar: the links do not close at t = 0 s: joint . stays open by .* mm"
    ) as error:
        four_bar(coupler=0.02, rocker=0.03).sweep()
    assert "coupler + rocker = 0.05 m must reach 0.08 m" in str(error.value)


def test_a_toggle_is_found_where_geometry_says() -> None:
    ground, crank, coupler, rocker = 0.12, 0.08, 0.07, 0.09
    limit = math.degrees(math.acos((ground**2 + crank**2 - (coupler + rocker) ** 2) / (2 * ground * crank)))
    with pytest.raises(SingularPoseError, match=r"beyond t = 0\.\d+ s \(motor at .* degrees\): a toggle") as error:
        four_bar(ground, crank, coupler, rocker).sweep()
    assert "Drive within the reachable range" in str(error.value)
    told = float(str(error.value).split("motor at ")[1].split(" degrees")[0])
    assert told == pytest.approx(limit, abs=0.05)


def test_a_sweep_without_a_natural_duration_asks_for_one() -> None:
    m = four_bar(drive=False)
    m.drive_angle("motor", m.bodies["crank"], lambda t: t)
    with pytest.raises(ModelError, match="duration"):
        m.sweep()


def test_forty_loops_have_one_freedom_and_a_repeated_pin_is_named() -> None:
    m = n_four_bar(40)
    assert str(m.mobility()) == "1 degree of freedom (1 nominal)"
    m.revolute("again", m.bodies["coupler 3"].end, m.bodies["rod 3"].end)
    assert m.mobility().redundant == ("again",)


def test_three_loops_on_one_line_have_the_freedom_they_have_elsewhere() -> None:
    """From there each loop may go on alone while the others stay singular; most poses near it show less rank."""
    m = n_four_bar(3)
    m.start_near(**{name: 0.0 for name in m.bodies if name.startswith("rod")})
    mobility = m.mobility()
    assert (mobility.dof, mobility.redundant_rows, mobility.singular) == (1, 0, True)
