"""Every shape of the part library over its range of sizes."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.stages.parts.meshes import combined, mass_of, only_solid
from shared.contract import Mass
from shared.shapes import base, engraving, outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye, link, plate_link
from shared.shapes.pin import Groove, Head, Pivot, bushing, circlip, pin, stylus, washer
from shared.shapes.screw import SOCKET, socket_screw
from shared.shapes.solid import placed
from shared.shapes.units import cubic_metres, inertia_metres, metres, mm
from tests.shared.shape_checks import checked

few = settings(max_examples=6)


def sizes(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high).map(lambda size: round(size, 2))


@few
@given(
    length=sizes(38, 400),
    thickness=sizes(4, 12),
    bore=sizes(3, 11),
    above=st.sampled_from([0.0, 1.0, 4.4]),
    below=st.sampled_from([0.0, 2.0]),
    taper=sizes(0.7, 1.0),
)
def test_link(length: float, thickness: float, bore: float, above: float, below: float, taper: float) -> None:
    eye = Eye(bore / 2 + 5.0, bore, above, below)
    width = 2 * eye.radius * 0.65
    solid, mesh = checked(link(length, thickness, eye, eye, (width, taper * width), fillet=5.0), 2)
    assert mesh.bounds[0] == pytest.approx([-eye.radius, -eye.radius, -below], abs=0.03)
    assert mesh.bounds[1] == pytest.approx([length + eye.radius, eye.radius, thickness + above], abs=0.03)
    assert solid.Center().y == pytest.approx(0.0, abs=1e-6)


@few
@given(length=sizes(70, 300), thickness=sizes(5, 10), depth=sizes(0.8, 2.0))
def test_pockets_lighten_a_link_and_leave_its_holes(length: float, thickness: float, depth: float) -> None:
    eye = Eye(12.0, 8.0)
    full, _ = checked(link(length, thickness, eye, eye, (17.0, 14.0)), 2)
    milled, _ = checked(link(length, thickness, eye, eye, (17.0, 14.0), pocket=depth), 2)
    assert milled.Volume() < full.Volume()


@few
@given(
    x=sizes(30, 90),
    y=sizes(28, 80),
    thickness=sizes(3, 9),
    waist=st.sampled_from([math.inf, 240.0, 400.0]),
    windowed=st.booleans(),
)
def test_plate_link(x: float, y: float, thickness: float, waist: float, windowed: bool) -> None:
    joints = [(0.0, 0.0, Eye(12.0, 8.0)), (120.0, 0.0, Eye(12.0, 8.0)), (x, y, Eye(7.0, 4.0, above=1.5, boss=5.2))]
    shape = plate_link(joints, thickness, waist, rims=(2.5, 5.0, 5.0) if windowed else None)
    checked(shape, 4 if windowed else 3)


@few
@given(diameter=sizes(3, 16), length=sizes(12, 90), headed=st.booleans(), grooved=st.booleans())
def test_pin(diameter: float, length: float, headed: bool, grooved: bool) -> None:
    head = Head(1.8 * diameter, 4.0) if headed else None
    groove = Groove(0.3 * length, 1.0, 0.06 * diameter) if grooved else None
    _, mesh = checked(pin(diameter, length, head, groove), 0)
    assert mesh.bounds[:, 2] == pytest.approx([0.0, length + (4.0 if headed else 0.0)], abs=0.02)


@few
@given(inner=sizes(3, 20), ring=sizes(1.5, 6), thickness=sizes(0.5, 3))
def test_washer(inner: float, ring: float, thickness: float) -> None:
    checked(washer(inner, inner + 2 * ring, thickness), 1)


@few
@given(inner=sizes(4, 20), wall=sizes(0.8, 3), flange=sizes(1, 5), length=sizes(2, 20))
def test_bushing(inner: float, wall: float, flange: float, length: float) -> None:
    outer = inner + 2 * wall
    _, mesh = checked(bushing(inner, outer, outer + 2 * flange, 1.2, length), 1)
    assert mesh.bounds[:, 2] == pytest.approx([-length, 1.2], abs=0.01)


@few
@given(inner=sizes(3, 20), thickness=sizes(0.6, 2))
def test_circlip_is_open_and_has_two_eyes(inner: float, thickness: float) -> None:
    solid, _ = checked(circlip(inner, thickness), 2)
    assert solid.Center().x != 0.0
    turned = only_solid(placed(circlip(inner, thickness), turn=180.0), "turned")
    assert turned.Center().x == pytest.approx(-solid.Center().x)


@few
@given(diameter=sizes(2.5, 8), length=sizes(4, 12), height=sizes(4, 12))
def test_stylus(diameter: float, length: float, height: float) -> None:
    ball = 0.2 * diameter
    _, mesh = checked(stylus(diameter, length, height, ball), 0)
    assert mesh.bounds[:, 2] == pytest.approx([-length, height], abs=0.02)


@pytest.mark.parametrize("nominal", SOCKET)
def test_socket_screw(nominal: float) -> None:
    checked(socket_screw(nominal, 3 * nominal), 0)


def test_an_unknown_screw_is_refused() -> None:
    with pytest.raises(ValueError, match=r"no socket screw M7; there is M1\.6, M2, M2\.5"):
        socket_screw(7.0, 20.0)


@few
@given(x=sizes(60, 300), y=sizes(50, 150), thickness=sizes(8, 20), holes=st.integers(0, 4))
def test_base_plate(x: float, y: float, thickness: float, holes: int) -> None:
    corners = [(12.0, 12.0), (x - 12.0, y - 12.0), (12.0, y - 12.0), (x - 12.0, 12.0)][:holes]
    shape = base.base_plate((0, 0, x, y), thickness, 10.0, corners, tapped=[(x / 2, y / 2, 3.4, 6.0)])
    _, mesh = checked(shape, holes)
    assert mesh.bounds[:, 2] == pytest.approx([-thickness, 0.0], abs=1e-6)


@few
@given(height=sizes(8, 80), screws=st.integers(2, 6))
def test_pedestal_and_foot(height: float, screws: int) -> None:
    checked(base.pedestal(height, 8.02, 17.0, 20.0, 39.0, 4.0, screws, 3.0, 31.0), 1 + screws)
    checked(base.foot(18.0, min(height, 6.0), 5.4), 1)


@pytest.mark.parametrize("letter", engraving.LETTERS)
def test_every_letter_engraves(letter: str) -> None:
    block = extruded(outline.rounded_rectangle(-8, -8, 8, 8, 1.0), 3.0)
    shape = engraving.engraved(block, engraving.text(letter, 6.0, 0.0, 0.0), 3.0)
    solid, _ = checked(shape, 0)
    assert 0.5 < only_solid(block, "block").Volume() - solid.Volume() < 10.0


def test_rule_and_dial_engrave() -> None:
    block = extruded(outline.rounded_rectangle(-30, -30, 30, 30, 3.0), 3.0)
    strokes = engraving.rule(40.0, -20.0, -27.0) + engraving.dial(0.0, 0.0, 14.0, 15.0)
    assert len(strokes) == 9 + 24
    checked(engraving.engraved(block, strokes, 3.0), 0)


def test_letters_that_cannot_be_engraved_are_named() -> None:
    with pytest.raises(ValueError, match="cannot engrave 'ß'"):
        engraving.text("ß", 5.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: link(20.0, 6.0, Eye(12, 8), Eye(12, 8), (15.0, 15.0)), "a link of 20 mm has no room"),
        (lambda: link(90.0, 6.0, Eye(7, 8), Eye(12, 8), (15.0, 15.0)), "end radius 7 mm must exceed"),
        (lambda: link(90.0, 5.0, Eye(12, 8), Eye(12, 8), (17.0, 15.0), pocket=2.2), "leave less than 1 mm of a web"),
        (lambda: outline.window([(0, 0), (40, 0), (20, 10)], (6.0, 6.0, 6.0), 2.0), "the rims leave no window"),
        (lambda: outline.rounded_rectangle(0, 0, 30, 10, 6.0), "corner radius 6 mm is too large"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(make, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def test_a_pivot_leaves_its_fits() -> None:
    pivot = Pivot()
    low, high = (only_solid(piece.shape, piece.name) for piece in pivot.bushings("B", 0, 0, 10.0, 8.0))
    assert low.distance(high) == pytest.approx(0.2 + 2 * pivot.fit.seat, abs=1e-6)
    bolt = only_solid(pin(pivot.pin, 40.0), "pin")
    assert low.distance(bolt) == pytest.approx(pivot.fit.running / 2, abs=1e-6)


@few
@given(length=sizes(60, 300), radius=sizes(7, 15), thickness=sizes(4, 10))
def test_mass_of_a_link_by_hand(length: float, radius: float, thickness: float) -> None:
    """A stadium with two bores of 8 mm, chamfered by 0.4 mm at both mouths."""
    eye = Eye(radius, 8.0)
    solid, _ = checked(plate_link([(0, 0, eye), (length, 0, eye)], thickness, edge=0.0), 2)
    mass = mass_of(solid, 2700.0)
    web, ends = 2 * radius * length, math.pi * radius**2
    hole = math.pi * 16.0 * thickness + 2 * math.pi * 0.4**2 * (4.0 + 0.4 / 3)
    volume = (web + ends) * thickness - 2 * hole
    # a half disc: its middle is 4 r / 3 pi from the straight side, and r^2/2 is its gyration about the full centre
    offset = 4 * radius / (3 * math.pi)
    about_ends = ends * (radius**2 / 2 - offset**2 + (length / 2 + offset) ** 2)
    about_web = web * (length**2 + 4 * radius**2) / 12
    inertia = (about_web + about_ends) * thickness - 2 * hole * (length**2 / 4 + 8.0)
    assert mass.mass == pytest.approx(2.7e-6 * volume, rel=1e-6)
    assert mass.com == pytest.approx((length / 2e3, 0.0), abs=1e-9)
    assert mass.inertia == pytest.approx(2.7e-12 * inertia, rel=2e-4)


def test_bodies_combine_by_the_parallel_axis_theorem() -> None:
    pieces = [extruded(outline.circle(x, 0.0, 5.0), 4.0) for x in (0.0, 30.0)]
    solids = [only_solid(piece, "disc") for piece in pieces]
    together = combined([mass_of(solids[0], 1000.0), mass_of(solids[1], 3000.0)])
    disc = math.pi * 25e-6 * 4e-3 * 1000.0
    assert together.mass == pytest.approx(4 * disc)
    assert together.com == pytest.approx((0.0225, 0.0), abs=1e-12)
    own = 4 * disc * (5e-3) ** 2 / 2
    assert together.inertia == pytest.approx(own + disc * 0.0225**2 + 3 * disc * 0.0075**2)
    nothing = combined([])
    assert nothing == Mass(mass=0.0, com=(0.0, 0.0), inertia=0.0, volume=0.0)


def test_units_convert_both_ways() -> None:
    assert mm(0.12) == pytest.approx(120.0)
    assert metres(mm(0.12)) == pytest.approx(0.12)
    assert cubic_metres(1e9) == pytest.approx(1.0)
    assert inertia_metres(1e15) == pytest.approx(1.0)


def test_the_same_hardware_is_built_once_and_nobody_changes_it_for_others() -> None:
    first, second, longer = socket_screw(3.0, 8.0), socket_screw(3.0, 8.0), socket_screw(3.0, 9.0)
    assert first.val() is second.val()
    assert first is not second
    assert longer.val().Volume() > first.val().Volume()
    volume = second.val().Volume()
    first.add(longer)
    assert placed(first, 5.0).val().Center().x == pytest.approx(5.0)
    assert len(socket_screw(3.0, 8.0).vals()) == 1
    assert socket_screw(3.0, 8.0).val().Volume() == volume
