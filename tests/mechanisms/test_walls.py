"""How thin the walls of a piece are."""

from __future__ import annotations

import cadquery as cq
import pytest

from mechanisms.stages.parts_files import read_triangles, stl_bytes
from mechanisms.stages.print.making import thinnest
from shared.shapes.build import extruded
from shared.shapes.outline import circle


def wall(shape: cq.Workplane) -> float:
    return thinnest(read_triangles(stl_bytes(shape.val())))


def test_of_a_plate_it_is_its_thickness() -> None:
    assert wall(cq.Workplane().box(40, 30, 0.6)) == pytest.approx(0.6, abs=1e-5)


@pytest.mark.parametrize("thick", [0.3, 0.8])
def test_of_a_tube_it_is_that_of_its_wall(thick: float) -> None:
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
