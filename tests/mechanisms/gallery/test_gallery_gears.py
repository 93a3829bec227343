"""Gears of the gallery against their closed forms: Willis' equation, the dyads of a steering, Ackermann's condition."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.belt_drive import mechanism as belt
from mechanisms.planetary_gear import mechanism as planetary
from mechanisms.rack_steering import mechanism as steering
from shared.contract.geometry import BeltPath


@settings(max_examples=8, deadline=None)
@given(st.integers(12, 40), st.integers(12, 40), st.integers(2, 5), st.sampled_from(["ring", "carrier", "sun"]))
def test_planetary_gear_obeys_willis(sun: int, planet: int, planets: int, fixed: str) -> None:
    """(w_sun - w_carrier) / (w_ring - w_carrier) = -z_ring / z_sun; planets: (w - w_carrier) z_p = -(w_sun - w_c) z_s.

    R. Willis, Principles of Mechanism, 1841; VDI 2157.
    """
    p = replace(planetary.Params(), sun=sun, planet=planet, planets=planets, fixed=fixed)
    sol = planetary.build(p).sweep(0.5, steps=12)
    rate = {name: sol.body(name).omega for name in ("sun", "carrier")}
    rate["ring"] = np.zeros(13) if fixed == "ring" else sol.body("ring").omega
    driven = "ring" if fixed == "sun" else "sun"
    np.testing.assert_allclose(rate[fixed], 0.0, atol=1e-10)
    np.testing.assert_allclose(rate[driven], p.speed)
    from_carrier = {name: speed - rate["carrier"] for name, speed in rate.items()}
    np.testing.assert_allclose(from_carrier["sun"] * p.sun, -from_carrier["ring"] * p.ring, atol=1e-9)
    for k in range(1, planets + 1):
        own = sol.body(f"planet{k}").omega - rate["carrier"]
        np.testing.assert_allclose(own * p.planet, -from_carrier["sun"] * p.sun, atol=1e-9)


def test_planetary_gear_as_it_is() -> None:
    """18, 18 and 54 teeth: a quarter of the sun's speed, a third backwards, three quarters of the ring's."""
    for fixed, member, ratio in (("ring", "carrier", 1 / 4), ("carrier", "ring", -1 / 3), ("sun", "carrier", 3 / 4)):
        p = replace(planetary.Params(), fixed=fixed)
        m = planetary.build(p)
        assert m.sweep(0.1, steps=2).body(member).omega == pytest.approx(ratio * p.speed)
        assert (p.sun + p.ring) % p.planets == 0
        assert m.period() == pytest.approx(3.0 if fixed == "carrier" else 4.0)


def _steered(p: steering.Params, side: int, travel: np.ndarray) -> np.ndarray:
    """The knuckle's angle by its dyad: tie rod and arm meet where two circles do."""
    arm = p.arm * np.array([-side * math.sin(p.arm_angle), -math.cos(p.arm_angle)])
    kingpin, inner = np.array([side * p.track / 2, 0.0]), np.array([side * p.rack / 2, -p.behind])
    rod = np.hypot(*(kingpin + arm - inner))
    to = inner + np.stack([travel, np.zeros_like(travel)], axis=1) - kingpin
    away = np.hypot(*to.T)
    beside = np.arccos((p.arm**2 + away**2 - rod**2) / (2 * p.arm * away))
    return np.arctan2(to[:, 1], to[:, 0]) + side * beside - math.atan2(arm[1], arm[0])


def test_rack_steering_follows_its_dyads() -> None:
    p = steering.Params()
    sol = steering.build(p).sweep()
    travel = sol.body("rack").x
    assert travel.max() == pytest.approx(p.travel)
    np.testing.assert_allclose(travel, p.module * p.teeth / 2 * sol.body("pinion").theta, atol=1e-15)
    for side, name in ((-1, "left"), (1, "right")):
        np.testing.assert_allclose(sol.body(f"knuckle_{name}").theta, _steered(p, side, travel), atol=1e-12)


def test_rack_steering_is_near_ackermann() -> None:
    """What the docstring says: the inner wheel turns by 32 degrees, the outer is off by less than 0.5."""
    p = steering.Params()
    travel = np.linspace(1e-4, p.travel, 200)
    inner, outer = _steered(p, -1, travel), _steered(p, 1, travel)
    assert math.degrees(inner[-1]) == pytest.approx(32.0, abs=0.3)
    ideal = np.arctan(1 / (1 / np.tan(inner) + p.track / p.wheelbase))
    off = np.degrees(np.abs(outer - ideal))
    assert 0.3 < off.max() < 0.5
    assert np.degrees(inner - outer)[-1] > 7.0


@pytest.mark.parametrize("variant", [{}, {"crossed": True}, {"teeth": 16}])
def test_belt_drive_halves_the_speed(variant: dict[str, Any]) -> None:
    """r1 w1 = r2 w2, and of a crossed belt -r2 w2. The chain's length is a whole number of its pitch."""
    p = replace(belt.Params(), **variant)
    sol = belt.build(p).sweep()
    assert sol.t[-1] == pytest.approx(2.0)
    ratio = (-1 if p.crossed else 1) / p.ratio
    np.testing.assert_allclose(sol.body("large").theta, ratio * sol.body("small").theta, atol=1e-13)
    links = BeltPath(p.radius, p.ratio * p.radius, p.distance).length / (2 * math.pi * p.radius / 16)
    assert links == pytest.approx(56, abs=1e-4)
