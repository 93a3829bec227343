"""Rounded limbs and the mannequin made of them: sound solids of any size, balls that fit into their sockets."""

from __future__ import annotations

import math

import pytest

from shared.shapes import mannequin
from shared.shapes.mannequin import AROUND, joint_ball, limb, socket
from tests.shared.shape_checks import checked


def test_a_limb_of_equal_sections_is_an_elliptic_cylinder() -> None:
    """But for its flats: a polygon within each ellipse."""
    shape = limb([(0, 0, 30, 20), (50, 0, 30, 20), (100, 0, 30, 20)])
    assert shape.val().Volume() == pytest.approx(AROUND / 2 * math.sin(2 * math.pi / AROUND) * 30 * 20 * 100)
    assert shape.val().Volume() == pytest.approx(math.pi * 30 * 20 * 100, rel=0.02)
    checked(shape, 0)


def test_a_domed_end_bulges_as_far_as_was_asked() -> None:
    box = limb([(0, 5, 30, 20), (100, 5, 30, 20)], 15, 40).val().BoundingBox()
    assert (box.xmin, box.xmax) == (pytest.approx(-15, abs=0.5), pytest.approx(140, abs=1.0))
    assert (box.ymin, box.ymax) == (pytest.approx(-25, abs=0.3), pytest.approx(35, abs=0.3))


def test_a_socket_leaves_room_for_its_ball() -> None:
    shape = socket(limb([(0, 0, 30, 30), (100, 0, 30, 30)]), 110, 35)
    assert shape.intersect(joint_ball(34).translate((110, 0, 0))).val().Volume() == pytest.approx(0.0, abs=1e-6)
    checked(shape, 0)


@pytest.mark.parametrize("sections", [[(0, 0, 1, 1)], [(0, 0, 1, 1), (0, 0, 2, 2)]])
def test_sections_that_do_not_follow_each_other_are_refused(sections: list) -> None:
    with pytest.raises(ValueError, match="two or more sections at rising x"):
        limb(sections)


def test_the_mannequin_is_sound() -> None:
    made = [
        *mannequin.thigh(436, 1.0),
        *mannequin.shank(438, 1.0),
        *mannequin.foot(1.0, 69),
        *mannequin.torso(513, 1.0),
        *mannequin.arm(331, 356, 1.0, (513, 0.0), (170.0, 200.0), 38.0),
        *mannequin.torso(430, 0.85),  # of other proportions, too
    ]
    for solid in made:
        checked(solid.shape, solid.through_holes)
    pairs = mannequin.both_sides(made[:2], 340.0, mannequin.LEG)
    assert [solid.name for solid in pairs] == ["thigh_far", "hip_ball_far", "thigh_near", "hip_ball_near"]
    assert pairs[0].shape.val().Center().z == pytest.approx(340 - mannequin.LEG, abs=0.5)
