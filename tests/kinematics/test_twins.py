"""A start that says two assemblies alike is told, with what was taken and how to choose; others are not."""

from __future__ import annotations

import math
import warnings

import pytest

from mbsd import Mechanism, ModelWarning, constant_rate


def engine(crank: float, **near: object) -> Mechanism:
    """A cylinder upright over its crank."""
    m = Mechanism("engine")
    shaft, rod, piston = m.bar("shaft", 0.05, 0.5), m.bar("rod", 0.15, 0.3), m.body("piston", 0.2)
    m.revolute("A", m.ground.origin, shaft.start)
    m.revolute("B", shaft.end, rod.start)
    m.revolute("C", rod.end, piston.origin)
    m.prismatic("cylinder", m.ground.at(0, 0, math.pi / 2), piston.at(0, 0, math.pi / 2))
    m.drive_angle("motor", shaft, constant_rate(10.0, crank))
    m.start_near(**near)  # pyright: ignore[reportArgumentType]
    return m


@pytest.mark.parametrize("crank", [0.0, 0.3, 1.2, 2.0, -1.0])
def test_an_engine_says_which_side_its_piston_took_and_how_to_choose(crank: float) -> None:
    m = engine(crank)
    with pytest.warns(ModelWarning, match=r"rod: the links close in two ways .* start_near\(rod=") as told:
        taken = m.sweep(0.1, steps=2).body("rod").theta[0]
    angle = math.degrees(math.remainder(taken, math.tau))
    said = str(told[0].message)
    assert f"start_near(rod={angle:.4g}) or start_near(rod={-angle:.4g})" in said
    for chosen in (angle, -angle):
        again = engine(crank, rod=chosen)
        assert not again.check()
        assert math.degrees(math.remainder(again.sweep(0.1, steps=2).body("rod").theta[0], math.tau)) == pytest.approx(
            chosen, abs=0.1
        )


@pytest.mark.parametrize(
    "near", [{"rod": 80}, {"rod": 150}, {"piston": (0, 0.15, 0)}, {"rod": -80, "piston": (0, -0.1, 0)}], ids=str
)
def test_a_start_that_says_it_is_enough(near: dict[str, object]) -> None:
    m = engine(0.3, **near)
    assert not m.check()
    up = near.get("rod", 80) > 0  # pyright: ignore[reportOperatorIssue]
    assert (m.sweep(0.1, steps=2).body("piston").y[0] > 0) == up


def test_one_of_several_dyads_is_named() -> None:
    m = engine(0.3, rod=80)
    other, second = m.bar("other", 0.15, 0.3), m.body("second", 0.2)
    m.revolute("D", m.bodies["shaft"].end, other.start)
    m.revolute("E", other.end, second.origin)
    m.prismatic("lower", m.ground.at(0, 0, -math.pi / 2), second.at(0, 0, -math.pi / 2))
    assert [finding.name for finding in m.check()] == ["other"]


def test_free_and_near_bodies_are_not_reported() -> None:
    m = Mechanism("pendulums")
    first, second = m.bar("first", 0.5, 1.0), m.bar("second", 0.5, 1.0)
    m.revolute("A", m.ground.origin, first.start)
    m.revolute("B", first.end, second.start)
    assert not m.check()
    four = Mechanism("four_bar")
    crank, coupler, rocker = four.bar("crank", 0.04, 0.1), four.bar("coupler", 0.12, 0.1), four.bar("rocker", 0.09, 0.1)
    four.revolute("A", four.ground.origin, crank.start)
    four.revolute("B", crank.end, coupler.start)
    four.revolute("C", coupler.end, rocker.end)
    four.revolute("D", four.ground.at(0.12, 0), rocker.start)
    four.drive_angle("motor", crank, constant_rate(2.0, 0.8))
    four.start_near(coupler=20, rocker=70)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        four.sweep()


@pytest.mark.parametrize("slope", [-0.4, 0.0, 0.3])
def test_bars_below_a_cart_start_at_the_angles_given(slope: float) -> None:
    """The cart has no place until its rail gives it one; then its pins place the bars."""
    m, given = Mechanism("chain"), {"upper": -124.0, "middle": -106.0, "lower": -44.0}
    cart = m.body("cart", 1.0, inertia=0.1)
    m.prismatic("rail", m.ground.at(0, 0, slope), cart.origin)
    at = cart.at(0.1, -0.1)
    for name, angle in given.items():
        bar = m.bar(name, 0.5, 1.0)
        m.revolute(name + " pin", at, bar.start)
        m.start_near(**{name: angle})
        at = bar.end
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sol = m.simulate(0.01, steps=1)
    for name, angle in given.items():
        assert math.degrees(sol.body(name).theta[0]) == pytest.approx(angle, abs=1e-9)
    assert math.hypot(sol.body("cart").x[0], sol.body("cart").y[0]) < 1e-12
