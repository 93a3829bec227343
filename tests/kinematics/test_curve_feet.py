"""The foot of a point on a curve is found whatever other part of the curve passes close by."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, harmonic
from mbsd.equations.relative.curve_pieces import CX, CY, OWN, REACH, foot
from mbsd.equations.system import LAST
from mbsd.model.plane_curves import curve_numbers, curve_pieces

HEIGHTS = [-0.0338, 0.0438, 0.0032, -0.0271, 0.0310, 0.0020, 0.0436, 0.0002, 0.0317, -0.0132, 0.0421, 0.0036, -0.0366]
DIPS = np.stack([np.linspace(-0.349, 0.349, 13), HEIGHTS], axis=1)
"""Beyond its last point but one the spline dips deep and comes up steeply beside its way down."""
ROUND = np.linspace(0.0, math.pi, 7)[1:-1]


def _hairpin(gap: float) -> np.ndarray:
    up = np.linspace(0.0, 3.0, 20)
    legs = [np.stack([np.full(20, side * gap), up], axis=1) for side in (-1.0, 1.0)]
    turn = -gap * np.stack([np.cos(ROUND), np.sin(ROUND)], axis=1)
    return np.concatenate([legs[0][::-1], turn, legs[1]])


CASES = {
    "dips": (DIPS, False, True),
    "hairpin": (_hairpin(0.05), False, True),
    "wide hairpin": (_hairpin(0.5), False, False),
    "comb": (np.stack([np.linspace(-1, 1, 12), 0.8 * (-1.0) ** np.arange(12)], axis=1), False, True),
    "ring": (np.stack([np.cos(np.arange(12) * math.pi / 6), np.sin(np.arange(12) * math.pi / 6)], axis=1), True, False),
}


@pytest.mark.parametrize("name", CASES)
def test_a_place_of_a_curve_is_its_own_foot(name: str) -> None:
    points, closed, doubtful = CASES[name]
    breaks, coefficients = curve_pieces(points, closed)
    own = curve_numbers(breaks, coefficients, closed, 0.0, 0.0)
    assert (own[REACH - 7] > 0.0) == doubtful
    numbers, scratch = np.concatenate([np.zeros(OWN), own]), np.zeros(32)
    scratch[LAST] = math.nan
    for u in np.linspace(breaks[0], breaks[-1], 400):
        k = min(int(np.searchsorted(breaks, u, "right")) - 1, len(coefficients) - 1)
        place = coefficients[k] @ (u - breaks[k]) ** np.arange(6)
        foot(numbers, *place, scratch)
        assert math.hypot(scratch[CX] - place[0], scratch[CY] - place[1]) < 1e-9, u


@pytest.mark.parametrize("steps", [3, 90, 1440])
def test_a_point_follows_a_curve_beside_itself_at_any_number_of_outputs(steps: int) -> None:
    m = Mechanism("dips")
    cart, pin = m.body("cart", 1.0, inertia=0.1), m.body("pin", 1.0, inertia=0.1)
    m.prismatic("rail", m.ground.at(0.0, 0.3), cart.origin)
    m.prismatic("drop", cart.at(0.0, 0.0, math.pi / 2), pin.at(0.0, 0.0, math.pi / 2))
    m.point_on_curve("curve", m.ground.origin, pin.origin, DIPS.tolist())
    m.drive_coordinate("push", m.ground.origin, cart.origin, harmonic(0.256, 3.6, mean=0.256, phase=-1.6))
    m.start_near(cart=(0.0, 0.3, 0.0), pin=(0.0, 0.0, 0.0))
    sol = m.sweep(math.pi / 1.8, steps=steps)
    assert sol.stats.position_residual < 1e-10
    first = m.sweep(math.pi / 1.8, steps=360)
    np.testing.assert_allclose(sol.body("pin").y[-1], first.body("pin").y[-1], atol=1e-9)
