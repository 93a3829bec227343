"""Linkages of the gallery that draw, enlarged or straight, and lift, against their closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from mechanisms.pantograph import mechanism as pantograph
from mechanisms.peaucellier import mechanism as peaucellier
from mechanisms.scissor_lift import mechanism as lift


def test_pantograph_enlarges_place_speed_and_acceleration() -> None:
    p = pantograph.Params()
    sol = pantograph.build(p).sweep()
    drawn, copy = sol.point("drawn"), sol.point("copy")
    assert np.ptp(drawn.x) == pytest.approx(32 * p.size, rel=1e-3)
    for field, close in (("x", 1e-14), ("y", 1e-14), ("vx", 1e-11), ("vy", 1e-11), ("ax", 1e-9), ("ay", 1e-9)):
        np.testing.assert_allclose(getattr(copy, field), p.scale * getattr(drawn, field), atol=close)


def test_peaucellier_draws_a_straight_line() -> None:
    p = peaucellier.Params()
    pen = peaucellier.build(p).sweep().point("P")
    np.testing.assert_allclose(pen.x, (p.long**2 - p.side**2) / (2 * p.crank), rtol=1e-12)
    assert np.ptp(pen.y) > p.long / 2


def test_scissor_lift() -> None:
    p = lift.Params()
    sol = lift.build(p).sweep()
    foot, platform = sol.body("foot"), sol.body("platform")
    rise = np.sqrt(p.bar**2 - foot.x**2)
    np.testing.assert_allclose(platform.y, p.crosses * rise, atol=1e-14)
    np.testing.assert_allclose(platform.vy, -p.crosses * foot.x * foot.vx / rise, atol=1e-13)
    np.testing.assert_allclose(platform.theta, 0.0, atol=1e-13)
