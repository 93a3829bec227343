"""Pins with play: where they lie, by the reaction, and anywhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Clearance, Mechanism, ModelError, constant_rate, tolerances
from mbsd.measures import largest, samples
from tests.tolerancing.linkages import four_bar, rocker_angle

TIME, ANGLE = 0.3, 0.6 * math.pi


def weight() -> Mechanism:
    """A weight that hangs on a pin; it is turned slowly, so that its weight is all that acts."""
    m = Mechanism("weight")
    bar = m.bar("bar", 0.2, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), bar.start)
    m.drive_angle("motor", bar, constant_rate(1e-4, -math.pi / 2))
    m.trace("P", bar.end)
    return m


def test_a_weight_hangs_lower_by_half_the_play() -> None:
    t = tolerances(weight(), {"A": Clearance(2e-4, 1e-4)}, samples("P.y", [0.0]), n=500, duration=1.0, steps=1)
    assert t.values == pytest.approx(t.nominal - t.deviations[:, 0], abs=1e-12)
    assert t.deviations[:, 0].mean() == pytest.approx(1e-4, rel=0.05)
    assert t.slopes == pytest.approx([-1.0])
    assert t.linear_worst == pytest.approx((-0.2 - 1.5e-4, -0.2 - 0.5e-4))
    assert t.rows[0].slope == pytest.approx(-0.5)  # a unit of play is half a unit of gap
    assert "along the reaction: A" in t.way


@pytest.mark.parametrize("pin", ["B", "C"])
def test_the_gap_follows_the_reaction_at_each_time(pin: str) -> None:
    """The massless link of each time, put into the closed form of the linkage."""
    m = four_bar(mass=0.2)
    force = m.sweep(steps=10).joint(pin).reaction[3]
    along = force / np.hypot(*force)
    t = tolerances(m, {pin: Clearance(1e-5, 5e-6)}, samples("rocker.theta", [TIME]), n=20, steps=10)
    # A gap at C is one at B for the two circles; its direction is that in the ideal coupler's frame, to first order.
    exact = [rocker_angle(ANGLE, pin=-gap * along) for gap in t.deviations[:, 0]]
    assert t.values == pytest.approx(exact, abs=1e-12 if pin == "B" else 1e-8)
    assert np.abs(t.values - t.nominal).min() > 1e-6


def test_gaps_over_the_sweep_are_those_of_single_times() -> None:
    m = four_bar(mass=0.2)
    play = {"B": Clearance(1e-3, 5e-4), "D": Clearance(4e-4, 2e-4), "crank": 1e-4}
    high = tolerances(m, play, largest("rocker.theta"), n=30, steps=12)
    single = [
        tolerances(m, play, samples("rocker.theta", [k / 12]), n=30, steps=12).values for k in range(13)
    ]  # fmt: skip
    assert high.values == pytest.approx(np.max(single, axis=0), abs=1e-12)


def test_a_pin_has_a_place_and_a_play() -> None:
    """In the frame of the crank, which it is pushed in beside."""
    m = four_bar(mass=0.2)
    force = m.sweep(steps=10).joint("B").reaction[3]
    t = tolerances(
        m, {"B": {"x": 1e-4, "play": Clearance(1e-4, 5e-5)}}, samples("rocker.theta", [TIME]), n=20, steps=10
    )  # fmt: skip
    exact = [
        rocker_angle(ANGLE, crank=0.04 + x, pin=-gap * force / np.hypot(*force)) for x, gap in t.deviations
    ]  # fmt: skip
    assert t.values == pytest.approx(exact, abs=1e-12)
    assert t.columns == ("B.x", "B, half of its play")


def test_without_forces_the_gap_points_anywhere() -> None:
    """The variance is half of that of a gap along the gradient, the worst case all of it."""
    t = tolerances(four_bar(), {"B": Clearance(1e-4)}, samples("rocker.theta", [TIME]), n=20_000, steps=10)
    step = 1e-7
    gradient = np.array([
        (rocker_angle(ANGLE, pin=(step, 0)) - rocker_angle(ANGLE, pin=(-step, 0))) / (2 * step),
        (rocker_angle(ANGLE, pin=(0, step)) - rocker_angle(ANGLE, pin=(0, -step))) / (2 * step),
    ])  # fmt: skip
    size = float(np.hypot(*gradient))
    assert "in any direction: B" in t.way
    assert t.linear_std == pytest.approx(5e-5 * size / math.sqrt(2), rel=1e-4)
    assert t.std == pytest.approx(t.linear_std, rel=0.02)
    assert t.linear_worst[1] - t.nominal == pytest.approx(5e-5 * size, rel=1e-3)
    assert t.vertex_worst is not None
    assert t.vertex_worst[1] >= t.values.max() - 1e-12
    assert np.hypot(*t.deviations.T) == pytest.approx(5e-5)


def test_any_direction_in_machines_swept_one_by_one_is_the_same() -> None:
    play = {"B": Clearance(1e-4, direction="any"), "coupler": 1e-4, "crank": 1e-4}
    together, alone = (
        tolerances(four_bar(mass=0.2), play, samples("rocker.theta", [TIME]), n=20, steps=10, way=way)
        for way in ("batch", "sweep")
    )
    assert alone.values == pytest.approx(together.values, abs=1e-12)


def test_a_fit_is_a_play_with_its_tolerance() -> None:
    play = Clearance.from_fit(0.010, "H7/g6")
    assert play.limits == pytest.approx((5e-6, 29e-6))
    assert play.play == pytest.approx(17e-6)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Clearance(-1e-5),
        lambda: Clearance(0.0),
        lambda: Clearance(1e-5, 2e-5),
        lambda: Clearance(1e-5, direction="up"),
        lambda: Clearance(1e-5, spread="flat"),
        lambda: Clearance("H7/g6"),
        lambda: Clearance.from_fit(0.01, "H7/p6"),
        lambda: Clearance.from_fit(0.01, 7),
    ],
)
def test_invalid_play_is_refused(make) -> None:
    with pytest.raises(ModelError):
        make()


@pytest.mark.parametrize(
    ("mass", "result", "said"),
    [(None, "rocker.theta", "carries no force"), (0.2, "motor.effort", "not; take Clearance")],
)
def test_a_gap_without_a_direction_is_refused(mass: float | None, result: str, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        tolerances(four_bar(mass), {"B": Clearance(1e-5, direction="reaction")}, largest(result), n=5)
