"""Clearance in space: known gaps, collisions between samples, bounds of relative motions, and the plane as a case."""

from __future__ import annotations

import math
from dataclasses import replace

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd.spatial import Mechanism, constant_rate
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.space.path import SpacePath, SpaceRelative
from mechanisms.stages.clearance.space.search import resolution_of
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.solve.space.motion_file import to_motion3
from shared.contract import Motion, Motion3
from shared.contract.clearance import Clearance
from shared.contract.quaternions import matrices, product
from shared.contract.space import BodyMotion3
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import box, disc, parts_of
from tools.models.motions import four_bar_motion

RADIUS, TILT, STEPS = 100.0, 0.6, 24
LOWEST = -RADIUS * math.sin(TILT)
"""Height (mm) of the lowest place on a circle about an axis that leans by TILT."""
PASS = 8.5 / STEPS
"""Time (s) of it, in the middle between two samples."""


def solved(m: Mechanism) -> Motion3:
    names = [name for name in m.bodies if name != "ground"]
    colours = dict.fromkeys(names, "#0b62a8")
    return to_motion3(m.sweep(duration=1.0, steps=STEPS), colours, {}, dict.fromkeys(names, "mechanism"))


def checked_in_space(pieces: list[MeshPiece], motion: Motion3) -> Clearance:
    parts = msgspec.structs.replace(parts_of(pieces), mechanism=motion.mechanism)
    return check(parts, motion, pieces, "key")


def needle_over_plate(gap: float) -> tuple[list[MeshPiece], Motion3]:
    """A needle whose tip goes round once about a leaning axis, and a plate ``gap`` (mm) below its lowest place."""
    m = Mechanism("needle")
    axis = np.array([0.0, math.sin(TILT), math.cos(TILT)])
    m.revolute("hinge", m.ground, m.body("arm"), at=(0, 0, 0), axis=tuple(axis))
    m.drive_turn("motor", "hinge", constant_rate(2 * math.pi))
    low, side = np.array([0.0, math.cos(TILT), -math.sin(TILT)]), np.array([-1.0, 0.0, 0.0])
    assert np.allclose(np.cross(axis, low), side)
    back = -2 * math.pi * PASS
    out = math.cos(back) * low + math.sin(back) * side
    across = np.cross(axis, out)
    a, b, c = (85 * out + 8 * way for way in (axis, across, -axis - across))
    tip = RADIUS * out
    needle = MeshPiece("arm", "needle", np.array([(a, b, c), (b, a, tip), (c, b, tip), (a, c, tip)]))
    return [needle, box("ground", "plate", 0.0, 0.0, LOWEST - gap - 10.0, (400.0, 400.0, 10.0))], solved(m)


@pytest.mark.parametrize("gap", [0.06, 2.0])
def test_the_gap_of_a_tip_over_a_plate_is_that_of_its_circle(gap: float) -> None:
    (pair,) = checked_in_space(*needle_over_plate(gap)).pairs
    assert pair.proof == "motion"
    assert pair.time == pytest.approx(PASS, abs=2e-3)
    assert 1e3 * pair.gap == pytest.approx(gap, abs=resolution_of(gap))
    assert gap - 2 * resolution_of(gap) < 1e3 * pair.proven <= 1e3 * pair.gap


def test_a_collision_between_two_samples_is_found() -> None:
    """The tip is 0.03 mm deep in the plate, and out of it at every sample."""
    needle = r"arm: needle|ground: plate"
    with pytest.raises(UserError, match=rf"({needle}) collide: deepest at t=0\.35\d* s by 0\.0\d+ mm.*move one aside"):
        checked_in_space(*needle_over_plate(-0.03))


def in_space(flat: Motion, stand: np.ndarray) -> Motion3:
    """A motion in the plane, turned by the unit quaternion ``stand``."""
    bodies = {}
    for name, body in flat.bodies.items():
        zero = np.zeros(len(flat.time))
        series = {}
        for prefix, columns in {
            "": (body.x, body.y, zero), "v": (body.vx, body.vy, zero), "a": (body.ax, body.ay, zero),
            "w": (zero, zero, body.omega), "alpha": (zero, zero, body.alpha),
        }.items():  # fmt: skip
            turned = np.stack([np.asarray(column) for column in columns], axis=1) @ matrices(stand).T
            series |= {f"{prefix}{axis}": turned[:, k].tolist() for k, axis in enumerate("xyz")}
        half = np.asarray(body.theta) / 2
        q = product(np.tile(stand, (len(half), 1)), np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1))
        series |= {f"q{entry}": q[:, k].tolist() for k, entry in enumerate("wxyz")}
        bodies[name] = BodyMotion3(
            **series, mass=1.0, mass_from="mechanism", com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0, 0.0, 0.0, 0.0),
            colour="#0b62a8", colour_on_dark="#0b62a8",
        )  # fmt: skip
    return Motion3(
        mechanism=flat.mechanism, provenance=flat.provenance, gravity=(0.0, 0.0, 0.0), analysis=flat.analysis,
        period=None, time=flat.time, bodies=bodies, joints={}, drivers={}, points={}, energy=flat.energy,
        diagnostics=flat.diagnostics,
    )  # fmt: skip


def test_a_machine_in_the_plane_has_the_same_gaps_in_space_however_it_stands() -> None:
    flat = four_bar_motion(steps=48)
    pieces = [
        box("coupler", "coupler", 60.0, 0.0, 15.0, (136.0, 16.0, 6.0)),
        disc("ground", "knob", 60.0, 116.0, 5.0, 13.0, 26.0, 24),
    ]
    stand = np.array([0.6, 0.3, 0.7, -0.2]) / math.sqrt(0.98)
    turned = [replace(piece, triangles=piece.triangles @ matrices(stand).T) for piece in pieces[1:]]
    plane = check(parts_of(pieces), flat, pieces, "key", reach=40.0)
    space = check(parts_of(pieces), in_space(flat, stand), [pieces[0], *turned], "key", reach=40.0)
    assert plane.pairs[0].proof == "motion"
    assert {pair.pieces for pair in space.pairs} == {pair.pieces for pair in plane.pairs}
    gaps = {pair.pieces: 1e3 * pair.gap for pair in plane.pairs}
    for pair in space.pairs:
        assert 1e3 * pair.gap == pytest.approx(gaps[pair.pieces], abs=resolution_of(gaps[pair.pieces]))


def turning(time: np.ndarray, axis: np.ndarray, rate: float, circle: float) -> SpacePath:
    """A body that turns about an axis while its origin goes round a circle (mm)."""
    angle, zero = rate * time, 0.0 * time
    c, s = np.cos(angle), np.sin(angle)
    place = circle * np.stack([c, s, zero], axis=1)
    speed = rate * circle * np.stack([-s, c, zero], axis=1)
    q = np.column_stack([np.cos(angle / 2), np.sin(angle / 2)[:, None] * axis])
    spin = np.tile([0.0, *(rate * axis)], (len(time), 1))
    bends = -(rate**2) * place, -(rate**2) / 4 * q
    return SpacePath(time, np.hstack([place, q]), np.hstack([speed, 0.5 * product(spin, q)]), np.hstack(bends))


@settings(max_examples=6, deadline=None)
@given(
    rates=st.tuples(st.floats(-8.0, 8.0), st.floats(-8.0, 8.0)),
    way=st.floats(0.0, math.pi),
    point=st.tuples(*[st.floats(-30.0, 30.0)] * 3),
)
def test_accelerations_of_points_seen_from_a_body_are_within_their_bounds(
    rates: tuple[float, float], way: float, point: tuple[float, float, float]
) -> None:
    time = np.linspace(0.0, 1.0, 25)
    mover = turning(time, np.array([math.sin(way), 0.0, math.cos(way)]), rates[0], 40.0)
    still = turning(time, np.array([0.0, 0.6, 0.8]), rates[1], 10.0)
    path = SpaceRelative(mover, still, np.array([5.0, 0.0, 2.0]), np.zeros(24))
    fine = 1e-4
    middle = np.repeat(np.arange(24), 3)
    times = time[middle] + np.tile([0.2, 0.5, 0.8], 24) / 24
    seen = []
    for shift in (-fine, 0.0, fine):
        place, turned = path.place(middle, times + shift)
        seen.append(place + turned @ np.array(point))
    bend = np.linalg.norm(seen[0] - 2 * seen[1] + seen[2], axis=1) / fine**2
    bound = (path.push + float(np.linalg.norm(point)) * path.spin)[middle]
    assert (bend <= bound + 1e-2 + 1e-6 * bound).all()


def test_two_bodies_that_move_as_one_have_no_relative_motion_to_bound() -> None:
    time, axis = np.linspace(0.0, 1.0, 25), np.array([0.0, 0.6, 0.8])
    path = SpaceRelative(*(turning(time, axis, 6.0, 40.0) for _ in range(2)), np.array([5.0, 0.0, 2.0]), np.zeros(24))
    assert path.bend(100.0) < 1e-3 * 36.0 * 140.0 / 8 / 24
