"""The proof of clearance: pairs that pass, collisions, bodies that stay far apart, and its speed in facets."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mechanisms.stages.automatic.layout.sizes import of_pin
from mechanisms.stages.clearance import outlines, path
from mechanisms.stages.clearance import pieces as distinct_file
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.clearance.outlines import BESIDE, least_gap, never_over
from mechanisms.stages.clearance.path import BodyPath, paths, points, relative
from mechanisms.stages.clearance.pieces import MeshPiece, distinct
from mechanisms.stages.clearance.search import RESOLUTION as SHARP
from mechanisms.stages.clearance.search import Sweep
from mechanisms.stages.clearance.turn import RESOLUTION, _box_gap, nearest_boxes, turn_gap
from mechanisms.stages.parts_files import TOLERANCE, read_triangles, stl_bytes
from shared.contract import Motion
from shared.shapes.pin import pin
from shared.shapes.standards import Fit
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import box, checked, disc, four_bar_pieces, lifted, parts_of, prism
from tests.mechanisms.clearance.test_clearance_between import cam_motion, motion_of
from tools.models.motions import four_bar_motion

# The sweep check: it passes what is free, finds what is not, and its bounds hold.


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
        UserError, match=r"between two samples of data\.json they may be .* mm off.*Solve with more steps"
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


# Pieces that never lie over each other are told by their sides alone, and the others are not.


def turned_over(first: MeshPiece, second: MeshPiece, turn: float) -> Sweep:
    """The first piece turns about the origin by ``turn``, the second one stands."""
    times = np.linspace(0.0, 1.0, 49)
    zero = np.zeros((49, 3))
    still = BodyPath(times, zero, zero, zero)
    unit = np.array([0.0, 0.0, 1.0])
    return Sweep(first, second, BodyPath(times, turn * times[:, None] * unit, zero + turn * unit, zero), still)


@given(st.floats(-6.0, 6.0), st.floats(-3.0, 3.0), st.sampled_from([0.1, 1.0, 30.0]), st.booleans())
@example(0.0, 0.5, 1.0, False)  # inside its shadow all the time
@settings(max_examples=25)
def test_a_post_that_goes_round_over_a_disc_is_over_it_where_their_circles_meet(
    apart: float, above: float, scale: float, under: bool
) -> None:
    """``apart`` is how far from the disc's rim the post's circle passes, ``above`` how high over it, both in gaps."""
    gap = 1.0
    low, high = (above * gap, 20.0) if not under else (-20.0, -10.0 - above * gap)
    post = disc("arm", "post", (40.0 + gap * apart) * scale, 0.0, 5.0 * scale, low * scale, high * scale, 48)
    step = disc("ground", "step", -20.0 * scale, 0.0, 15.0 * scale, -10.0 * scale, 0.0, 48)
    told = never_over(turned_over(post, step, 2 * math.pi), gap * scale)
    near_in_height = -1e-7 <= above < 1.0
    sagitta = 20.0 * (1 - math.cos(math.pi / 48))
    if not near_in_height or apart > BESIDE + 0.01:
        assert told
    elif apart < -sagitta:
        assert not told


def test_faces_that_are_over_each_other_for_a_moment_are_seen() -> None:
    """A tooth that passes over the corner of a plate once in a turn, between two samples."""
    tooth = box("arm", "tooth", 30.0, 0.0, 0.5, (2.0, 2.0, 4.0))
    for reach, told in ((28.6, True), (29.3, False)):
        at = 2.5 * 2 * math.pi / 48
        place = (reach - 5.0) * np.array([math.cos(at), math.sin(at)])
        assert never_over(turned_over(tooth, disc("ground", "plate", *place, 5.0, -4.0, 0.0), 2 * math.pi), 1.0) == told


@pytest.mark.parametrize(("collar", "over"), [(30.6, False), (29.9, True)])
def test_the_least_gap_is_that_of_all_facets(collar: float, over: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A cam whose collar is under the roller and reaches out of it to the side, with and without lying under it."""
    motion = cam_motion(np.linspace(0.0, 1.0, 49), 10.0, 41.2 if not over else 39.7)
    cam, rim = (disc("cam", "cam", 10.0, 0.0, r, 0.0, top, 60) for r, top in ((collar - 0.6, 8.0), (collar, 4.0)))
    mesh = (cam.manifold + rim.manifold).to_mesh64()
    cam = MeshPiece("cam", "cam", np.asarray(mesh.vert_properties)[np.asarray(mesh.tri_verts)])
    roller = disc("follower", "roller", 0.0, 0.0, 10.0, 4.2, 7.0, 24)
    where = paths(motion)
    sweep = Sweep(cam, roller, where["cam"], where["follower"])
    quick = outlines.least_gap(sweep, 5.0)
    assert never_over(sweep, quick.gap + 0.01) != over
    monkeypatch.setattr(outlines, "never_over", lambda sweep, gap: False)
    whole = outlines.least_gap(sweep, 5.0)
    assert quick.gap == pytest.approx(whole.gap, abs=SHARP)
    assert quick.gap - SHARP - 1e-3 <= quick.proven <= whole.gap + 1e-9


# Bodies that are settled at once are those whose pieces stay apart one by one.


REACH = 5.0


def snake(count: int) -> Motion:
    """Bodies side by side (70 mm) that swing to and fro and turn, each at its own rate."""
    t = np.linspace(0.0, 1.0, 41)
    bodies = {}
    for k in range(count):
        w, a = 3.0 + k, 0.04
        s, c = a * np.sin(w * t), a * np.cos(w * t)
        turn = np.stack([w * t, w + 0 * t, 0 * t])
        bodies[f"b{k}"] = (0.07 * k + s, c, turn[0], w * c, -w * s, turn[1], -w * w * s, -w * w * c, turn[2])
    return motion_of(t, **bodies)


def test_bodies_that_are_far_have_pieces_that_are_apart() -> None:
    motion = snake(6)
    pieces = [box(f"b{k}", f"p{k}", 12.0, 5.0, 0.0, (20.0, 8.0, 4.0)) for k in range(6)]
    where = paths(motion)
    far_pairs = path.far_bodies(pieces, where, REACH)
    assert 0 < len(far_pairs) < 15
    for a in pieces:
        for b in pieces:
            if frozenset((a.body, b.body)) in far_pairs:
                assert Sweep(a, b, where[a.body], where[b.body]).is_apart(REACH)


def test_the_check_is_the_same_with_and_without(monkeypatch: pytest.MonkeyPatch) -> None:
    motion = snake(5)
    pieces = [box(f"b{k}", f"p{k}", 0.0, 0.0, 6.0 * k, (20.0, 8.0, 4.0)) for k in range(5)]
    clearance = clearance_stage.check(parts_of(pieces), motion, pieces, "0" * 64)
    monkeypatch.setattr(path, "far_bodies", lambda *_: set())
    assert clearance_stage.check(parts_of(pieces), motion, pieces, "0" * 64) == clearance
    assert clearance.apart > 0


# What makes the proof of clearance quick gives what the plain way gives.


few = st.sampled_from([-1.5, -0.0, 0.0, 1e-300, 0.1, 0.1 + 2**-56, 7.0])


@given(hnp.arrays(np.float64, st.tuples(st.integers(1, 40), st.integers(1, 4)), elements=few))
def test_distinct_rows_are_those_of_a_sort(rows: np.ndarray) -> None:
    first, which = distinct(rows)
    assert np.array_equal(rows[first][which], rows)
    assert len(first) == len(np.unique(rows, axis=0))


def test_rows_of_one_hash_are_told_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distinct_file, "_FACTORS", np.zeros(4, dtype=np.uint64))
    rows = np.array([[1.0, 2.0], [3.0, 4.0], [1.0, 2.0], [4.0, 3.0]])
    first, which = distinct(rows)
    assert len(first) == 3
    assert np.array_equal(rows[first][which], rows)


@given(st.integers(0, 1000), st.integers(1, 300), st.integers(1, 90), st.floats(0.0, 3.0))
def test_bounds_of_boxes_in_groups_are_those_of_all_pairs(seed: int, n: int, m: int, enough: float) -> None:
    rng = np.random.default_rng(seed)
    low = [rng.uniform(0, 10, (count, 2)).round(1) for count in (n, m)]
    a, b = (np.stack([corner, corner + rng.exponential(0.3, corner.shape)], axis=2).reshape(-1, 4) for corner in low)
    gaps = _box_gap(a, b)
    found_a, found_b = nearest_boxes(a, b, enough)
    assert np.array_equal(found_a, np.minimum(gaps.min(axis=1), enough))
    assert np.array_equal(found_b, np.minimum(gaps.min(axis=0), enough))


def test_meshes_of_large_parts_are_as_fine_in_proportion_and_leave_the_clearance() -> None:
    assert of_pin(8.0, None).tolerance is None
    assert of_pin(0.5, None).tolerance is None
    assert of_pin(16.0, None).tolerance == pytest.approx(2 * TOLERANCE)
    for diameter in (12.0, 60.0, 250.0):
        sizes = of_pin(diameter, None)
        assert TOLERANCE < (sizes.tolerance or 0.0) < 0.3 * sizes.pivot.fit.running * sizes.scale / 2
    assert of_pin(80.0, Fit(running=0.1)).tolerance is None
    solid = pin(120.0, 300.0).val()
    fine, coarse = (read_triangles(stl_bytes(solid, tolerance)) for tolerance in (None, of_pin(120.0, None).tolerance))
    assert len(coarse) < 0.7 * len(fine)
