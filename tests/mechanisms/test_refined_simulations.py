"""A simulation has more rows where something snaps, so many that the proof of clearance trusts what is between them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from mbsd import Mechanism, Solution, polynomial
from mechanisms.stages.clearance.path import paths
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.motion_file import to_motion

SIZE, PROVEN = 0.2, 0.2
"""Of the truss (m), and what the proof may doubt of its bars (mm)."""


def _truss() -> Mechanism:
    """Two flat bars between a pin and a spring of 400 N/mm, which a growing force pushes through (von Mises)."""
    m = Mechanism("truss")
    left, right = (m.bar(name, float(np.hypot(SIZE / 2, 0.03)), mass=0.05) for name in ("left", "right"))
    block = m.body("block", mass=0.1, inertia=1e-5)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, right.start)
    m.revolute("C", right.end, block.at(0, 0))
    m.prismatic("S", m.ground.at(0, 0), block.at(0, 0))
    m.spring("spring", m.ground.at(SIZE + 0.1, 0), block.at(0, 0), 4e5, free_length=0.1, damping=30.0)
    m.force("hand", left.end, polynomial(0.0, -20e3), (0.0, 1.0))
    m.start_near(left=17, right=-17)
    return m


def _doubted(solution: Solution) -> float:
    """How far the proof of clearance takes a bar to be from its quintic, at the most (mm)."""
    masses = dict.fromkeys(("left", "right", "block"), "mechanism")
    bodies = paths(to_motion(solution, None, "", {}, masses))
    return max(float(bodies[name].interpolation_error(1e3 * SIZE / 2).max()) for name in ("left", "right", "block"))


def test_a_truss_that_snaps_through_has_rows_for_the_proof() -> None:
    m = _truss()
    solution = solving.motion_of("truss", SimpleNamespace(DURATION=0.5), m, None)
    assert np.ptp(np.sign(solution.body("left").theta)) == 2.0
    assert _doubted(solution) < 3 * PROVEN < _doubted(m.simulate(0.5))
    assert len(solution.t) < 3000
    even = np.diff(solution.t)
    assert even.max() == pytest.approx(0.5 / 360)
    fast = np.abs(solution.body("left").omega)[1:] > 0.5 * np.abs(solution.body("left").omega).max()
    assert np.median(even[fast]) < 0.3 * even.max()


def test_of_too_many_steps_the_worst_are_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solving, "MOST_ROWS", 400)
    m = _truss()
    solution = solving.motion_of("truss", SimpleNamespace(DURATION=0.5), m, None)
    assert 380 < len(np.unique(solution.t)) <= 400
    assert _doubted(solution) < 0.7 * _doubted(m.simulate(0.5))


@pytest.mark.parametrize("own", ["STEPS", "motion()"])
def test_steps_of_ones_own_that_are_too_long_are_told(own: str, capsys: pytest.CaptureFixture[str]) -> None:
    m = _truss()
    given = {"STEPS": 300} if own == "STEPS" else {"motion": lambda m, p: m.simulate(0.5, 300)}
    assert len(solving.motion_of("truss", SimpleNamespace(DURATION=0.5, **given), m, None).t) == 301
    said = " ".join("".join(capsys.readouterr()).split())
    assert "too long for the fastest bodies, first at t = " in said
    assert f"leave out {own}, so that rows are added there" in said
