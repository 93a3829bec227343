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
