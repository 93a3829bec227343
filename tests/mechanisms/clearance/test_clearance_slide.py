"""The gap of pieces that slide along a line, at every place at once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.clearance.outlines import least_gap
from mechanisms.stages.clearance.path import paths
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import Sweep
from mechanisms.stages.clearance.slide import sliced, slide_gap, slides_of
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.solve.motion_file import to_motion
from shared.contract import Motion
from shared.contract.clearance import Clearance
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import box, disc, parts_of


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


def test_what_stands_in_the_way_is_left_to_the_motion() -> None:
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
def test_what_is_out_of_reach_along_the_line_is_left_out(end: float, proof: str, gap: float, angle: float) -> None:
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
