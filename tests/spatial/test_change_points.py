"""Change points of sweeps in space are passed on the smooth continuation, with reactions, in any orientation."""

from __future__ import annotations

import math

import numpy as np
import pytest

import mbsd
from mbsd.base.errors import ModelError
from mbsd.spatial import Mechanism, polynomial
from mbsd.spatial.model.rotation import rotation_matrix
from tests.spatial.machines import about
from tests.spatial.test_invariance import in_space

SHORT, LONG, START = math.radians(30), math.radians(70), 0.5
SMOOTH = math.cos((LONG + SHORT) / 2) / math.cos((LONG - SHORT) / 2)
"""tan(rocker / 2) / tan(crank / 2), a constant of the motion."""
OTHER = -math.sin((LONG + SHORT) / 2) / math.sin((LONG - SHORT) / 2)
"""The same on the other assembly."""
TIMES = np.linspace(0.0, 6.3, 101)


def parallelogram() -> mbsd.Mechanism:
    m = mbsd.Mechanism("parallelogram", gravity=(0.0, -9.81))
    crank, coupler, rocker = (m.bar(*named, mass=1.0) for named in (("crank", 0.1), ("coupler", 0.3), ("rocker", 0.1)))
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.3, 0), rocker.start)
    m.drive_angle("motor", crank, mbsd.constant_rate(3.0))
    m.start_near(crank=0, coupler=0, rocker=0)
    return m


def spherical(balls: bool) -> Mechanism:
    """Return a four-bar of arcs about the origin, opposite ones equal, and a geared shaft; it folds flat twice."""
    first, last = np.array([0.0, 0.0, 1.0]), np.array([math.sin(LONG), 0.0, math.cos(LONG)])
    flat = [np.array([math.sin(turn), 0.0, math.cos(turn)]) for turn in (SHORT, SHORT + LONG)]
    b, c = about(first, START) @ flat[0], about(last, 2.0 * math.atan(SMOOTH * math.tan(START / 2))) @ flat[1]
    m = Mechanism("spherical parallelogram", gravity=(0, 0, -9.81))
    crank, coupler, rocker = (
        m.rod(name, *ends, mass=1.0, radius=0.02)
        for name, ends in (("crank", (first, b)), ("coupler", (b, c)), ("rocker", (c, last)))
    )
    m.revolute("A", m.ground, crank, at=first, axis=first)
    m.revolute("D", m.ground, rocker, at=last, axis=last)
    if balls:
        m.spherical("B", crank, coupler, at=b)
        m.universal("C", rocker, coupler, at=c, first=c, second=np.cross(c, c - b))
    else:
        m.revolute("B", crank, coupler, at=b, axis=b)
        m.revolute("C", rocker, coupler, at=c, axis=c)
    shaft = m.shaft("shaft", (2, 0, 0), (3, 0, 0), radius=0.05)
    m.revolute("E", m.ground, shaft, at=(2, 0, 0), axis=(1, 0, 0))
    m.gear_pair("gears", "D", "E", teeth=(17, 31))
    m.drive_turn("motor", "A", polynomial(0.0, 1.0))
    return m


@pytest.mark.parametrize("seed", [1, 2])
def test_a_parallelogram_in_any_orientation_gives_the_planar_numbers(seed: int) -> None:
    plane, times = parallelogram(), np.linspace(0.2, 2.4, 51)
    sol = plane.sweep(times=times)
    random = np.random.default_rng(seed)
    turned, shift = rotation_matrix(random.standard_normal(4)), random.uniform(-1.0, 1.0, 3)
    m = in_space(plane, sol, turned, shift)
    m.change("motor", law=polynomial(-0.6, 3.0))
    space = m.sweep(times=times)
    assert np.allclose(space.driver("motor").torque, sol.driver("motor").torque, rtol=0, atol=1e-9)
    for name in plane.joints:
        flat, view = sol.joint(name), space.joint(name)
        assert np.allclose((view.place - shift) @ turned, np.column_stack([flat.x, flat.y, 0 * flat.x]), atol=1e-12)
        wanted = np.column_stack([flat.fx, flat.fy, 0 * flat.fx])
        assert np.allclose(view.force @ turned, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("balls", [False, True])
def test_arcs_that_fold_flat_go_on_smoothly(balls: bool) -> None:
    sol = spherical(balls).sweep(times=TIMES)
    crank, rocker = START + sol.joint("A").turn, 2.0 * math.atan(SMOOTH * math.tan(START / 2)) + sol.joint("D").turn
    assert np.allclose(np.tan(rocker / 2) / np.tan(crank / 2), SMOOTH, rtol=1e-9)
    assert np.allclose(31 * sol.joint("E").turn, -17 * sol.joint("D").turn, atol=1e-9)
    assert sol.stats.power_residual < 1e-7
    assert np.isfinite(sol.joint("B").force).all()


def test_the_motion_goes_on_to_the_other_assembly_where_it_is_told() -> None:
    m = spherical(balls=True)
    meeting = math.pi - START
    sol, smooth = (m.sweep(times=TIMES, switch_at=switches) for switches in ([meeting], ()))
    early = meeting > TIMES
    assert np.allclose(sol.joint("D").turn[early], smooth.joint("D").turn[early], atol=1e-9)
    crank, rocker = START + sol.joint("A").turn, 2.0 * math.atan(SMOOTH * math.tan(START / 2)) + sol.joint("D").turn
    assert np.allclose((np.tan(rocker / 2) / np.tan(crank / 2))[~early], OTHER, rtol=1e-8)
    with pytest.raises(ModelError, match=r"switch_at has t = 1 s, but it passes change points at t = 2.64159265, "):
        m.sweep(times=TIMES, switch_at=[1.0])
