"""Clearance is proven between the samples of a motion too: close runs, events, spans, facets."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.stages.clearance.outlines import OutlineSearch
from mechanisms.stages.clearance.path import BodyPath, RelativePath, paths, points
from mechanisms.stages.clearance.pieces import FacetTree, MeshPiece
from mechanisms.stages.clearance.search import RESOLUTION as SHARP
from mechanisms.stages.clearance.search import Search, Spans, Sweep, nearest, separation
from render.film.poses import Moment, Poses
from shared.contract import BodyMotion, Energy, Motion
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import box, checked, disc
from tools.models.motions import four_bar_motion


def cam_motion(times: np.ndarray, eccentric: float, centres: float, speed: float = 2 * math.pi) -> Motion:
    """An eccentric disc about the origin and a roller above it, their middles ``centres`` apart (mm) at all times."""
    angle = speed * times
    s, c = np.sin(angle), np.cos(angle)
    q = np.sqrt(centres**2 - (eccentric * c) ** 2)
    q1 = eccentric**2 * c * s / q
    q2 = (eccentric**2 * (c * c - s * s) - q1 * q1) / q
    still = np.zeros_like(times)
    y, vy, ay = (1e-3 * v for v in (eccentric * s + q, (eccentric * c + q1) * speed, (-eccentric * s + q2) * speed**2))
    return motion_of(
        times,
        cam=(still, still, angle, still, still, still + speed, still, still, still),
        follower=(still, y, still, still, vy, still, still, ay, still),
    )


def motion_of(times: np.ndarray, **bodies: tuple[np.ndarray, ...]) -> Motion:
    """Bodies by x, y, theta, vx, vy, omega, ax, ay, alpha over time."""
    fields = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")
    flat = four_bar_motion(steps=2)
    moving = {
        name: BodyMotion(
            **dict(zip(fields, (v.tolist() for v in values), strict=True)), z=0.0, mass=0.0, com=(0.0, 0.0), inertia=0.0
        )
        for name, values in bodies.items()
    }
    none = [0.0] * len(times)
    return msgspec.structs.replace(
        flat, period=None, time=times.tolist(), bodies=moving, joints={}, drivers={}, points={},
        energy=Energy(kinetic=none, potential=none),
        diagnostics=msgspec.structs.replace(flat.diagnostics, singularity_margin=none),
    )  # fmt: skip


@pytest.mark.parametrize("steps", [48, 360])
@pytest.mark.parametrize("gap", [0.06, 0.4])
def test_a_cam_and_a_roller_that_run_close_all_the_time(gap: float, steps: int) -> None:
    """Discs of 240 and 120 sides: the gap is known to a sagitta of either. It used to take 3000 poses and a minute."""
    times = np.linspace(0.0, 1.0, steps + 1)
    motion = cam_motion(times, 10.0, 40.0 + gap)
    cam, roller = (
        disc("cam", "cam", 10.0, 0.0, 30.0, 0.0, 8.0, 240),
        disc("follower", "roller", 0, 0, 10.0, 1.0, 7.0, 120),
    )
    sagitta = 30.0 * (1 - math.cos(math.pi / 240)) + 10.0 * (1 - math.cos(math.pi / 120))
    (pair,) = checked([cam, roller], motion).pairs
    assert pair.proof == "motion"
    assert gap - 1e-6 <= 1e3 * pair.gap <= gap + sagitta
    assert 1e3 * (pair.gap - pair.proven) <= SHARP + 1e-3
    assert pair.poses < 3000


@pytest.mark.parametrize(("gap", "above"), [(0.2, 0.06), (0.028, 0.0425)])
def test_a_search_that_is_given_up_tells_what_the_outlines_prove(
    gap: float, above: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A collar low on the cam, which the roller passes just above: the outlines come nearer than the pieces do."""
    monkeypatch.setattr(Search, "most", 20)
    monkeypatch.setattr(OutlineSearch, "most", 10_000_000)
    motion = cam_motion(np.linspace(0.0, 1.0, 49), 10.0, 40.0 + gap)
    cam, collar = (disc("cam", "cam", 10.0, 0.0, r, 0.0, top, 240) for r, top in ((29.9, 8.0), (30.0, 4.9)))
    mesh = (cam.manifold + collar.manifold).to_mesh64()
    cam = MeshPiece("cam", "cam", np.asarray(mesh.vert_properties)[np.asarray(mesh.tri_verts)])
    roller = disc("follower", "roller", 0, 0, 10.0, 4.9 + above, 7.0, 120)
    if gap < 0.1:
        with pytest.raises(UserError, match=r"given up: .* is proven, required 0.025 mm.*more steps do not help"):
            checked([cam, roller], motion)
        return
    (pair,) = checked([cam, roller], motion).pairs
    nearest = math.hypot(gap, above)
    assert gap - SHARP <= 1e3 * pair.proven < nearest < 1e3 * pair.gap + 1e-9


def test_proven_gaps_hold_between_the_samples() -> None:
    """A bar that whips past a post once in a turn: 40 samples, none of them near the moment it is nearest."""
    times = np.linspace(0.0, 1.0, 41)
    still = np.zeros_like(times)
    angle = 2 * math.pi * times + 0.9 * np.sin(2 * math.pi * times)
    omega = 2 * math.pi * (1 + 0.9 * np.cos(2 * math.pi * times))
    alpha = -0.9 * (2 * math.pi) ** 2 * np.sin(2 * math.pi * times)
    motion = motion_of(times, arm=(still, still, angle, still, still, omega, still, still, alpha))
    arm = box("arm", "arm", 25.0, 0.0, 0.0, (50.0, 6.0, 4.0))
    post = disc("ground", "post", 50.0 * math.cos(0.15) + 3.3, 50.0 * math.sin(0.15) + 0.5, 3.0, -5.0, 9.0, 90)
    (pair,) = checked([arm, post], motion).pairs
    sweep = Sweep(arm, post, paths(motion)["arm"], paths(motion)["ground"])
    around = (pair.time or 0.0) + np.linspace(-0.02, 0.02, 801)
    dense = min(sweep.gap_at(float(t), 5.0) for t in around)
    assert 1e3 * pair.proven <= dense <= 1e3 * pair.gap + 1e-6
    assert 1e3 * pair.gap < min(sweep.gap_at(float(t), 5.0) for t in times) - 0.05


def bounce(rows: bool, speed: float = 1.0, steps: int = 11) -> Motion:
    """A ball that falls at a constant speed (m/s), is thrown back at t = 0.5 s 10 mm above the ground and rises."""
    times = np.linspace(0.0, 1.0, steps + (steps + 1) % 2 + 1)
    if rows:
        times = np.sort(np.append(times, [0.5, 0.5]))
    after = (times > 0.5) | ((times == 0.5) & (np.arange(len(times)) > np.searchsorted(times, 0.5)))
    still = np.zeros_like(times)
    y, vy = 0.010 + speed * np.abs(times - 0.5), np.where(after, speed, -speed)
    return motion_of(times, ball=(still, y, still, still, vy, still, still, still, still))


def test_both_rows_of_an_event_make_an_impact_exact() -> None:
    """Without them the quintic overshoots by what the check then takes off; with them the gap is known."""
    ball = disc("ball", "ball", 0.0, 0.0, 8.0, 0.0, 4.0)
    floor = box("ground", "floor", 0.0, -5.0, 0.0, (400.0, 10.0, 4.0))
    (pair,) = checked([ball, floor], bounce(rows=True)).pairs
    assert pair.gap == pytest.approx(2e-3, abs=1e-9)
    assert pair.proven == pytest.approx(2e-3, abs=SHARP * 1.01e-3)
    with pytest.raises(UserError, match=r"ball|event_rows=True"):
        checked([ball, floor], bounce(rows=False))


@pytest.mark.parametrize("at", np.linspace(0.02, 0.98, 9))
def test_a_jump_of_velocity_between_samples_is_covered_by_the_error(at: float) -> None:
    """The samples are right at both ends of the interval, and the true path has a corner in between."""
    times = np.array([0.0, 1.0])
    pose, rate = np.zeros((2, 3)), np.zeros((2, 3))
    pose[1, 0], rate[1, 0] = 1.0 - at, 1.0
    path = BodyPath(times, pose, rate, np.zeros((2, 3)))
    fine = np.linspace(0.0, 1.0, 501)
    true = np.maximum(fine - at, 0.0)
    worst = np.abs(path.poses_at(fine)[:, 0] - true).max()
    assert worst <= path.interpolation_error(0.0)[0] * (1 + 1e-9)
    assert path.interpolation_error(0.0)[0] <= 10 * worst


def test_the_quintic_is_that_of_the_film() -> None:
    motion = four_bar_motion(steps=20)
    film, mine = Poses(motion), paths(motion)
    for body in ("coupler", "rocker"):
        for moment in np.linspace(0.0, motion.time[-1], 77):
            x, y, theta = film.body(body, Moment(float(moment), 0))
            np.testing.assert_allclose(mine[body].poses_at(np.array([moment]))[0], [1e3 * x, 1e3 * y, theta], atol=1e-9)


def test_points_stray_no_farther_than_the_spans_say() -> None:
    motion = four_bar_motion(steps=24)
    where = paths(motion)
    path = RelativePath(where["coupler"], where["rocker"], np.array([30.0, 12.0]), np.zeros(24))
    spans = Spans(path)
    spans.halves(np.arange(0, 24, 3))
    for k in range(len(spans)):
        times = np.linspace(spans.start[k], spans.end[k], 33)
        pose = path.place(np.full(33, spans.first[k]), times)
        for away in (0.0, 25.0):
            seen = points(pose, np.array([away, 0.0]))
            straight = seen[0] + (seen[-1] - seen[0]) * np.linspace(0.0, 1.0, 33)[:, None]
            assert np.hypot(*(seen - straight).T).max() <= spans.push[k] + away * spans.spin[k] + 1e-9
            stray = spans.stray(np.array([k]), np.array([away]))[0]
            assert np.hypot(*(seen - seen[16]).T).max() <= stray + 1e-9


def test_spans_of_many_samples_cover_all_time_and_none_crosses_an_event() -> None:
    path = paths(bounce(rows=True, steps=2001))["ball"]
    spans = Spans(RelativePath(path, path, np.zeros(2), np.zeros(len(path.first))))
    assert len(spans) < 500
    np.testing.assert_array_equal(spans.end[:-1], spans.start[1:])
    assert 0.5 in spans.end
    halves = spans.halves(np.arange(len(spans)))
    np.testing.assert_array_equal(spans.end[halves], spans.start[halves + 1])
    np.testing.assert_array_equal(spans.end[halves + 1], spans.end[: len(halves)])


@given(st.integers(0, 10_000))
@settings(max_examples=10)
def test_distance_of_triangles_is_that_of_their_best_separation(seed: int) -> None:
    """For triangles apart the way between them separates them by its length; no direction does better."""
    random = np.random.default_rng(seed)
    p, q = random.normal(size=(2, 50, 3, 3))
    q += 2 * random.normal(size=(50, 1, 3))
    gap, way = nearest(p, q)
    by = separation(way / gap[:, None], p, q)
    apart = by > 0
    assert apart.sum() > 25
    np.testing.assert_allclose(by[apart], gap[apart], atol=1e-12)
    weights = random.dirichlet(np.ones(3), size=(2, 400))
    for k in np.flatnonzero(apart)[:10]:
        between = (weights[0] @ p[k])[:, None] - (weights[1] @ q[k])[None]
        assert np.linalg.norm(between, axis=2).min() >= gap[k] - 1e-12
    for k in np.flatnonzero(~apart):  # they pierce each other: an edge of one crosses the other
        assert pierced(p[k], q[k])


def pierced(p: np.ndarray, q: np.ndarray) -> bool:
    for a, b in ((p, q), (q, p)):
        normal = np.cross(b[1] - b[0], b[2] - b[0])
        for i in range(3):
            start, end = a[i], a[(i + 1) % 3]
            low, high = (start - b[0]) @ normal, (end - b[0]) @ normal
            if low * high < 0:
                at = start + (end - start) * low / (low - high)
                if all(np.cross(b[(j + 1) % 3] - b[j], at - b[j]) @ normal >= 0 for j in range(3)):
                    return True
    return False


def test_every_group_of_facets_holds_its_facets() -> None:
    piece = disc("cam", "cam", 3.0, -2.0, 20.0, 0.0, 5.0, 37)
    tree = FacetTree(piece.triangles, piece.centre, piece.radius)
    real = ~np.isnan(tree.facets[:, 0, 0])
    axes = np.array([[tree.axis.real, tree.axis.imag], [-tree.axis.imag, tree.axis.real]])
    area = np.linalg.norm(np.cross(*(tree.facets[real][:, k] - tree.facets[real][:, 0] for k in (1, 2))), axis=1).sum()
    whole = np.linalg.norm(np.cross(*(piece.triangles[:, k] - piece.triangles[:, 0] for k in (1, 2))), axis=1).sum()
    assert area == pytest.approx(whole)
    for leaf in np.flatnonzero(real)[::17]:
        node = tree.leaves + int(leaf)
        while node:
            corners = tree.facets[leaf]
            assert np.hypot(*(corners[:, :2] - tree.centre[node]).T).max() <= tree.radius[node] + 1e-9
            inside = (corners[:, :2] - tree.box_centre[node]) @ axes.T
            assert (np.abs(inside) <= tree.box_half[node] + 1e-9).all()
            assert tree.low[node] <= corners[:, 2].min()
            assert corners[:, 2].max() <= tree.high[node]
            node //= 2


@pytest.mark.parametrize("tilt", [0.0, 0.4, 1.0])
def test_a_slider_between_rails_is_proven_by_its_flat_sides(tilt: float) -> None:
    """It runs 60 mm along its rails, 0.2 mm from each: whole walls are kept apart at once, however far they slide."""
    times = np.linspace(0.0, 1.0, 41)
    along = np.array([math.cos(tilt), math.sin(tilt)])
    way = [f(2 * math.pi * times) for f in (np.sin, np.cos, lambda x: -np.sin(x))]
    x, vx, ax, y, vy, ay = (0.03 * (2 * math.pi) ** k * u * way[k] for u in along for k in range(3))
    still = np.zeros_like(times)
    motion = motion_of(times, slider=(x, y, still + tilt, vx, vy, still, ax, ay, still))
    slider = box("slider", "slider", 0.0, 0.0, 0.0, (20.0, 10.0, 5.0))
    turned = np.array([[along[0], -along[1], 0], [along[1], along[0], 0], [0, 0, 1]])
    rails = [box("ground", f"rail {k}", 0.0, 7.2 * k, 0.0, (100.0, 4.0, 5.0)) for k in (-1, 1)]
    rails = [MeshPiece("ground", rail.name, rail.triangles @ turned.T) for rail in rails]
    for pair in checked([slider, *rails], motion).pairs:
        assert pair.gap == pytest.approx(0.2e-3)
        assert pair.proven >= 0.2e-3 - SHARP * 1e-3
    sweep = Sweep(rails[0], slider, paths(motion)["ground"], paths(motion)["slider"])
    search = Search(sweep.still.sides, sweep.mover.sides, sweep.path, sweep.still.centre)
    search.run(0.2, 0.0, 1)
    assert search.looked < 60_000


def test_plates_that_face_each_other_count_where_nothing_else_is_nearer() -> None:
    """A collar over a plate: only their horizontal faces are near, and only for a part of the turn."""
    still = np.zeros(73)
    times = np.linspace(0.0, 1.0, 73)
    angle = 2 * math.pi * times
    motion = motion_of(times, arm=(still, still, angle, still, still, still + 2 * math.pi, still, still, still))
    tooth = box("arm", "tooth", 30.0, 0.0, 5.2, (4.0, 4.0, 9.0))
    step = disc("ground", "step", -30.0, 0.0, 12.0, 0.0, 5.0)
    tower = disc("ground", "tower", -30.0, 0.0, 3.0, 4.0, 4.9)  # of the other piece nothing is as high as the tooth
    (pair,) = [pair for pair in checked([tooth, step, tower], motion).pairs if "step" in pair.pieces]
    assert pair.gap == pytest.approx(0.2e-3)
    side = box("ground", "side", -38.0, 0.0, 0.0, (4.0, 30.0, 9.0))
    both = MeshPiece("ground", "both", np.concatenate([step.triangles, side.triangles + np.array([20.0, 60.0, 0.0])]))
    (pair,) = checked([tooth, both], motion).pairs
    assert (pair.proof, pair.gap) == ("motion", pytest.approx(0.2e-3))
    assert pair.proven >= 0.19e-3
