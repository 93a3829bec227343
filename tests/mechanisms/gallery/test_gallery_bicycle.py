"""The leg on a bicycle: the torque at the crank from virtual work, the work of the muscles as it was measured."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.results.solution import Solution
from mechanisms.bicycle_leg import mechanism as leg

MEASURED = {
    "hip_extensors": (0.27, 74.4),
    "hip_flexors": (0.04, 18.0),
    "knee_extensors": (0.39, 110.1),
    "knee_flexors": (0.10, 30.0),
}
"""Part of the positive work, and peak power (W).

M. O. Ericson et al.: Power output and work in different muscle groups during ergometer cycling. Eur. J. Appl. Physiol.
55 (1986) 229-235, abstract: 120 W at 60 turns a minute, 20 % from the ankle, negative work of 3.4 J a leg and turn.
"""
POSITIVE = 120 / 2 / 1.0 + 3.4
"""Work of one leg in one turn (J)."""


@pytest.fixture(scope="module")
def sol() -> Solution:
    return leg.build(leg.Params()).sweep(steps=720)


def lower_leg(p: leg.Params) -> tuple[float, tuple[float, float], float]:
    """Winter's shank and foot, stiff: mass (kg), centre (m) from the ball towards the knee, inertia (kg m^2)."""
    calf, sole = 0.246 * p.height, (0.48 * 0.152 * p.height, 0.039 * p.height)  # the ankle above and behind the ball
    foot = math.hypot(*sole)
    at_ankle = math.radians(p.ankle) + math.atan2(sole[1], sole[0])
    to_knee = math.sqrt(calf**2 + foot**2 - 2 * calf * foot * math.cos(at_ankle))
    at_ball = math.asin(calf * math.sin(at_ankle) / to_knee)  # between the foot and the way to the knee
    ankle = np.array([foot * math.cos(at_ball), foot * math.sin(at_ball)])  # behind that way, where the heel is
    knee = np.array([to_knee, 0.0])
    weights = 0.0145 * p.rider, 0.0465 * p.rider
    centres = 0.5 * ankle, ankle + 0.567 * (knee - ankle)
    mass = sum(weights)
    com = (weights[0] * centres[0] + weights[1] * centres[1]) / mass
    own = weights[0] * (0.475 * foot) ** 2 + weights[1] * (0.302 * calf) ** 2
    moved = sum(w * ((c - com) ** 2).sum() for w, c in zip(weights, centres, strict=True))
    return mass, (float(com[0]), float(com[1])), float(own + moved)


def places(p: leg.Params, crank: np.ndarray) -> dict[str, np.ndarray]:
    """Centres of mass (x, y) and angles of crank, shank and thigh for angles of the crank, by circles."""
    slope = math.radians(p.slope)
    hip = p.hip * np.array([-math.cos(slope), math.sin(slope)])[:, None]
    pedal = p.crank * np.stack([np.cos(crank), np.sin(crank)])
    way = pedal - hip
    away = np.hypot(*way)
    at_hip = np.arccos((p.thigh**2 + away**2 - p.shank**2) / (2 * p.thigh * away))
    thigh = np.arctan2(way[1], way[0]) + at_hip  # the knee is in front
    to_knee = np.stack([np.cos(thigh), np.sin(thigh)])
    shank_way = hip + p.thigh * to_knee - pedal
    along = shank_way / p.shank
    across = np.stack([-along[1], along[0]])
    x, y = lower_leg(p)[1]
    return {
        "crank": np.stack([*(0.5 * pedal), crank]),
        "thigh": np.stack([*(hip + 0.433 * p.thigh * to_knee), thigh]),
        "shank": np.stack([*(pedal + x * along + y * across), np.arctan2(shank_way[1], shank_way[0])]),
    }


def test_the_torque_at_the_crank_is_that_of_virtual_work(sol: Solution) -> None:
    """J'(a) w^2 / 2 + V'(a) - muscles, at constant speed w; derivatives by central differences."""
    p = leg.Params()
    crank = sol.body("crank")
    step = 1e-5
    around = {k: places(p, crank.theta + k * step) for k in (-2, -1, 0, 1, 2)}
    masses = {
        "crank": (p.crank_mass, p.crank_mass * p.crank**2 / 12),
        "thigh": (0.100 * p.rider, 0.100 * p.rider * (0.323 * p.thigh) ** 2),
        "shank": lower_leg(p)[::2],
    }
    slopes = {}
    wanted = np.zeros(len(sol.t))
    for body, (mass, inertia) in masses.items():
        angle = around[0][body][2]
        np.testing.assert_allclose(angle, sol.body(body).theta, atol=1e-12)
        narrow, wide = ((around[k][body] - around[-k][body]) / (2 * k * step) for k in (1, 2))
        slopes[body] = (4 * narrow - wide) / 3
        bends = (around[1][body] - 2 * around[0][body] + around[-1][body]) / step**2
        weights = np.array([mass, mass, inertia])[:, None]
        wanted += (weights * slopes[body] * bends).sum(axis=0) * crank.omega**2 + 9.81 * mass * slopes[body][1]
    hip, knee = slopes["thigh"][2], slopes["shank"][2] - slopes["thigh"][2]
    for muscle in MEASURED:
        wanted -= sol.force(muscle).effort * (hip if muscle.startswith("hip") else knee)
    torque = sol.driver("bicycle").torque
    np.testing.assert_allclose(torque, wanted, atol=2e-4)
    top = int(torque.argmax())
    assert 80 < 360 * sol.t[top] < 110  # largest where the crank is level
    assert torque[np.abs(sol.t - 0.8).argmin()] < 0  # the leg is lifted


def test_muscles_do_the_work_that_was_measured(sol: Solution) -> None:
    done = {muscle: float(np.trapezoid(sol.force(muscle).power, sol.t)) for muscle in MEASURED}
    for muscle, (part, peak) in MEASURED.items():
        assert done[muscle] == pytest.approx(part * POSITIVE, rel=0.02), muscle
        assert sol.force(muscle).power.max() == pytest.approx(peak, rel=0.15), muscle
        assert sol.force(muscle).power.min() > -0.5, muscle  # no muscle brakes
    given = -float(np.trapezoid(sol.driver("bicycle").power, sol.t))
    assert given == pytest.approx(sum(done.values()), rel=1e-6)  # what the leg swings comes back


def test_without_muscles_the_bicycle_drives_the_leg_and_gets_all_of_it_back() -> None:
    p = leg.Params(**leg.VARIANTS["no_muscles"])
    power = leg.build(p).sweep().driver("bicycle").power
    assert abs(np.trapezoid(power)) < 1e-6 * np.trapezoid(np.abs(power))
