"""The proof by outlines in the plane, and along the line of a slide."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mechanisms.stages.clearance import outlines
from mechanisms.stages.clearance.outlines import Outline, covers, least_by_outlines, least_gap, nearest, outline
from mechanisms.stages.clearance.path import BodyPath, paths
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import RESOLUTION, Sweep
from mechanisms.stages.clearance.slide import sliced, slide_gap, slides_of
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.solve.motion_file import to_motion
from shared.contract import Motion
from shared.contract.clearance import Clearance
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import box, disc, parts_of

# Gaps by the outlines of pieces: they are those of the meshes, and nothing is proven of outlines that cover others.


TIMES = np.linspace(0.0, 1.0, 37)


def _turning(x: float, y: float, speed: float, start: float = 0.0) -> BodyPath:
    still = np.zeros_like(TIMES)
    pose = np.column_stack([still + x, still + y, start + speed * TIMES])
    return BodyPath(TIMES, pose, np.column_stack([still, still, still + speed]), np.zeros((len(TIMES), 3)))


def _joined(*pieces: MeshPiece) -> MeshPiece:
    """As one solid: the union."""
    from functools import reduce

    solid = reduce(lambda a, b: a + b, (piece.manifold for piece in pieces))
    return _mesh_piece(pieces[0], solid)


def _less(piece: MeshPiece, other: MeshPiece) -> MeshPiece:
    return _mesh_piece(piece, piece.manifold - other.manifold)


def _mesh_piece(piece: MeshPiece, solid: object) -> MeshPiece:
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
    st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=4, max_size=4), st.sampled_from([1e-3, 1.0, 1e3])
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
def test_gaps_of_outlines_are_those_of_the_meshes(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
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


# The gap of pieces that slide along a line, at every place at once.


def slider(angle: float, aside: float = 0.0) -> Motion:
    """A slider-crank whose slider goes along a line at ``angle`` (rad), ``aside`` of the shaft (m)."""
    m = Mechanism("slider")
    crank, rod, block = m.bar("crank", 0.02), m.bar("rod", 0.08), m.body("block", 1.0)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.origin)
    m.prismatic("guide", m.ground.at(-aside * math.sin(angle), aside * math.cos(angle), angle), block.origin)
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    turn = math.degrees(angle)
    m.start_near(crank=turn, rod=turn, block=turn)
    return to_motion(m.sweep(steps=60), None, "0" * 64, {})


def turned(piece: MeshPiece, angle: float, along: float = 0.0, aside: float = 0.0) -> MeshPiece:
    c, s = math.cos(angle), math.sin(angle)
    moved = piece.triangles + np.array([along, aside, 0.0])
    return MeshPiece(piece.body, piece.name, moved @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]))


def walls(gap: float, angle: float, aside: float = 0.0) -> list[MeshPiece]:
    """A block 20 mm wide between two walls on ground."""
    block = box("block", "block", 0.0, 0.0, 0.0, (16.0, 20.0, 10.0))
    left = turned(box("ground", "left", 70.0, 12.5 + gap, -5.0, (90.0, 5.0, 20.0)), angle, aside=aside)
    right = turned(box("ground", "right", 70.0, -12.5 - gap, -5.0, (90.0, 5.0, 20.0)), angle, aside=aside)
    return [block, left, right]


def checked(pieces: list[MeshPiece], motion: Motion) -> Clearance:
    return check(parts_of(pieces), motion, pieces, "0" * 64)


@pytest.mark.parametrize(("angle", "aside"), [(0.0, 0.0), (0.7, 0.004), (math.pi / 2, -0.006)])
def test_a_block_between_walls_is_proven_along_its_line(angle: float, aside: float) -> None:
    clearance = checked(walls(0.12, angle, 1e3 * aside), slider(angle, aside))
    for pair in clearance.pairs:
        assert pair.proof == "slide"
        assert pair.gap == pytest.approx(0.12e-3, abs=2e-6)
        assert clearance.limit <= pair.proven <= pair.gap
        assert pair.time is None
    assert len(clearance.pairs) == 2


def test_a_block_that_is_too_wide_is_caught() -> None:
    with pytest.raises(UserError, match="block: block and ground: left"):
        checked(walls(-0.2, 0.0), slider(0.0))
    with pytest.raises(UserError, match=r"as near as 0\.03 mm"):
        checked(walls(0.03, 0.4), slider(0.4))


def test_pieces_in_the_way_are_left_to_the_motion() -> None:
    """A post behind the block at its outer end: seen along the line they overlap, in the motion they stay apart."""
    motion = slider(0.0)
    post = disc("ground", "post", 115.0, 0.0, 4.0, -5.0, 15.0)
    block = walls(0.2, 0.0)[0]
    assert slide_gap(block, post, slides_of(motion, paths(motion))) is None
    (pair,) = checked([block, post], motion).pairs
    assert pair.proof == "motion"
    assert pair.gap == pytest.approx(3e-3, abs=1e-5)


@pytest.mark.parametrize(("end", "proof", "gap"), [(17.0, "slide", 0.12), (3.0, "slide", 0.12), (0.08, "motion", 0.08)])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_pieces_out_of_reach_along_the_line_are_left_out(end: float, proof: str, gap: float, angle: float) -> None:
    """A cylinder with a closed end, ``end`` mm from where the block turns back."""
    block, wall, _ = walls(0.12, angle)
    stop = turned(box("ground", "end", 108.0 + end + 2.5, 0.0, -5.0, (5.0, 18.0, 20.0)), angle)
    closed = MeshPiece("ground", "left", np.concatenate([wall.triangles, stop.triangles]))
    (pair,) = checked([block, closed], slider(angle)).pairs
    assert pair.proof == proof
    assert pair.gap == pytest.approx(gap * 1e-3, abs=2e-6)
    assert pair.proven <= pair.gap


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_stem_is_proven_along_its_line_and_its_disc_by_the_motion(angle: float) -> None:
    """A block with a collar that comes as near as 0.3 mm to the end of the wall along which the block runs."""
    block = walls(0.12, angle)[0]
    collar = box("block", "block", -11.1, 8.0, 0.0, (6.0, 16.0, 10.0))  # behind the block, and wider
    piece = MeshPiece("block", "block", np.concatenate([block.triangles, collar.triangles]))
    guide = turned(box("ground", "left", 116.1, 12.62, -5.0, (47.8, 5.0, 20.0)), angle)
    motion = slider(angle)
    assert slide_gap(piece, guide, slides_of(motion, paths(motion)), 5.0) is None
    slices = sliced(piece, guide, slides_of(motion, paths(motion)), 5.0)
    assert slices is not None
    assert slices.gap == pytest.approx(0.12, abs=2e-3)
    assert slices.rest
    (pair,) = checked([piece, guide], motion).pairs
    whole = least_gap(Sweep(piece, guide, paths(motion)["block"], paths(motion)["ground"]), 5.0)
    assert pair.gap == pytest.approx(whole.gap * 1e-3, abs=2e-6)
    assert pair.proven <= pair.gap


def test_bodies_without_such_a_joint_have_no_line() -> None:
    motion = slider(0.0)
    assert set(slides_of(motion, paths(motion))) == {frozenset(("ground", "block"))}
