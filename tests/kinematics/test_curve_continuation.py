"""Open curves whose straight continuations cross them or pass close by: points keep their branch and their energy."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from mbsd import Mechanism, ModelError
from mbsd.model.plane_curves import curve_pieces, farthest_step

pytestmark = pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
ARC = np.linspace(-2.5, 2.5, 25)
TURNS = np.linspace(0.0, 4 * math.pi, 60)
LOOP = np.linspace(0.04, math.pi - 0.04, 41)
SPIRAL = (1 - 0.06 * TURNS)[:, None] * np.stack([np.sin(TURNS), -np.cos(TURNS)], axis=1)
CASES = {
    "an arc of 286 degrees, whose continuations cross": (
        np.stack([np.sin(ARC), np.cos(ARC)], axis=1), (math.sin(0.1), math.cos(0.1)), (0.0, 0.0),
    ),
    "a spiral whose end runs through its outer turn": (SPIRAL, (0.0, -1.0), (6.0, 0.0)),
    "a loop that begins and ends near its crossing": (
        np.stack([0.5 * np.sin(2 * LOOP), np.sin(LOOP)], axis=1), (0.0, 1.0), (-2.0, 0.0),
    ),
    "a hook whose short leg goes on beside the long one": (
        np.array([(1, 3), (1, 2), (1, 1), (1, 0), (1, -1), (0.9, -1.5), (0.5, -1.8), (0.1, -1.5), (0, -1), (0, 0)]),
        (-0.0732, 0.3), (-1.66, 6.8),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_a_point_keeps_its_energy_beyond_the_ends(case: str) -> None:
    points, start, velocity = CASES[case]
    m = Mechanism("wire")
    bead = m.body("bead", 1.0, inertia=0.01)
    m.point_on_curve("track", m.ground.origin, bead.origin, np.asarray(points, float).tolist())
    m.start_near(bead=(*start, 0))
    m.start_moving(bead=(*velocity, 0.0))
    sol = m.simulate(5.0, steps=50, tolerance=1e-9)
    place = np.stack([sol.body("bead").x, sol.body("bead").y])
    assert np.hypot(*(place - np.mean(points, axis=0)[:, None])).max() > 2.0  # it has left the curve
    assert np.ptp(sol.audit) < 1e-6 * max(1.0, float(sol.energy.kinetic.max()))


def test_a_disc_rolls_out_of_a_spiral() -> None:
    m = Mechanism("spiral")
    disc = m.body("disc", 1.0, inertia=0.5 * 0.03**2)
    m.rolling_on_curve("track", m.ground.origin, disc.origin, SPIRAL.tolist(), 0.03)
    m.start_near(disc=(0.0, -0.97, 0))
    m.start_moving(disc=(6.0, 0.0, -200.0))
    sol = m.simulate(4.0, steps=50, tolerance=1e-9)
    assert sol.body("disc").x[-1] > 5.0
    assert np.ptp(sol.audit) < 1e-6 * float(sol.energy.kinetic.max())


def test_a_first_point_that_is_repeated_asks_for_closed() -> None:
    a = np.linspace(0.0, 2 * math.pi, 25)
    ring = np.stack([np.cos(a), np.sin(a)], axis=1).tolist()  # sin(2 pi) is not quite zero
    for add in ("point_on_curve", "rolling_on_curve", "rigid_terrain"):
        m = Mechanism("ring")
        more = (0.1,) if add == "rolling_on_curve" else ()
        with pytest.raises(ModelError, match=r"the last of 25 points repeats the first, \(1, 0\) m.* closed=True"):
            getattr(m, add)("track", m.ground.origin, m.body("bead").origin, ring, *more)
        getattr(m, add)("track", m.ground.origin, m.bodies["bead"].origin, ring, *more, closed=True)
        table = {**m.joints, **m.contacts}["track"]
        assert len(table.params["points"]) == 24


def test_a_terrain_whose_continuation_runs_through_it_has_no_side() -> None:
    m = Mechanism("ground")
    ball = m.body("ball", 1.0, inertia=1.0)
    with pytest.raises(
        ModelError, match=r"the curve crosses the straight line on which it goes on beyond its end near"
    ):
        m.rigid_terrain("floor", m.ground.origin, ball.origin, SPIRAL.tolist())
    bowl = np.stack([np.sin(ARC * 0.7), -np.cos(ARC * 0.7)], axis=1)  # the lines cross each other, far above
    m.rigid_terrain("bowl", m.ground.origin, ball.origin, bowl.tolist())


def test_crossings_are_looked_for_once() -> None:
    pieces = curve_pieces(np.random.default_rng(0).normal(size=(200, 2)).cumsum(axis=0), False)
    began = time.perf_counter()
    step = farthest_step(*pieces, False, 0.0)
    looked = time.perf_counter() - began
    began = time.perf_counter()
    assert farthest_step(*pieces, False, 0.0) == step > 0.0
    assert time.perf_counter() - began < 0.2 * looked
