"""How cranks let pistons down: derivatives, dead centres, and the throw that a given stroke needs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.model.cylinders.engine_cylinder import given_motion
from mbsd.model.cylinders.piston_motion import ArticulatedMotion, PistonMotion

PHI = np.linspace(-math.pi, math.pi, 73)
MOTIONS = {
    "centred": PistonMotion(0.04, 0.13),
    "offset": PistonMotion(0.04, 0.13, 0.012),
    "clockwise": PistonMotion(0.04, 0.13, -0.02, -1.0),
    "yoke": PistonMotion(0.04),
    "hung": ArticulatedMotion(0.04, 0.15, 0.0, (0.02, 0.028), 1.2, 0.115, 0.0),
    "hung, offset and clockwise": ArticulatedMotion(0.04, 0.15, 0.008, (-0.03, 0.01), -2.4, 0.12, -0.01, -1.0),
}


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS.keys())
def test_the_slope_is_that_of_the_way_and_zero_at_the_top(motion: PistonMotion | ArticulatedMotion) -> None:
    step = 1e-5
    slope = (motion.below(PHI + step) - motion.below(PHI - step)) / (2 * step)
    assert motion.slope(PHI) == pytest.approx(slope, abs=1e-10)
    assert motion.below(np.zeros(1)) == pytest.approx(0.0, abs=1e-16)
    assert motion.slope(np.zeros(1)) == pytest.approx(0.0, abs=1e-12)
    fine = motion.below(np.linspace(-math.pi, math.pi, 20001))
    assert fine.min() >= -1e-16
    assert fine.max() == pytest.approx(motion.stroke, rel=1e-7)


def test_a_rod_that_hangs_at_the_big_end_is_one_of_its_own() -> None:
    hung = ArticulatedMotion(0.04, 0.15, 0.0, (0.0, 0.0), 0.9, 0.13, 0.01)
    own = PistonMotion(0.04, 0.13, 0.01)
    assert hung.below(PHI) == pytest.approx(own.below(PHI), abs=1e-15)
    assert hung.reach == pytest.approx(own.reach)
    assert math.remainder(hung.top - 0.9 - own.top, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("offset", [0.0, 0.015])
def test_a_given_stroke_finds_its_throw(offset: float) -> None:
    assert given_motion("gas", 0.09, 0.14, offset, 1.0).stroke == pytest.approx(0.09, rel=1e-13)
