"""Belts in the clearance: the band holds all that the film draws of them, and what is in its way is refused."""

from __future__ import annotations

import math

import manifold3d
import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mechanisms.stages.clearance.meshing import SAG, band, bands
from mechanisms.stages.clearance.path import paths
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.stage import check
from mechanisms.stages.solve.motion_file import to_motion
from render.film.poses import Moment, Poses
from render.film.tubes.belts import belts
from shared.contract import BodyParts, Held, Motion, Parts, Piece
from shared.contract.clearance import Clearance
from shared.contract.geometry import BeltPath
from shared.stage.errors import UserError
from tests.mechanisms.clearance.clearance_pieces import NO_MASS, box, disc, parts_of
from tests.render.film.test_belts import drive

HELD = Held(z=0.01, radius=0.001)


def with_rims(pieces: list[MeshPiece], *bodies: str) -> Parts:
    """Parts of the pieces; on each of the bodies one called rim holds the belt."""
    rim = Piece(
        material="steel", stl="rim.stl", step="rim.step", mass=NO_MASS, z_range=(0.0, 0.02), triangles=4,
        stl_sha256="0" * 64, holds={"belt": HELD},
    )  # fmt: skip
    parts = parts_of(pieces)
    for body in bodies:
        parts.bodies[body] = BodyParts(pieces={"rim": rim}, mass=NO_MASS, z=0.0)
    return parts


def solved(m: Mechanism, *bodies: str, end: float | None = None) -> Motion:
    sol = m.sweep(steps=48) if end is None else m.sweep(end, steps=96)
    return to_motion(sol, None, "", {}, dict.fromkeys(bodies, "mechanism"))


def checked(motion: Motion, *more: MeshPiece) -> Clearance:
    """With the two rims of :func:`tests.test_belts.drive`, which the belt touches."""
    rims = [disc("a", "rim", 0, 0, 20.5, 7.0, 13.0), disc("b", "rim", 0, 0, 40.5, 7.0, 13.0)]
    pieces = [*rims, *more]
    return check(with_rims(pieces, "a", "b"), motion, pieces, "key")


@settings(max_examples=25, deadline=None)
@given(st.floats(5, 60), st.floats(5, 60), st.floats(1.02, 3), st.booleans(), st.floats(0.3, 2))
def test_the_band_is_all_round_the_path(first: float, second: float, apart: float, crossed: bool, wide: float) -> None:
    way = BeltPath(first, second, apart * (first + second + 2 * wide), crossed)
    solid = MeshPiece("belt", "belt", band(way, wide, 2.0)).manifold
    assert solid.bounding_box()[2::3] == pytest.approx((-2.0, 2.0))
    area = solid.volume() / 4.0
    room = 2 * (wide + SAG) * way.length
    assert area < 1.01 * room + 4 * SAG * way.length
    assert area > (0.75 if crossed else 0.99) * room  # the strands that cross share some
    spots = way.places(np.linspace(0, way.length, 37))[0]
    for x, y in spots:
        corner = 0.7 * wide
        for u, v in ((corner, 0), (-corner, 0), (0, corner), (0, -corner), (corner, corner)):
            pin = manifold3d.Manifold.cylinder(1.0, 1e-3).translate((x + 0.99 * u, y + 0.99 * v, 0.0))
            assert (pin - solid).volume() < 1e-3 * pin.volume()


@pytest.mark.parametrize(("crossed", "teeth"), [(False, None), (True, None), (False, (16, 32))])
def test_all_that_the_film_draws_is_in_the_band(crossed: bool, teeth: tuple[int, int] | None) -> None:
    motion = solved(drive(crossed, teeth), "a", "b")
    [belt_band] = bands(with_rims([], "a", "b"), motion, paths(motion))
    [belt] = belts(motion, {"belt": HELD})
    solid, poses = belt_band.piece.manifold, Poses(motion)
    low, high = belt_band.piece.z_range
    for time in (0.0, 0.31):
        x, y, turn = belt_band.path.poses_at(np.array([time]))[0]
        for spec, path in zip(belt.specs, belt.paths(poses, Moment(time, 0)), strict=True):
            points = 1000 * np.array(path)
            upright = len(path) == 2 and path[0][:2] == path[1][:2]
            reach = 0.0 if upright else 1000 * spec.radius
            assert points[:, 2].min() - reach > low - 1e-6
            assert points[:, 2].max() + reach < high + 1e-6
            c, s = math.cos(turn), math.sin(turn)
            seen = (points[:, :2] - [x, y]) @ np.array([[c, -s], [s, c]])
            shadow = solid.project()
            for u, v in seen[:: max(1, len(seen) // 8)]:
                disc_there = manifold3d.CrossSection.circle(1000 * spec.radius * 0.999, 48).translate((u, v))
                assert (disc_there - shadow).area() < 2e-3 * disc_there.area()


def test_pieces_clear_of_the_belt_pass() -> None:
    """Its own pulleys, a post between the strands, a bar over the belt; and the belt is one of what is compared."""
    motion = solved(drive(turn=0.0), "a", "b")
    inside, over = (
        box("ground", "post", 60.0, 20.0, 0.0, (6, 6, 20)),
        box("ground", "bar", 60.0, 50.0, 12.0, (20, 60, 4)),
    )
    clearance = checked(motion, inside, over)
    near = {pair.pieces: pair for pair in clearance.pairs if "belt belt" in pair.bodies}
    assert near["bar", "belt"].proof == "layers"
    assert near["bar", "belt"].gap == pytest.approx(12e-3 - 10e-3 - 1.06e-3)


@pytest.mark.parametrize("crossed", [False, True])
def test_a_post_in_a_strand_is_refused(crossed: bool) -> None:
    """The post is in the upper strand of an open belt, and where the strands of a crossed one cross."""
    motion = solved(drive(crossed, turn=0.0), "a", "b")
    lean = math.asin(20 / 120)  # upper tangent of an open belt: 30 mm over the line at its middle
    at = (10 + 120 * 20 / 60, 20.0) if crossed else (10 + 60, 20.0 + 30 / math.cos(lean) + 0.9)
    with pytest.raises(UserError, match=r"belt belt: belt and ground: post|ground: post and belt belt: belt"):
        checked(motion, box("ground", "post", *at, 0.0, (2, 2, 20)))


def test_a_crank_pin_of_a_pulleys_own_body_that_meets_the_strand_is_refused() -> None:
    motion = solved(drive(turn=0.0), "a", "b")
    with pytest.raises(UserError, match=r"pin and belt belt: belt|belt belt: belt and a: pin"):
        checked(motion, disc("a", "pin", 30.0, 0.0, 3.0, 5.0, 15.0))
    checked(motion, disc("a", "hub", 0.0, 0.0, 15.0, 0.0, 25.0))


def test_the_band_goes_round_with_a_carrier() -> None:
    m = Mechanism("carried")
    arm, planet = m.body("arm"), m.body("b")
    m.revolute("A", m.ground.at(0.01, 0.02), arm.origin)
    m.revolute("B", arm.at(0.12, 0), planet.origin)
    m.belt("belt", m.ground.at(0.01, 0.02), planet.origin, 0.02, 0.04)
    m.drive_angle("motor", arm, constant_rate(2 * math.pi, 0.3))
    m.start_near(arm=17, b=40)
    motion = solved(m, "arm", "b", end=1.0)
    where = paths(motion)
    [belt_band] = bands(with_rims([], "b"), motion, where)
    times = np.linspace(0.0, 1.0, 331)
    place = belt_band.path.poses_at(times)
    assert place[:, :2] == pytest.approx(np.broadcast_to([10.0, 20.0], (331, 2)))
    assert place[:, 2] == pytest.approx(where["arm"].poses_at(times)[:, 2], abs=1e-7)
    rim = disc("b", "rim", 0, 0, 40.5, 7.0, 13.0)
    far, near = (box("ground", "post", 10.0, 20.0 + y, 0.0, (4, 4, 20)) for y in (-175.0, -80.0))
    check(with_rims([rim, far], "b"), motion, [rim, far], "key")
    with pytest.raises(UserError, match=r"post and belt belt: belt|belt belt: belt and ground: post"):
        check(with_rims([near], "b"), motion, [near], "key")


@pytest.mark.parametrize("released", [0.0, 0.25, 0.51, 0.99, None])
def test_a_belt_counts_until_an_event_releases_it(released: float | None) -> None:
    """A post comes down and enters the upper strand after 0.8 s."""
    m = drive(turn=0.0)
    post = m.body("post")
    rail = m.ground.at(0.07, 0.12, -math.pi / 2)
    m.prismatic("guide", rail, post.at(0.0, 0.0, -math.pi / 2))
    m.drive_coordinate("down", rail, post.origin, constant_rate(0.08))
    m.start_near(a=17, b=40, post=(0.07, 0.12, 0.0))
    motion = solved(m, "a", "b", "post", end=1.0)
    motion.joints["belt"] = msgspec.structs.replace(motion.joints["belt"], released=released)
    moving = disc("post", "tip", 0.0, 0.0, 2.0, 0.0, 20.0)
    if released is not None and released < 0.8:
        assert checked(motion, moving).apart
    else:
        with pytest.raises(UserError, match=r"tip and belt belt: belt|belt belt: belt and post: tip"):
            checked(motion, moving)
