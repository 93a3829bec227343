"""Sketches in DXF: circles as pins, lines as links, layers for what the ground is and what turns."""

from __future__ import annotations

import io
import math
from pathlib import Path

import pytest
from ezdxf.filemanagement import new

from shared.stage.errors import UserError
from studio.imports.reading import read
from tests.studio.imports.imported import built

PINS = {"A": (0.0, 0.0), "B": (0.0, 40.0), "C": (110.0, 90.0), "D": (120.0, 0.0), "E": (60.0, 110.0)}


def sketched(tmp_path: Path, units: int = 4, motor: str = "motor", ground: str = "ground", end: str = "\n") -> Path:
    """Write a four-bar with a coupler point: three lines on a layer, and two rings at D."""
    document = new("R2010", units=units)
    space = document.modelspace()
    for name, place in PINS.items():
        layer = {"A": motor}.get(name, "0")
        space.add_circle(place, 3.0, dxfattribs={"layer": layer})
    space.add_circle(PINS["D"], 5.0)
    space.add_line(PINS["A"], PINS["B"])
    for first, second in (("B", "C"), ("C", "E"), ("E", "B")):
        space.add_line(PINS[first], PINS[second], dxfattribs={"layer": "coupler"})
    space.add_lwpolyline([PINS["C"], (PINS["D"][0], PINS["D"][1] + 4.0)])  # within the outer ring
    space.add_line(PINS["A"], PINS["D"], dxfattribs={"layer": ground})
    space.add_line((500.0, 0.0), (600.0, 0.0))
    space.add_text("notes are passed over")
    text = io.StringIO()
    document.write(text)
    file = tmp_path / "bench.dxf"
    file.write_text(text.getvalue().replace("\n", end), newline="")
    return file


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize(("units", "unit"), [(4, 0.001), (1, 0.0254), (6, 1.0), (0, 0.001)])
def test_a_sketch_becomes_a_mechanism(tmp_path: Path, units: int, unit: float, end: str) -> None:
    sketch, m, _ = built(sketched(tmp_path, units, end=end))
    assert set(sketch.links) == {"AB", "BCE", "CD"}
    assert m.mobility().dof == 1
    sol = m.sweep(steps=36)
    assert sol.body("ab").omega == pytest.approx(math.tau)
    assert (sol.point("E").x[0], sol.point("E").y[0]) == pytest.approx((60 * unit, 110 * unit))
    assert sketch.left_out == ["1 line not from pin to pin"]
    assert sketch.unit == ("" if units else "a millimetre")


def test_without_a_motor_it_is_left_to_its_user(tmp_path: Path) -> None:
    sketch, m, _ = built(sketched(tmp_path, motor="ground"))
    assert sketch.motors == []
    assert m.mobility().dof == 1


def test_files_without_a_sketch_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.dxf"
    text = io.StringIO()
    document = new("R2010")
    document.modelspace().add_line((0, 0), (1, 1))
    document.write(text)
    file.write_text(text.getvalue())
    with pytest.raises(
        UserError, match=r"circles as pins, and lines from circle to circle as links; this one has 1 LINE"
    ):
        read(str(file))
    file.write_text(text.getvalue()[:600])
    with pytest.raises(UserError, match=r"a\.dxf"):
        read(str(file))
