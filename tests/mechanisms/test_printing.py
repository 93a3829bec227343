"""Pieces for the printer: plates, walls, and the stage."""

from __future__ import annotations

import io
import math
import tempfile
from pathlib import Path

import cadquery as cq
import ezdxf.path
import numpy as np
import pytest
from ezdxf.filemanagement import read
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from hypothesis.strategies import floats, integers, lists, tuples

from mechanisms.stages.parts_files import read_triangles, step_bytes, stl_bytes
from mechanisms.stages.print.laying import Laid, fitting, groups, is_equal, laid, sheet_of
from mechanisms.stages.print.making import thinnest
from mechanisms.stages.print.plates import dxf, layer_of, packed, section
from shared.shapes.base import foot, pedestal
from shared.shapes.build import extruded
from shared.shapes.link import Eye, link
from shared.shapes.outline import circle
from shared.shapes.pin import Head, bushing, pin, washer
from shared.shapes.solid import placed
from tests.mechanisms.printed_pieces import arm, corner, plate

# How pieces are laid, told apart, packed and outlined.


few = settings(max_examples=3, deadline=None, phases=[Phase.explicit, Phase.reuse, Phase.generate])


def down(shape: cq.Workplane) -> Laid:
    return laid(read_triangles(stl_bytes(shape.val())))


@given(
    lists(tuples(floats(1.0, 90.0), floats(1.0, 90.0)), min_size=1, max_size=40),
    floats(90.0, 200.0),
    floats(90.0, 200.0),
    floats(0.0, 12.0),
    integers(0, 3),
)
@settings(max_examples=30, deadline=None)
def test_packed_rectangles_stay_on_the_bed_and_apart(
    rectangles: list[tuple[float, float]], x: float, y: float, gap: float, repeats: int
) -> None:
    rectangles = rectangles + rectangles[:1] * repeats
    places = packed(rectangles, (x, y), gap)
    assert len(places) == len(rectangles)
    boxes = [
        (at.plate, at.x, at.y, at.x + (b if at.turned else a), at.y + (a if at.turned else b))
        for (a, b), at in zip(rectangles, places, strict=True)
    ]
    for k, (number, x0, y0, x1, y1) in enumerate(boxes):
        assert min(x0, y0) >= 0
        assert x1 <= x + 1e-4
        assert y1 <= y + 1e-4
        for other, u0, v0, u1, v1 in boxes[:k]:
            assert other != number or max(x0 - u1, u0 - x1, y0 - v1, v0 - y1) >= gap - 1e-4
    used = sorted({box[0] for box in boxes})
    assert used == list(range(len(used)))
    assert places == packed(rectangles, (x, y), gap)


def test_a_rectangle_larger_than_the_bed_is_refused() -> None:
    with pytest.raises(ValueError, match="120 x 30 mm is larger than the bed of 100 x 100 mm"):
        packed([(10.0, 10.0), (120.0, 30.0)], (100.0, 100.0), 5.0)


@pytest.mark.parametrize(
    ("shape", "up"),
    [
        (arm(), "boss up"),
        (pedestal(30.0, 8.0, 17.0, 20.0, 39.0, 4.0, 3, 3.0, 31.0), "on its flange"),
        (bushing(8.0, 11.0, 17.6, 1.2, 5.0), "on its flange"),
        (foot(18.0, 3.0, 5.4), "on its wide end"),
        (pin(8.0, 30.0, Head(14.0, 4.0, 1.6)), "on its head"),
    ],
)
@few
@given(st.tuples(*[floats(-180.0, 180.0)] * 3))
def test_a_piece_lies_on_its_broad_flat_side_however_it_was_turned(
    shape: cq.Workplane, up: str, angles: tuple[float, float, float]
) -> None:
    """The lower half holds more of the piece than the upper one."""
    turned = shape
    for angle, axis in zip(angles, ((1, 0, 0), (0, 1, 0), (0, 0, 1)), strict=True):
        turned = turned.rotate((0, 0, 0), axis, angle)
    piece, as_made = down(turned), down(shape)
    assert piece.size == pytest.approx(as_made.size, abs=0.02), up
    assert piece.vertices.min(axis=0) == pytest.approx(0.0, abs=1e-9)
    corners = piece.triangles
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert corners.mean(axis=1)[:, 2] @ volumes * 3 / 4 / volumes.sum() <= piece.size[2] / 2 + 0.01
    assert piece.turn @ piece.turn.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(piece.turn) == pytest.approx(1.0)
    original = np.unique(read_triangles(stl_bytes(turned.val())).reshape(-1, 3), axis=0)
    assert np.abs(original @ piece.turn.T + piece.shift - piece.vertices).max() < 1e-6


@few
@given(floats(0.0, 360.0), floats(-80.0, 80.0), st.booleans())
def test_equal_pieces_are_found_wherever_they_are(angle: float, x: float, over: bool) -> None:
    for make in (plate, lambda: corner(False), lambda: washer(8.2, 14.0, 1.0)):
        other = make().rotate((0, 0, 0), (1, 0, 0), 180) if over else make()
        assert is_equal(down(make()), down(placed(other, x, -x, 5.0, angle)))


@few
@given(floats(0.0, 360.0))
def test_mirror_images_and_other_sizes_are_not_equal(angle: float) -> None:
    assert not is_equal(down(corner(False)), down(placed(corner(True), turn=angle)))
    assert not is_equal(down(bushing(8.0, 11.0, 17.6, 1.2, 5.0)), down(bushing(8.0, 11.0, 17.6, 1.2, 5.02)))


def test_pieces_of_two_materials_are_two_kinds() -> None:
    piece = down(washer(8.2, 14.0, 1.0))
    assert groups([("steel", piece), ("brass", piece), ("steel", piece)]) == [[0, 2], [1]]


def test_a_long_piece_is_turned_until_it_fits() -> None:
    bar = down(cq.Workplane().box(150, 12, 6))
    across = fitting(bar, (116.0, 116.0))
    assert across is not None
    assert max(across.size[:2]) <= 116.0
    assert fitting(bar, (114.0, 114.0)) is None
    assert fitting(bar, (12.0, 150.0)) is bar


@pytest.mark.parametrize(
    ("shape", "thickness", "above"),
    [
        (plate(), 8.0, 0.0),
        (arm(), 7.0, 4.0),
        (link(90.0, 7.0, Eye(13.0, 8.0), Eye(12.5, 8.0), (17.0, 14.0), pocket=2.2), 7.0, 0.0),
        (washer(8.2, 14.0, 1.0), 1.0, 0.0),
        (pedestal(30.0, 8.0, 17.0, 20.0, 39.0, 4.0, 3, 3.0, 31.0), None, None),
        (link(60.0, 7.0, Eye(13.0, 8.0, below=2.0), Eye(12.5, 8.0, above=4.0), (17.0, 15.0)), None, None),
        (pin(8.0, 30.0), None, None),
        (cq.Workplane().box(60, 40, 8).edges("|Y").chamfer(3.5, 19.0), None, None),
    ],
)
def test_sheet_pieces_are_recognised(shape: cq.Workplane, thickness: float | None, above: float | None) -> None:
    sheet = sheet_of(down(shape))
    if thickness is None:
        assert sheet is None
    else:
        assert sheet is not None
        assert sheet.thickness == pytest.approx(thickness, abs=1e-3)
        assert sheet.above == pytest.approx(above, abs=1e-3)


@few
@given(floats(0.0, 360.0), st.booleans())
def test_an_outline_is_closed_and_has_the_area_of_the_section(angle: float, over: bool) -> None:
    loops = loops_of(outline_of(plate(), angle, over))
    hole = pytest.approx(math.pi * 9.0, rel=1e-3)
    assert sorted(loops) == [hole, hole, pytest.approx(6000.0 - (4 - math.pi) * 64.0, rel=1e-4)]


def test_an_outline_of_arcs_and_of_splines_is_closed() -> None:
    """The link's volume between two heights is its section's area times their distance."""
    wave = [(10 * k, 6.0 * math.sin(k)) for k in range(8)]
    bent = cq.Workplane().spline(wave).lineTo(70, 30).lineTo(0, 30).close().extrude(4.0)
    loops = loops_of(outline_of(bent, 20.0, True))
    assert loops == [pytest.approx(bent.val().Volume() / 4.0, rel=1e-4)]
    slab = arm().intersect(cq.Workplane().box(200, 200, 1.0).translate((0, 0, 3.5)))
    loops = sorted(loops_of(outline_of(arm(), 33.0, False)))
    assert loops[-1] - sum(loops[:-1]) == pytest.approx(slab.val().Volume(), rel=1e-4)
    assert len(loops) == 3


def outline_of(shape: cq.Workplane, angle: float, over: bool) -> bytes:
    if over:
        shape = shape.rotate((0, 0, 0), (1, 0, 0), 180)
    shape = placed(shape, 11.0, -40.0, 9.0, angle)
    piece = down(shape)
    sheet = sheet_of(piece)
    assert sheet is not None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.step"
        path.write_bytes(step_bytes(shape.val(), "piece"))
        content = dxf(section(path, piece, sheet.thickness / 2), sheet.thickness)
    entities = list(read(io.StringIO(content.decode())).modelspace())
    assert {entity.dxf.layer for entity in entities} == {layer_of(sheet.thickness)}
    size = ezdxf.path.bbox([ezdxf.path.make_path(entity) for entity in entities])
    assert tuple(size.extmin) == pytest.approx((0.0, 0.0, 0.0), abs=0.05)
    assert tuple(size.extmax)[:2] == pytest.approx(piece.size[:2], abs=0.05)
    return content


def loops_of(content: bytes) -> list[float]:
    """Areas (mm^2) of the closed loops in a DXF; each end of a line, arc or spline meets exactly one other."""
    document = read(io.StringIO(content.decode()))
    assert document.units == 4  # millimetres
    lines = [np.array([(p.x, p.y) for p in path_of(entity)]) for entity in document.modelspace()]
    areas = []
    while lines:
        chain = lines.pop()
        while np.linalg.norm(chain[0] - chain[-1]) > 1e-4:
            ends = [k for k, line in enumerate(lines) if min(_apart(chain, line)) < 1e-4]
            assert len(ends) == 1, "an outline is open, or branches"
            following = lines.pop(ends[0])
            first, last = _apart(chain, following)
            chain = np.concatenate([chain, following if first < last else following[::-1]])
        x, y = chain.T
        areas.append(abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2)
    return areas


def path_of(entity: object) -> list:
    return list(ezdxf.path.make_path(entity).flattening(1e-4))


def _apart(chain: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """From the end of one to the start and to the end of the other."""
    return float(np.linalg.norm(other[0] - chain[-1])), float(np.linalg.norm(other[-1] - chain[-1]))


# How thin the walls of a piece are.


def wall(shape: cq.Workplane) -> float:
    return thinnest(read_triangles(stl_bytes(shape.val())))


def test_the_thinnest_wall_of_a_plate_is_its_thickness() -> None:
    assert wall(cq.Workplane().box(40, 30, 0.6)) == pytest.approx(0.6, abs=1e-5)


@pytest.mark.parametrize("thick", [0.3, 0.8])
def test_the_thinnest_wall_of_a_tube_is_its_wall(thick: float) -> None:
    tube = extruded(circle(0, 0, 5.0 + thick), 12.0, holes=[circle(0, 0, 5.0)])
    assert wall(tube) == pytest.approx(thick, abs=0.04)


def test_chamfers_and_wedges_are_no_walls() -> None:
    eased = cq.Workplane().box(20, 20, 10).edges().chamfer(0.2)
    wedge = cq.Workplane().polyline([(0, 0), (30, 0), (0, 15)]).close().extrude(8)
    assert wall(eased) == pytest.approx(10.0, abs=1e-4)
    assert wall(wedge) == pytest.approx(8.0, abs=1e-4)


def test_engraved_lines_are_no_walls() -> None:
    """Two grooves 0.2 mm deep, and 0.25 mm apart."""
    plate = cq.Workplane().box(30, 20, 4)
    for x in (0.0, 0.55):
        plate = plate.cut(cq.Workplane().box(0.3, 8, 0.4).translate((x, 0, 2)))
    assert wall(plate) > 3.0
