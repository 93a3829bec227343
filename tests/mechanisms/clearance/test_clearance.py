"""The sweep check: it passes what is free, finds what is not, and its bounds hold."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.stages.clearance.outlines import least_gap
from mechanisms.stages.clearance.path import paths, points, relative
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import RESOLUTION as SHARP
from mechanisms.stages.clearance.search import Sweep
from mechanisms.stages.clearance.turn import RESOLUTION, turn_gap
from shared.contract import Motion
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import box, checked, disc, four_bar_pieces, lifted, prism
from tools.models.motions import four_bar_motion


def test_free_layers_pass_and_the_nearest_pairs_are_told() -> None:
    clearance = checked(four_bar_pieces())
    gaps = {frozenset(pair.pieces): pair for pair in clearance.pairs}
    assert gaps[frozenset(("pin_B", "coupler"))].gap == pytest.approx(0.5e-3)
    assert gaps[frozenset(("pin_B", "coupler"))].proof == "layers"
    assert gaps[frozenset(("post_D", "rocker"))].gap == pytest.approx(0.5e-3)
    assert [pair.gap for pair in clearance.pairs] == sorted(pair.gap for pair in clearance.pairs)
    assert all(clearance.limit <= pair.proven <= pair.gap for pair in clearance.pairs)
    assert clearance.interpolation_error < 1e-9


@pytest.mark.parametrize(("body", "by", "other"), [("coupler", -10.0, "crank"), ("coupler", 10.5, "rocker")])
def test_a_bad_layer_is_caught(body: str, by: float, other: str) -> None:
    with pytest.raises(
        UserError, match=r"four_bar: .* collide: deepest at t=.* s by .* mm.*; move one to another"
    ) as e:
        checked(lifted(four_bar_pieces(), body, by))
    assert "coupler: coupler" in str(e.value)
    assert other in str(e.value)


def test_a_layer_that_is_off_by_two_tenths_is_caught() -> None:
    with pytest.raises(UserError, match=r"pin_B .*collide: deepest at t=.* s by 0\.2 mm"):
        checked(lifted(four_bar_pieces(), "coupler", -0.7))


def test_too_near_is_told_from_touching() -> None:
    with pytest.raises(UserError, match=r"come as near as 0\.03 mm at t=.* s, required 0\.05 mm"):
        checked(lifted(four_bar_pieces(), "coupler", -0.47))


def farthest(motion: Motion, piece: MeshPiece, direction: float) -> tuple[float, np.ndarray]:
    """When some corner of a coupler's piece is farthest out in a direction (rad), and where it is (mm)."""
    times = np.linspace(0.0, motion.time[-1], 4 * len(motion.time))
    pose = paths(motion)["coupler"].poses_at(times)
    corners = np.unique(piece.triangles.reshape(-1, 3)[:, :2], axis=0)
    world = np.stack([points(pose, corner) for corner in corners])
    out = world @ [math.cos(direction), math.sin(direction)]
    corner, moment = np.unravel_index(out.argmax(), out.shape)
    return float(times[moment]), world[corner, moment]


def post_beyond(place: np.ndarray, direction: float, gap: float) -> MeshPiece:
    """A thin post on the ground whose flat face is ``gap`` mm beyond ``place``; a negative gap is an intrusion."""
    out, along = (
        np.array([math.cos(direction), math.sin(direction)]),
        np.array([-math.sin(direction), math.cos(direction)]),
    )
    near = place + gap * out
    corners = [near - along, near + 2 * out - along, near + 2 * out + along, near + along]
    return prism("ground", "post", [(float(x), float(y)) for x, y in corners], 0.0, 30.0)


@settings(max_examples=8)
@given(direction=st.floats(0.0, 2 * math.pi), depth=st.floats(0.15, 0.4))
def test_an_intrusion_of_two_tenths_that_lasts_a_moment_is_caught(direction: float, depth: float) -> None:
    """The corner that comes farthest out dips into a post for a few milliseconds of the turn."""
    motion = four_bar_motion(steps=180)
    coupler = four_bar_pieces()[4]
    moment, place = farthest(motion, coupler, direction)
    with pytest.raises(UserError, match=r"post and|and ground: post") as caught:
        checked([coupler, post_beyond(place, direction, -depth)], motion)
    told = float(str(caught.value).split("deepest at t=")[1].split(" s")[0])
    period = motion.time[-1]
    assert min(abs(told - moment), period - abs(told - moment)) < 0.05 * period


@settings(max_examples=8)
@given(direction=st.floats(0.0, 2 * math.pi), gap=st.floats(0.15, 1.0))
def test_a_near_miss_passes_with_its_gap(direction: float, gap: float) -> None:
    motion = four_bar_motion(steps=180)
    coupler = four_bar_pieces()[4]
    _, place = farthest(motion, coupler, direction)
    (pair,) = checked([coupler, post_beyond(place, direction, gap)], motion).pairs
    assert pair.proof == "motion"
    assert pair.gap == pytest.approx(gap * 1e-3, abs=(SHARP + 1e-3) * 1e-3)
    assert pair.gap - (SHARP + 1e-3) * 1e-3 <= pair.proven <= gap * 1e-3 + 1e-6


def test_the_gap_of_a_motion_is_that_of_a_dense_sampling() -> None:
    motion = four_bar_motion()
    bar = four_bar_pieces()[4]
    where = paths(motion)
    sweep = Sweep(bar, disc("ground", "peg", 60.0, 120.0, 3.0, 10.0, 20.0), where["coupler"], where["ground"])
    least = least_gap(sweep, 200.0)
    sampled = [sweep.gap_at(float(time), 200.0) for time in np.linspace(0.0, motion.time[-1], 721)]
    assert least.gap - SHARP - 1e-6 <= least.proven <= min(sampled)
    assert min(sampled) - SHARP <= least.gap <= min(sampled) + SHARP


@settings(max_examples=12)
@given(
    radius=st.floats(3.0, 10.0),
    gap=st.floats(0.3, 4.0),
    side=st.floats(1.0, 6.0),
    tilt=st.floats(0.0, 2.0),
    z=st.floats(-2.0, 2.0),
)
def test_turning_gap_holds_at_every_angle(radius: float, gap: float, side: float, tilt: float, z: float) -> None:
    """A box that passes a disc: the bound is below every sampled gap, and the nearest angle reaches it."""
    turning = disc("crank", "disc", 0.0, 0.0, radius, 0.0, 4.0, sides=90)
    block = box("ground", "block", radius + gap + side / 2, tilt, z, (side, side, 3.0))
    reached, proven = turn_gap(turning.triangles, block.triangles, 20.0)
    sampled = min(
        block.manifold.min_gap(turning.manifold.rotate((0.0, 0.0, float(angle))), 20.0)
        for angle in np.arange(0, 4, 0.1)
    )
    assert proven <= sampled + 1e-5
    assert reached == pytest.approx(sampled, abs=0.02)
    assert reached - proven <= RESOLUTION + 1e-9


def test_a_pin_in_its_hole_is_free_and_its_room_is_told() -> None:
    """0.1 mm of room at the radius, at every angle; the polygon of the hole takes a little of it."""
    sides = 64
    ring = [disc("rocker", "eye", 0.0, 0.0, 8.0, 25.5, 31.5, sides)]
    hole = disc("rocker", "eye", 0.0, 0.0, 4.1, 25.5, 31.5, sides).manifold
    mesh = (ring[0].manifold - hole).to_mesh()
    eye = MeshPiece("rocker", "eye", np.array(mesh.vert_properties[:, :3])[np.array(mesh.tri_verts)].astype(float))
    pin = disc("ground", "pin_D", 120.0, 0.0, 4.0, 0.0, 40.0, sides)
    (pair,) = checked([eye, pin]).pairs
    assert pair.proof == "turn"
    assert pair.time is None
    lost = 4.1 * (1 - math.cos(math.pi / sides))
    assert pair.gap == pytest.approx((0.1 - lost) * 1e-3, abs=2 * RESOLUTION * 1e-3)
    tight = disc("ground", "pin_D", 120.0, 0.0, 4.12, 0.0, 40.0, sides)
    with pytest.raises(UserError, match="pin_D"):
        checked([eye, tight])


def test_one_part_wholly_inside_another_is_a_collision() -> None:
    with pytest.raises(UserError, match="inner"):
        checked(
            [disc("rocker", "outer", 0.0, 0.0, 9.0, 25.0, 35.0), disc("ground", "inner", 120.0, 0.0, 3.0, 28.0, 31.0)]
        )


def test_between_samples_too_coarse_to_prove_anything_parts_are_refused_where_they_are_near() -> None:
    """Eight samples a turn leave 0.5 mm open: enough far from everything, too much beside a post."""
    motion, coupler = four_bar_motion(steps=8), four_bar_pieces()[4]
    assert checked(four_bar_pieces(), motion).interpolation_error > 0.1e-3
    _, place = farthest(motion, coupler, 1.0)
    assert checked([coupler, post_beyond(place, 1.0, 3.0)], motion).pairs[0].gap > 2.5e-3
    with pytest.raises(
        UserError, match=r"between two samples of data\.json they may be .* mm from .*solve with more steps"
    ):
        checked([coupler, post_beyond(place, 1.0, 0.2)], motion)


def test_a_body_that_does_not_move_is_named() -> None:
    with pytest.raises(UserError, match=r"parts\.json has a body 'slider' that data\.json does not move"):
        checked([*four_bar_pieces(), box("slider", "slider", 0.0, 0.0, 40.0, (5.0, 5.0, 5.0))])


def test_poses_between_samples_follow_the_motion() -> None:
    coarse, fine = four_bar_motion(steps=90), four_bar_motion(steps=900)
    times = np.array(fine.time)
    for body in ("coupler", "rocker"):
        error = paths(coarse)[body].poses_at(times) - paths(fine)[body].pose
        assert np.abs(error[:, :2]).max() < 2e-3
        assert np.abs(error[:, 2]).max() < 2e-5
    seen = relative(paths(fine)["coupler"].pose, paths(fine)["coupler"].pose)
    assert np.abs(seen).max() == 0.0
