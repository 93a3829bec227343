"""Gaps by the outlines of pieces: they are those of the meshes, and nothing is proven of outlines that cover others."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mechanisms.stages.clearance import outlines
from mechanisms.stages.clearance.outlines import Outline, covers, least_by_outlines, nearest, outline
from mechanisms.stages.clearance.path import BodyPath
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import RESOLUTION, Sweep
from tests.mechanisms.clearance.clearance_pieces import box, disc

TIMES = np.linspace(0.0, 1.0, 37)


def _turning(x: float, y: float, speed: float, start: float = 0.0) -> BodyPath:
    still = np.zeros_like(TIMES)
    pose = np.column_stack([still + x, still + y, start + speed * TIMES])
    return BodyPath(TIMES, pose, np.column_stack([still, still, still + speed]), np.zeros((len(TIMES), 3)))


def _joined(*pieces: MeshPiece) -> MeshPiece:
    """As one solid: the union."""
    from functools import reduce

    solid = reduce(lambda a, b: a + b, (piece.manifold for piece in pieces))
    return _of(pieces[0], solid)


def _less(piece: MeshPiece, other: MeshPiece) -> MeshPiece:
    return _of(piece, piece.manifold - other.manifold)


def _of(piece: MeshPiece, solid: object) -> MeshPiece:
    mesh = solid.to_mesh64()  # pyright: ignore[reportAttributeAccessIssue]
    return MeshPiece(piece.body, piece.name, np.asarray(mesh.vert_properties)[np.asarray(mesh.tri_verts)])


def _area(shadow: Outline) -> float:
    (ax, ay), (bx, by) = shadow.edges[:, 0].T, shadow.edges[:, 1].T
    return float((shadow.times * (ax * by - bx * ay)).sum() / 2)


def test_the_outline_is_the_edge_of_the_shadow() -> None:
    """A bored column on a flange: the column above, the flange where the heights hold some of it."""
    flange, column = disc("ground", "a", 3.0, 1.0, 20.0, 0.0, 4.0), disc("ground", "a", 3.0, 1.0, 8.0, 3.0, 30.0)
    stand = _less(_joined(flange, column), disc("ground", "a", 3.0, 1.0, 5.0, -1.0, 31.0))

    def disc_area(radius: float) -> float:
        return 32 * radius**2 * math.sin(2 * math.pi / 64)

    for low, high, radius in ((5.0, 40.0, 8.0), (0.5, 3.0, 20.0), (1.0, 10.0, 20.0), (-5.0, 50.0, 20.0)):
        shadow = outline(stand, low, high)
        assert shadow is not None
        assert len(shadow.edges) == 128, "an outer and an inner circle"
        assert _area(shadow) == pytest.approx(disc_area(radius) - disc_area(5.0))
    assert outline(stand, 31.0, 32.0) is None


def test_points_inside_are_found_and_points_in_bores_are_not() -> None:
    """Also in a clamp, whose two arms lie over each other: its edges wind round a point once or twice."""
    ring = outline(_less(disc("a", "a", 0, 0, 20.0, 0, 5), disc("a", "a", 0, 0, 10.0, -1, 6)), -1.0, 9.0)
    arms = _joined(
        box("a", "a", 0, 0, 0, (40, 10, 2)), box("a", "a", 5, 0, 4, (30, 10, 2)), box("a", "a", 15, 0, 0, (8, 8, 6))
    )
    clamp = outline(arms, -1.0, 9.0)
    assert ring
    assert clamp
    for x, y, in_ring, in_clamp in (
        (0, 0, False, True), (15, 1, True, True), (0, -15, True, False), (19.9, 0.1, True, True), (25, 0, False, False),
        (-18, 1, True, True), (-9.9, 4.9, True, True), (3, 4, False, True),
    ):  # fmt: skip
        for shadow, inside in ((ring, in_ring), (clamp, in_clamp)):
            assert covers(shadow, np.array([[x, y]])) == inside


@given(
    st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=4, max_size=4),
    st.sampled_from([1e-3, 1.0, 1e3]),
)
def test_distance_of_segments_is_that_of_their_points(ends: list[tuple[float, float]], scale: float) -> None:
    a, b, c, d = (scale * complex(*end) for end in ends)
    assume(abs(a - b) > 0 and abs(c - d) > 0)
    gap, way = nearest(np.array([[a, b]]), np.array([[c, d]]))
    u = np.linspace(0, 1, 201)
    sampled = np.abs((a + u * (b - a))[:, None] - (c + u * (d - c))[None]).min()
    assert gap[0] <= sampled + 1e-9 * scale
    assert gap[0] >= sampled - (abs(b - a) + abs(d - c)) / 200
    assert gap[0] == 0 or abs(way[0]) == pytest.approx(gap[0])


@pytest.mark.parametrize("seed", range(6))
def test_what_outlines_tell_is_what_the_meshes_tell(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stars and bored plates that turn beside each other: the same gap as the facets give, proven as sharply."""
    rng = np.random.default_rng(seed)
    reach = rng.uniform(8, 14)
    star = _joined(*(
        box("star", "star", 0.0, 0.0, 0.0, (2 * reach, 4.0, 5.0)),
        disc("star", "star", 0.0, 0.0, rng.uniform(4, 7), 0.0, 5.0, 24),
        disc("star", "star", 0.0, 0.0, 18.0, 8.0, 10.0, 24),
    ))  # fmt: skip
    star = _joined(star, disc("star", "star", 0.0, 0.0, 3.0, 1.0, 9.0, 12))
    plate = _less(
        box("plate", "plate", 4.0, 0.0, 1.0, (20.0, 12.0, 4.0)), disc("plate", "plate", 5.0, 0.0, 4.0, 0.0, 9.0, 20)
    )
    away = math.hypot(reach, 2.0) + math.hypot(14.0, 6.0) + rng.uniform(0.1, 1.0)
    paths = _turning(0, 0, rng.uniform(3, 7)), _turning(away, rng.uniform(-3, 3), rng.uniform(-7, 7), 1.0)
    pair = Sweep(star, plate, *paths)
    told = outlines.least_gap(pair, 5.0)
    if told.gap < 3.0:  # of the collar over the plate
        assert least_by_outlines(pair, pair.gap_at(0.0, 5.0), 0.0, 1) is not None
    monkeypatch.setattr(outlines, "least_by_outlines", lambda *_: None)
    slow = outlines.least_gap(pair, 5.0)
    assert told.gap == pytest.approx(slow.gap, abs=RESOLUTION)
    for measured in (told, slow):
        assert measured.gap - RESOLUTION <= measured.proven <= measured.gap
        assert pair.gap_at(measured.time, 5.0) == pytest.approx(measured.gap, abs=1e-9)


def test_outlines_that_cover_others_prove_nothing() -> None:
    """A pin over a plate, its foot beside the plate; a pin inside a plate; and one in a bore, which is beside it."""
    plate = box("ground", "plate", 0.0, 0.0, 0.0, (40.0, 40.0, 5.0))
    over = _joined(
        disc("arm", "pin", 0, 0, 3.0, 5.5, 9.0),
        box("arm", "pin", 30, 0, 3.0, (12, 4, 5)),
        box("arm", "pin", 15, 0, 6.0, (30, 3, 1)),
    )
    still, turn = _turning(0, 0, 0.0), _turning(0, 0, 0.1)
    pair = Sweep(plate, over, still, turn)
    told = least_by_outlines(pair, 5.0, 0.0, 1)
    assert told is not None, "nothing is nearer than 0.5 mm in height"
    assert told.gap == pytest.approx(0.5, abs=1e-6)
    assert told.gap - RESOLUTION <= told.proven <= told.gap
    alone = disc("arm", "pin", 0, 0, 3.0, 5.5, 9.0)
    assert least_by_outlines(Sweep(plate, alone, still, turn), 5.0, 0.0, 1) is None, "they have no height in common"
    inside = disc("arm", "pin", 0.0, 0.0, 3.0, 1.0, 4.0)
    bored = _less(plate, disc("ground", "hole", 0.0, 0.0, 4.0, -1.0, 9.0))
    free = Sweep(bored, inside, still, turn)
    assert least_by_outlines(free, 5.0, 0.0, 1) is not None, "a pin in a bore is beside the plate"
    assert least_by_outlines(Sweep(plate, inside, still, turn), 5.0, 0.0, 1) is None
