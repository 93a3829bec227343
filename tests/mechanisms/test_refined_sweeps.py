"""A sweep of a mechanism has more times where a link flies past a dead point, and only there."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mbsd import Mechanism, Solution, constant_rate
from mechanisms.quick_return import mechanism as shaper
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.solving import CLOSE


def _swept(p: shaper.Params) -> Solution:
    return solving.motion_of("quick_return", shaper, shaper.build(p), p)


def test_a_usual_motion_keeps_its_times() -> None:
    p = shaper.Params()
    np.testing.assert_array_equal(_swept(p).t, shaper.build(p).sweep().t)


def test_an_arm_that_flies_back_gets_more_times_and_keeps_its_period() -> None:
    """The crank is nearly as long as the arm's pivot is away: the arm swings back within 15 degrees of the crank.

    Half way between two times the quintic is the motion itself, known here: the arm points at the crank's pin.
    """
    p = replace(shaper.Params(), crank=0.0992, arm=0.3, ram=0.25, link=0.35)
    swept = _swept(p)
    assert swept.period == 2 * np.pi / p.speed
    rate = np.abs(swept.body("arm").omega)
    assert np.diff(swept.t)[rate[1:] > 0.5 * rate.max()].max() < 0.3 * np.median(np.diff(swept.t))
    assert _off(p, swept) < 2 * CLOSE < 1e-3 < _off(p, shaper.build(p).sweep())


def _off(p: shaper.Params, swept: Solution) -> float:
    """The largest difference of the quintic and the motion half way between two times (rad)."""
    h, arm = np.diff(swept.t), swept.body("arm")
    q, v, a = arm.theta, arm.omega, arm.alpha
    middle = (q[:-1] + q[1:]) / 2 + 5 * h / 32 * (v[:-1] - v[1:]) + h**2 / 64 * (a[:-1] + a[1:])
    crank = swept.body("crank").theta[0] + p.speed * (swept.t[:-1] + h / 2)
    exact = np.arctan2(p.height + p.crank * np.sin(crank), p.crank * np.cos(crank))
    return float(np.abs(np.exp(1j * middle) - np.exp(1j * exact)).max())


@pytest.mark.parametrize(("turns", "rows"), [(None, 361), (2.0, 721), (0.5, 361)])
def test_a_duration_of_two_turns_has_rows_for_both(turns: float | None, rows: int) -> None:
    m = Mechanism("wheel")
    m.revolute("O", m.ground.origin, m.body("disc").origin)
    m.drive_angle("motor", m.bodies["disc"], constant_rate(2.0))
    given = {} if turns is None else {"DURATION": turns * np.pi}
    assert len(solving.motion_of("wheel", SimpleNamespace(**given), m, None).t) == rows
