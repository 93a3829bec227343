"""The gallery's Geneva drive and cam follower against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mechanisms.stages.loading import loading


@pytest.mark.parametrize("slots", [3, 4, 5, 6])
def test_geneva_drive_indexes_one_slot_a_turn(slots: int) -> None:
    """Norton, Design of Machinery, ch. 2: peak speed sin / (1 - sin), acceleration tan at the entry, of pi / slots."""
    module = loading.load("geneva_drive", "mechanism")
    p = module.Params(slots=slots)
    turn = 2 * math.pi / p.speed
    sol = module.build(p).sweep(turn, 1440)
    wheel, sine = sol.body("wheel"), math.sin(math.pi / slots)
    assert wheel.theta[-1] - wheel.theta[0] == pytest.approx(-2 * math.pi / slots, abs=1e-12)
    assert -wheel.omega.min() == pytest.approx(p.speed * sine / (1 - sine), rel=1e-12)  # the pin on the line of centres
    enters = turn / 2 - (math.pi / 2 - math.pi / slots) / p.speed
    at = int(np.searchsorted(sol.t, enters + 1e-9))  # the first output in the slot; at the entry itself it jumps
    assert np.abs(wheel.omega[: at - 1]).max() < 1e-12  # locked
    assert abs(wheel.alpha[at]) == pytest.approx(p.speed**2 * math.tan(math.pi / slots), rel=0.03)


def test_an_output_right_where_the_pin_enters_its_slot_has_the_acceleration_of_one_side() -> None:
    """Rounding decides on which side of the jump it is; the equations hold there all the same."""
    module = loading.load("geneva_drive", "mechanism")
    m = module.build(module.Params())
    sol = m.sweep(m.period(), steps=1440)
    jumps = np.abs(np.diff(sol.body("wheel").alpha)).max()
    assert jumps > 5.0
    assert sol.stats.acceleration_residual < 1e-7 * jumps


@pytest.mark.parametrize("follower", ["roller", "flat", "oscillating"])
def test_cam_follower_has_the_peaks_of_a_cycloidal_rise(follower: str) -> None:
    """Norton, Design of Machinery, ch. 8: over an angle b and a height h, 2 h / b omega and 2 pi h / b^2 omega^2."""
    module = loading.load("cam_follower", "mechanism")
    p = module.Params(follower=follower)
    sol = module.build(p).sweep(2 * math.pi / p.speed, 1440)
    body = sol.body("follower")
    height = p.lift / p.arm if follower == "oscillating" else p.lift
    place, rate, second = (
        (-body.theta, -body.omega, -body.alpha) if follower == "oscillating" else (body.y, body.vy, body.ay)
    )
    assert np.ptp(place) == pytest.approx(height, rel=1e-9)
    assert rate.max() == pytest.approx(2 * height / p.rise * p.speed, rel=1e-6)
    assert second.max() == pytest.approx(2 * math.pi * height / p.rise**2 * p.speed**2, rel=1e-4)
