"""Limits of joints: refused with joint, time, number and remedy; a motion that only touches them passes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import LimitError, Mechanism, ModelError, constant_rate, harmonic
from mbsd.kinematics.limits.joints import coordinate, limits_of
from mbsd.kinematics.march import march_along
from mbsd.kinematics.prepared import prepare


def _slider_crank(**limits: Any) -> Mechanism:
    m = Mechanism("press", gravity=None)
    crank, rod, slider = m.bar("crank", 0.1), m.bar("rod", 0.3), m.body("slider", 1.0)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, rod.start, limits=limits.get("elbow"))
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0.05, 0.0), slider.origin, limits=limits.get("guide"))
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0, rod=0)
    return m


def test_a_motion_within_its_limits_passes_even_where_it_touches() -> None:
    free = _slider_crank().sweep()
    same = _slider_crank(guide=(0.15, 0.35), elbow=(None, 0.0)).sweep()  # the dead centres, and elbow never above 0
    np.testing.assert_array_equal(free.q, same.q)


@pytest.mark.parametrize(
    ("limits", "says"),
    [
        (
            {"guide": (0.2, None)},
            r"press: at t = 0\.3\d+ s joint 'guide' passes its lower limit of 0.2 m; .* to 0.15 m",
        ),
        ({"guide": (0.0, 0.34)}, r"press: at t = 0 s joint 'guide' passes its upper limit of 0.34 m; .* to 0.35 m"),
        ({"elbow": (-math.pi / 2, None)}, r"at t = 0\.\d+ s joint 'A' passes its lower limit of -90 degrees"),
        ({"elbow": (-math.pi / 2, None), "guide": (0.16, None)}, "joint 'A'"),
    ],
)
def test_a_passed_limit_is_refused_with_the_number(limits: dict[str, Any], says: str) -> None:
    with pytest.raises(LimitError, match=says):
        _slider_crank(**limits).sweep(steps=720)


def test_coordinates_of_limited_joints_in_moving_axes() -> None:
    """A slide on a turning bar, markers turned: the coordinate is what was driven."""
    m = Mechanism("crane", gravity=None)
    boom, hook = m.bar("boom", 1.0), m.body("hook", 1.0, (0.1, 0.2))
    m.revolute("pivot", m.ground.at(0, 0, 0.3), boom.at(0, 0, -0.4), limits=(-5.0, 5.0))
    guide = boom.at(0.2, 0.1, 0.5)
    m.prismatic("slide", guide, hook.at(0.05, 0.0, 0.7), limits=(-1.0, 1.0))
    m.drive_angle("turn", boom, harmonic(0.8, 2.0))
    m.drive_coordinate("pull", guide, hook.at(0.05, 0.0), harmonic(0.4, 3.0, 0.2))
    t = np.linspace(0.0, 2.0, 50)
    ready = prepare(m, 0.0, 2.0)
    q = march_along(ready, t).q
    pivot, slide = limits_of(ready.packed)
    np.testing.assert_allclose(coordinate(ready.packed, slide, q), 0.4 * np.sin(3 * t + 0.2), atol=1e-12)
    np.testing.assert_allclose(coordinate(ready.packed, pivot, q), 0.8 * np.sin(2 * t) - 0.7, atol=1e-12)


def test_a_free_motion_stops_at_its_limit() -> None:
    m = Mechanism("swing")
    rod = m.bar("rod", 1.0, 1.0)
    m.revolute("pin", m.ground.origin, rod.start, limits=(-math.pi, -math.radians(60)))
    m.start_near(rod=-90)
    m.start_moving(rod=1.0)
    assert not m.simulate(duration=0.2, steps=20).events
    m.start_moving(rod=4.0)
    m.start_near(rod=270)
    sol = m.simulate(duration=1.0, steps=200)
    assert (sol.events[0].name, sol.events[0].what) == ("pin upper", "impact")
    assert sol.at(sol.events[0].time).body("rod").theta[0] == pytest.approx(math.radians(300), abs=1e-11)
    assert sol.body("rod").theta.max() < math.radians(300)


def test_limits_that_cannot_be_are_refused_and_limits_are_saved(tmp_path: Path) -> None:
    for limits, says in (
        ((1.0, 0.5), "lower must be below"),
        ((None, None), "on a free side"),
        (3.0, "on a free side"),
    ):
        with pytest.raises(ModelError, match=says):
            _slider_crank(guide=limits)
    m = _slider_crank(guide=(0.2, None))
    m.save(tmp_path / "press.json")
    loaded = Mechanism.load(tmp_path / "press.json")
    assert tuple(loaded.joints["guide"].params["limits"]) == (0.2, None)
