"""Outlines of a leg on a bicycle, and outlines that are joined to the plates of automatic parts."""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.four_bar.mechanism import Params, build
from mechanisms.stages.automatic.automatic import automatic
from shared.shapes import leg
from shared.shapes.build import eased, extruded
from shared.shapes.outline import circle
from shared.stage.errors import UserError
from tests.shared.shape_checks import checked


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
@pytest.mark.parametrize("outline", [leg.thigh, leg.calf, leg.foot])
def test_outlines_make_valid_solids_of_any_size(outline, scale: float) -> None:
    flat = cq.Face.makeFromWires(outline(440.0)).Area()
    shape = eased(extruded(outline(440.0 * scale), 16.0 * scale), 0.8 * scale)
    assert shape.val().isValid()
    assert shape.val().Volume() == pytest.approx(16.0 * flat * scale**3, rel=0.03)
    if scale == 1.0:
        checked(shape, 0)


def test_joints_are_within_their_outlines() -> None:
    for outline, x, y in (
        (leg.thigh(400), 0, 0),
        (leg.thigh(400), 400, 0),
        (leg.calf(440), 440, 0),
        (leg.foot(440), 0, 0),
    ):
        eye = cq.Face.makeFromWires(circle(x, y, 22.0))
        assert cq.Face.makeFromWires(outline).intersect(eye).Area() == pytest.approx(eye.Area(), rel=1e-6)
    both = cq.Face.makeFromWires(leg.calf(440)).intersect(cq.Face.makeFromWires(leg.foot(440)))
    assert both.Area() > 2000.0  # the ankle


@pytest.mark.parametrize(("radius", "teeth", "arms"), [(95.0, 44, 5), (40.0, 20, 3), (300.0, 52, 6)])
def test_a_chainring_has_a_window_between_each_two_arms(radius: float, teeth: int, arms: int) -> None:
    rim, windows = leg.chainring(radius, teeth, arms, 0.38 * radius)
    assert len(windows) == arms
    checked(extruded(rim, 10.0, holes=windows), arms)
    assert rim.BoundingBox().xlen == pytest.approx(2 * radius, rel=0.01)


@given(st.floats(0, 2 * math.pi), st.integers(5, 40), st.floats(0.02, 50.0))
@settings(max_examples=15, deadline=None)
def test_arcs_through_points_of_a_circle_are_the_circle(start: float, count: int, radius: float) -> None:
    angles = start + 2 * math.pi * np.arange(count) / count
    wire = leg.smooth([(math.cos(a), math.sin(a)) for a in angles], radius)
    assert wire.IsClosed()
    assert wire.Length() == pytest.approx(2 * math.pi * radius, rel=1e-6)


def test_a_joined_outline_is_a_part_of_the_plate_and_keeps_others_away() -> None:
    plain, made = automatic(build(Params())), automatic(build(Params()))
    made.join("crank", circle(0, 0, 25.0), holes=[circle(0, 18, 3.0)], sharp=True)
    crank = made.solids(engraved_too=False)["crank"][0]
    low, high = made.span("crank")
    box = crank.shape.val().BoundingBox()
    assert (box.xmin, box.zmax - box.zmin) == (pytest.approx(-25.0), pytest.approx(high - low, abs=5.0))
    checked(crank.shape, crank.through_holes)
    assert crank.through_holes == plain.solids(engraved_too=False)["crank"][0].through_holes + 1
    for body in ("coupler", "rocker"):
        made.join(body, circle(0, 0, 400.0))
    assert len(set(made.levels.values())) == 3  # all sweep over each other
    with pytest.raises(UserError, match=r"there is no body 'crnak' to shape.*did you mean 'crank'"):
        made.join("crnak", circle(0, 0, 25.0))
