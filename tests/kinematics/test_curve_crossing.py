"""Curves that cross themselves: points and discs go on along their branch."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from mbsd import BranchError, Mechanism, ModelError, polynomial
from mbsd.kinematics.limits.joints import refuse_jumps

ROUND = np.linspace(0.0, 2 * math.pi, 65)[:-1]
EIGHT = np.stack([np.sin(ROUND), 0.5 * np.sin(2 * ROUND)], axis=1)
"""Lemniscate of Gerono, crossing itself at (0, 0)."""


def _coaster(speed: float = 6.5) -> Mechanism:
    m = Mechanism("coaster")
    bead = m.body("bead", 1.0, inertia=1e-3)
    m.point_on_curve("track", m.ground.at(0, 0), bead.origin, EIGHT.tolist(), closed=True)
    m.start_near(bead=(*EIGHT[10], 0))
    m.start_moving(bead=(math.cos(ROUND[10]) * speed, math.cos(2 * ROUND[10]) * speed, 0.0))
    return m


def _branches(sol) -> np.ndarray:
    """(T,) speed across the branch of the lemniscate that the bead moves along, over its speed."""
    bead = sol.body("bead")
    a = np.arctan2(bead.x, np.cos(np.arcsin(np.clip(bead.x, -1, 1))))
    slopes = [np.stack([c * np.cos(a), np.cos(2 * a)]) for c in (1.0, -1.0)]
    v = np.stack([bead.vx, bead.vy]) / np.hypot(bead.vx, bead.vy)
    return np.min([np.abs(s[0] * v[1] - s[1] * v[0]) / np.hypot(*s) for s in slopes], axis=0)


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
@pytest.mark.parametrize(
    ("method", "options", "allowed"),
    [
        ("dop853", {"tolerance": 1e-9}, 5e-6),
        ("radau", {}, 1e-5),
        ("rk4", {"step": 2e-3}, 2e-4),
        ("dop853", {"tolerance": 1e-4}, 0.05),
    ],
)
def test_a_bead_goes_round_an_eight(method: str, options: dict, allowed: float) -> None:
    sol = _coaster().simulate(3.0, steps=150, method=method, **options)
    bead = sol.body("bead")
    assert (np.diff(np.sign(bead.x)) != 0).sum() > 4  # it passes the crossing over and over
    assert np.ptp(sol.audit) < allowed
    step = np.hypot(np.diff(bead.x), np.diff(bead.y)).max()
    assert step < 1.2 * 0.02 * np.hypot(bead.vx, bead.vy).max()
    assert _branches(sol).max() < 0.05
    turn = np.abs(np.diff(np.unwrap(np.arctan2(bead.vy, bead.vx))))
    assert turn.max() < 1.0  # no corner


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
def test_events_outputs_between_and_files_follow_it_too(tmp_path: Path) -> None:
    plain = _coaster().simulate(2.0, steps=100, tolerance=1e-9)
    watched = _coaster()
    watched.event("middle", lambda t, s: s.body("bead").x)
    met = watched.simulate(2.0, steps=100, tolerance=1e-9)
    np.testing.assert_allclose(met.q, plain.q, atol=1e-6)
    assert len(met.events) >= 3
    at = np.sort(np.append([event.time for event in met.events], np.random.default_rng(0).uniform(0.0, 2.0, 30)))
    for sol in (plain, met):
        between = sol.at(at)
        assert np.ptp(between.audit) < 5e-6
        reaction, bead = between.joint("track"), between.body("bead")
        np.testing.assert_allclose(reaction.fx * bead.vx + reaction.fy * bead.vy, 0.0, atol=1e-7)
    path = tmp_path / "coaster.json"
    _coaster().save(path)
    again = Mechanism.load(path).simulate(2.0, steps=100, tolerance=1e-9)
    np.testing.assert_array_equal(again.q, plain.q)


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
def test_a_disc_rolls_through_a_loop() -> None:
    u = np.linspace(-6.0, 12.0, 160)
    track = np.stack([0.35 * u - 1.2 * np.sin(u), 1.2 * (1 + np.cos(u))], axis=1)[::-1] * [-1, 1]
    m = Mechanism("loop", gravity=None)
    disc = m.body("disc", 1.0, inertia=0.5 * 0.05**2)
    m.rolling_on_curve("roll", m.ground.at(0, 0), disc.origin, track.tolist(), radius=0.05)
    slope = track[21] - track[19]
    slope /= np.hypot(*slope)
    m.start_near(disc=(track[20, 0] - 0.05 * slope[1], track[20, 1] + 0.05 * slope[0], 0))
    m.start_moving(disc=(*(9.0 * slope), -180.0))
    sol = m.simulate(1.6, steps=200, tolerance=1e-9)
    disc = sol.body("disc")
    speed = np.hypot(disc.vx, disc.vy)
    turned = np.unwrap(np.arctan2(disc.vy, disc.vx))
    assert np.ptp(turned) > 2 * math.pi  # over the loop, and its crossing
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-5 * sol.audit[0]
    np.testing.assert_allclose(speed, 0.05 * np.abs(disc.omega), rtol=1e-9)


def test_a_sweep_passes_a_crossing_and_is_refused_where_it_may_have_left_its_branch() -> None:
    def driven() -> Mechanism:
        m = Mechanism("shuttle", gravity=None)
        bead = m.body("bead", 1.0, inertia=1e-3)
        m.point_on_curve("track", m.ground.at(0, 0), bead.origin, EIGHT.tolist(), closed=True)
        m.drive_coordinate("x", m.ground.at(0, 0), bead.origin, polynomial(-0.4, 0.83))
        m.drive_angle("hold", bead, polynomial(0.0))
        m.start_near(bead=(-0.4, -0.36, 0))
        return m

    sol = driven().sweep(1.0, steps=60)
    x = sol.body("bead").x
    np.testing.assert_allclose(sol.body("bead").y, x * np.sqrt(1 - x**2), atol=1e-4)
    at_crossing = driven()
    at_crossing.change("x", law=polynomial(-0.4, 0.8))  # an output falls on it
    y = at_crossing.sweep(1.0, steps=4).body("bead").y
    np.testing.assert_allclose(
        y[[0, 1, 3, 4]], np.array([-0.4, -0.2, 0.2, 0.4]) * np.sqrt(1 - np.array([0.4, 0.2, 0.2, 0.4]) ** 2), atol=1e-4
    )
    poses = sol.q.reshape(len(sol.t), -1).copy()
    refuse_jumps(sol.packed, sol.t, poses)
    poses[sol.t > 0.6, 4] *= -1  # on the other branch
    with pytest.raises(BranchError, match=r"shuttle: joint 'track': its curve crosses itself\. Between t = 0\.6 and"):
        refuse_jumps(sol.packed, sol.t, poses)


def test_a_terrain_that_crosses_itself_has_no_side() -> None:
    m = Mechanism("ground")
    ball = m.body("ball", 1.0, inertia=1.0)
    with pytest.raises(ModelError, match=r"ground: contact 'floor': the curve crosses itself near"):
        m.rigid_terrain("floor", m.ground.at(0, 0), ball.origin, EIGHT.tolist(), closed=True)
