"""Torques of driven mechanisms of the gallery, against their closed forms."""

from __future__ import annotations

import numpy as np

from mechanisms.scotch_yoke import mechanism as yoke
from mechanisms.toggle_clamp import mechanism as clamp


def test_scotch_yoke_is_a_cosine_and_its_spring_spares_the_motor() -> None:
    p = yoke.Params()
    sol = yoke.build(p).sweep()
    turn = p.speed * sol.t
    np.testing.assert_allclose(sol.body("yoke").x, p.crank * np.cos(turn), atol=1e-14)
    needed = p.mass * (p.crank * p.speed) ** 2 * np.sin(turn) * np.cos(turn)
    np.testing.assert_allclose(sol.driver("motor").torque, needed, atol=1e-14)
    tuned = yoke.build(yoke.Params(**yoke.VARIANTS["spring"])).sweep()
    assert np.abs(tuned.driver("motor").torque).max() < 1e-12 * np.abs(needed).max()


def test_scotch_yoke_without_a_motor_turns_as_its_energy_says() -> None:
    """(I + m r^2 sin^2 a) a'^2 + k r^2 cos^2 a is constant; in tune, k = m w^2, a' is constant."""
    for tune in (1.0, yoke.VARIANTS["free"]["tune"], 0.4):
        p = yoke.Params(tuned=True, driven=False, tune=tune)
        sol = yoke.build(p).simulate(yoke.VARIANTS["free"]["DURATION"], 400, tolerance=1e-11)
        crank, moved, stiffness = sol.body("crank"), p.mass * p.crank**2, tune * p.mass * p.speed**2
        held = stiffness * p.crank**2
        squares = (p.flywheel * p.speed**2 + held * np.sin(crank.theta) ** 2) / (
            p.flywheel + moved * np.sin(crank.theta) ** 2
        )
        np.testing.assert_allclose(crank.omega, np.sqrt(squares), rtol=1e-8)
        if tune == 1.0:
            np.testing.assert_allclose(crank.theta, p.speed * sol.t, atol=1e-7)
            np.testing.assert_allclose(sol.body("yoke").x, p.crank * np.cos(p.speed * sol.t), atol=1e-8)


def test_toggle_clamp_needs_no_hand_at_its_dead_point() -> None:
    p = clamp.Params()
    sol = clamp.build(p).sweep(steps=3600)
    hand, pad = sol.driver("hand"), sol.point("pad")
    work = hand.torque * hand.rate + p.force * pad.vy  # nothing has mass, so hand and workpiece balance
    assert np.abs(work).max() < 1e-11 * np.abs(p.force * pad.vy).max()
    past = hand.value < clamp.dead_point(p)
    assert 0 < past.mean() < 0.5
    # The workpiece drives the handle into the lock while it is past the dead point, and opens it before.
    assert (hand.torque[past] > 0).all()
    assert (hand.torque[~past] < 0).all()
    across = np.interp(-clamp.dead_point(p), -hand.value[3600 // 2 :], hand.torque[3600 // 2 :])
    assert abs(across) < 1e-3 * np.abs(hand.torque).max()
