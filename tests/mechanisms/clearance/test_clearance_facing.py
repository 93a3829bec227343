"""Pieces that never lie over each other are told by their sides alone, and the others are not."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mechanisms.stages.clearance import outlines
from mechanisms.stages.clearance.outlines import BESIDE, never_over
from mechanisms.stages.clearance.path import BodyPath, paths
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import RESOLUTION, Sweep
from tests.mechanisms.clearance.clearance_pieces import box, disc
from tests.mechanisms.clearance.test_clearance_between import cam_motion


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
    assert quick.gap == pytest.approx(whole.gap, abs=RESOLUTION)
    assert quick.gap - RESOLUTION - 1e-3 <= quick.proven <= whole.gap + 1e-9
