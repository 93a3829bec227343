"""Time of the motion in a story: it never runs backwards, its rate is the slope, and it stops at the event."""

from __future__ import annotations

import numpy as np
import pytest

from render.film.story.ramps import Ramp, into, warped


def slope(at, s: float, h: float = 1e-5) -> float:
    return (at(s + h) - at(s - h)) / (2 * h)


def test_the_rate_is_the_slope_of_the_time() -> None:
    ramp = Ramp(2.0, ((1.0, 0.5, 0.5), (2.0, 0.5, 0.0), (1.5, 0.0, 0.0), (1.0, 0.0, 3.0)))
    assert ramp.seconds == 5.5
    assert ramp.time_at(0.0) == 2.0
    assert ramp.time_at(1.0) == pytest.approx(2.5)
    assert ramp.time_at(3.0) == ramp.time_at(4.4) == pytest.approx(3.0)  # slowing goes half as far
    assert ramp.time_at(9.0) == ramp.time_at(5.5) == pytest.approx(4.5)
    for s in np.linspace(0.05, 5.45, 61):
        if min(abs(s - edge) for edge in (1.0, 3.0, 4.5)) > 1e-3:
            assert slope(ramp.time_at, float(s)) == pytest.approx(ramp.rate(float(s)), abs=1e-6)


@pytest.mark.parametrize("event", [0.0, 0.1, 0.7, 30.0])
def test_it_stops_at_the_event_and_begins_within_the_motion(event: float) -> None:
    ramp = into(event, 0.0, 0.25, 1.0, 2.0)
    assert ramp.time_at(ramp.seconds) == pytest.approx(event, abs=1e-12)
    assert ramp.rate(ramp.seconds) == 0.0
    assert ramp.time_at(0.0) >= -1e-12
    assert ramp.rate(0.0) <= 0.25 + 1e-12
    assert ramp.rate(0.0) == pytest.approx(0.25 if event >= 0.5 else event / 2)


def test_what_is_dull_goes_fast() -> None:
    time = np.linspace(0, 10, 101)
    happens = np.where((time > 4) & (time < 5), 1.0, 0.0)
    warp = warped(time.tolist(), happens, 0.0, 10.0, 6.0)
    assert (warp.time_at(0.0), warp.time_at(6.0), warp.seconds) == (0.0, 10.0, pytest.approx(6.0))
    times = [warp.time_at(float(s)) for s in np.linspace(0, 6, 200)]
    assert np.all(np.diff(times) > 0)
    middle = float(np.interp(4.5, warp.motion, warp.film))
    assert warp.rate(middle) < 0.6 * warp.rate(0.5)
    assert warp.rate(middle) == pytest.approx(slope(warp.time_at, middle, 0.02 * 6), rel=1e-6)
