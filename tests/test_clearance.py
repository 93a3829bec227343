"""The sweep check: it passes what is free, finds what is not, and its bounds hold."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.clearance.path import dense_times, paths, points, relative
from mechanisms.clearance.pieces import MeshPiece
from mechanisms.clearance.sweep import Sweep
from mechanisms.clearance.turn import RESOLUTION, turn_gap
from mechanisms.clearance_stage import check
from shared.clearance import Clearance
from shared.contract import BodyParts, Mass, Motion, Parts, Provenance
from shared.errors import UserError
from tests.motions import four_bar_motion

NO_MASS = Mass(mass=0.0, com=(0.0, 0.0), inertia=0.0, volume=0.0)


def prism(body: str, name: str, corners: list[tuple[float, float]], z0: float, z1: float) -> MeshPiece:
    """A prism on a convex outline (counter-clockwise, mm)."""
    low = [(x, y, z0) for x, y in corners]
    high = [(x, y, z1) for x, y in corners]
    n = len(corners)
    faces = [(low[0], low[i + 1], low[i]) for i in range(1, n - 1)]
    faces += [(high[0], high[i], high[i + 1]) for i in range(1, n - 1)]
    for i in range(n):
        j = (i + 1) % n
        faces += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
    return MeshPiece(body, name, np.array(faces))


def box(body: str, name: str, x: float, y: float, z: float, size: tuple[float, float, float]) -> MeshPiece:
    """A box with its middle at (x, y) and its underside at z."""
    a, b, h = size[0] / 2, size[1] / 2, size[2]
    return prism(body, name, [(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b)], z, z + h)


def disc(body: str, name: str, x: float, y: float, radius: float, z0: float, z1: float, sides: int = 64) -> MeshPiece:
    angles = [2 * math.pi * i / sides for i in range(sides)]
    return prism(body, name, [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles], z0, z1)


def four_bar_pieces() -> list[MeshPiece]:
    """Bars 16 mm wide on three layers, the pin of joint C 0.5 mm clear of nothing in particular."""
    return [
        box("ground", "base", 60.0, 0.0, -12.0, (220.0, 80.0, 12.0)),
        disc("ground", "post_D", 120.0, 0.0, 8.0, 0.0, 25.0),
        box("crank", "crank", 20.0, 0.0, 5.0, (56.0, 16.0, 6.0)),
        disc("crank", "pin_B", 40.0, 0.0, 4.0, 6.0, 14.5),
        box("coupler", "coupler", 60.0, 0.0, 15.0, (136.0, 16.0, 6.0)),
        box("rocker", "rocker", 45.0, 0.0, 25.5, (106.0, 16.0, 6.0)),
    ]


def parts_of(pieces: list[MeshPiece]) -> Parts:
    return Parts(
        mechanism="four_bar",
        provenance=Provenance(inputs="0" * 64, versions={}),
        bodies={piece.body: BodyParts(pieces={}, mass=NO_MASS, z=0.0) for piece in pieces},
    )


def checked(pieces: list[MeshPiece], motion: Motion | None = None) -> Clearance:
    return check(parts_of(pieces), motion or four_bar_motion(), pieces, "key")


def lifted(pieces: list[MeshPiece], body: str, by: float) -> list[MeshPiece]:
    return [
        replace(piece, triangles=piece.triangles + np.array([0.0, 0.0, by])) if piece.body == body else piece
        for piece in pieces
    ]


def test_free_layers_pass_and_the_nearest_pairs_are_told() -> None:
    found = checked(four_bar_pieces())
    gaps = {frozenset(pair.pieces): pair for pair in found.pairs}
    assert gaps[frozenset(("pin_B", "coupler"))].gap == pytest.approx(0.5e-3)
    assert gaps[frozenset(("pin_B", "coupler"))].proof == "layers"
    assert gaps[frozenset(("post_D", "rocker"))].gap == pytest.approx(0.5e-3)
    assert [pair.gap for pair in found.pairs] == sorted(pair.gap for pair in found.pairs)
    assert all(found.limit <= pair.proven <= pair.gap for pair in found.pairs)
    assert found.interpolation_error < 1e-9


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
    times = dense_times(np.array(motion.time))
    pose = paths(motion)["coupler"].at(times)
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
    time, place = farthest(motion, coupler, direction)
    with pytest.raises(UserError, match=r"post and|and ground: post") as caught:
        checked([coupler, post_beyond(place, direction, -depth)], motion)
    told = float(str(caught.value).split("deepest at t=")[1].split(" s")[0])
    period = motion.time[-1]
    assert min(abs(told - time), period - abs(told - time)) < 0.05 * period


@settings(max_examples=8)
@given(direction=st.floats(0.0, 2 * math.pi), gap=st.floats(0.15, 1.0))
def test_a_near_miss_passes_with_its_gap(direction: float, gap: float) -> None:
    motion = four_bar_motion(steps=180)
    coupler = four_bar_pieces()[4]
    _, place = farthest(motion, coupler, direction)
    (pair,) = checked([coupler, post_beyond(place, direction, gap)], motion).pairs
    assert pair.proof == "motion"
    assert pair.gap == pytest.approx(gap * 1e-3, abs=0.03e-3)
    assert 0.25e-3 * gap < pair.proven <= pair.gap


def test_the_gap_of_a_motion_is_that_of_a_dense_sampling() -> None:
    motion = four_bar_motion()
    bar = four_bar_pieces()[4]
    where = paths(motion)
    sweep = Sweep(bar, disc("ground", "peg", 60.0, 120.0, 3.0, 10.0, 20.0), where["coupler"], where["ground"])
    least = sweep.least(0.05, 200.0)
    sampled = [sweep.gap_at(float(time), 200.0) for time in np.linspace(0.0, motion.time[-1], 721)]
    assert least.gap == pytest.approx(min(sampled), abs=0.05)
    assert least.proven <= min(sampled)
    assert least.gap <= min(sampled) + 0.01


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


def test_a_motion_too_coarse_to_prove_anything_is_refused() -> None:
    with pytest.raises(UserError, match=r"between the 9 samples of data\.json .* solve with more steps"):
        checked(four_bar_pieces(), four_bar_motion(steps=8))


def test_a_body_that_does_not_move_is_named() -> None:
    with pytest.raises(UserError, match=r"parts\.json has a body 'slider' that data\.json does not move"):
        checked([*four_bar_pieces(), box("slider", "slider", 0.0, 0.0, 40.0, (5.0, 5.0, 5.0))])


def test_poses_between_samples_follow_the_motion() -> None:
    coarse, fine = four_bar_motion(steps=90), four_bar_motion(steps=900)
    times = np.array(fine.time)
    for body in ("coupler", "rocker"):
        error = paths(coarse)[body].at(times) - paths(fine)[body].pose
        assert np.abs(error[:, :2]).max() < 2e-3
        assert np.abs(error[:, 2]).max() < 2e-5
    seen = relative(paths(fine)["coupler"].pose, paths(fine)["coupler"].pose)
    assert np.abs(seen).max() == 0.0
