"""Multipliers by the elimination sequence of J are those of a dense solve."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from mbsd import Mechanism, SingularPoseError, four_stroke
from mbsd.kinematics import multipliers
from mbsd.kinematics.prepared import prepare
from mbsd.machines.engines.engine import engine
from tools.models import linkages
from tools.models.shaft_machines import loom
from tools.random_mechanisms.linkages import driven_linkage

SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.14, "piston_mass": 0.5, "rod_mass": 0.4, "speed": 200.0}


def _by(m: Mechanism, duration: float | None, dense: int, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    monkeypatch.setattr(multipliers, "DENSE", dense)
    sol = m.sweep(duration, steps=90)
    return np.array([sol.joint(name).reaction for name in m.joints])


@pytest.mark.parametrize(
    ("make", "duration"),
    [
        (lambda: engine("V8", **SIZE, gas=four_stroke(10.0, heat_density=1e6)), None),
        (lambda: engine("V12", **SIZE), None),
        (loom, None),
        (lambda: linkages.lift(3), None),
        (lambda: driven_linkage(3, 3), 0.5),
        (lambda: driven_linkage(8, 5), 0.5),
    ],
)
def test_they_agree_with_a_dense_solve(
    make: Callable[[], Mechanism], duration: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = make()
    for body in list(m.bodies.values())[1:]:
        body.mass, body.inertia = body.mass or 0.3, body.inertia or 1e-3
    dense, sparse = (_by(m, duration, most, monkeypatch) for most in (10**6, 0))
    assert np.abs(dense).max() > 0.1
    np.testing.assert_allclose(sparse, dense, atol=1e-10 * np.abs(dense).max())


@pytest.mark.parametrize("dense", [0, 10**6])
def test_a_singular_pose_is_told_with_its_time(dense: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(multipliers, "DENSE", dense)
    ready, times = prepare(linkages.watt()), np.array([0.0, 0.25])
    q = np.vstack([ready.q0, ready.q0])
    _, compact, _ = multipliers._tabulated(ready.packed, ready.packed.drives(times), q, np.zeros_like(q))
    compact[1] = 0.0
    with pytest.raises(SingularPoseError, match=r"t = 0\.25 s is singular"):
        multipliers._multipliers(ready, times, compact, ready.packed.spread(compact), np.ones_like(q))
