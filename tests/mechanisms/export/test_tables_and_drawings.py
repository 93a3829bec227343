"""Tables and drawings of the export: CSV, DXF and SVG."""

from __future__ import annotations

import csv
import io
import math
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest
from ezdxf.filemanagement import new, read
from ezdxf.lldxf.validator import is_valid_table_name
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mbsd.base.files import FORMULA, csv_text, frame_csv
from mbsd.drawing.look import body_inks
from mechanisms.stages.dxf_file import LONGEST, Layers
from mechanisms.stages.export import stage
from mechanisms.stages.export import stage as export
from mechanisms.stages.export.assembly import Wanted
from mechanisms.stages.export.drawings import dxf, svg
from mechanisms.stages.print.making import HEADER, Bought, table
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out

# Tables of the motion, and drawings of a pose: one to one, in millimetres.


@pytest.fixture(scope="module")
def solution() -> Any:
    m = Mechanism("crank")
    crank = m.bar("crank", 0.05, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.trace("P", crank.end)
    return m.sweep(steps=36)


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_tables_hold_the_motion(solution: Any, form: str) -> None:
    content, left_out = stage.FORMATS[form][1](Wanted(solution, 0.0, Out("crank"), None))
    table = pandas.read_csv(io.BytesIO(content)) if form == "csv" else pandas.read_parquet(io.BytesIO(content))
    assert left_out == []
    assert np.array_equal(table["t [s]"], solution.t)
    assert np.array_equal(
        table[next(name for name in table if "crank" in name and "theta" in name)], solution.body("crank").theta
    )


def test_a_drawing_is_one_to_one_in_millimetres_at_its_time(solution: Any) -> None:
    root = ElementTree.fromstring(svg(solution, 0.0))
    assert root.get("width", "").endswith("mm")
    assert float(root.get("width", "")[:-2]) == float(root.get("viewBox", "").split()[2])
    path = next(line for line in root.iter("{http://www.w3.org/2000/svg}polyline") if len(line))
    points = np.array([pair.split(",") for pair in path.get("points", "").split()], float)
    assert np.ptp(points, axis=0) == pytest.approx([100.0, 100.0], rel=1e-3)
    assert svg(solution, 0.0) != svg(solution, 1.0)
    assert body_inks(solution.mechanism)["crank"] in {line.get("fill") for line in root.iter()}
    document = read(io.StringIO(dxf(solution, 0.0)))
    assert document.header["$INSUNITS"] == 4
    layers = {entity.dxf.layer for entity in document.modelspace()}
    assert {"crank", "ground", "path P"} <= layers
    (trace,) = document.modelspace().query('LWPOLYLINE[layer=="path P"]')
    corners = np.array([point[:2] for point in trace.get_points()])
    assert np.hypot(*corners.T) == pytest.approx(50.0)


def test_an_unknown_format_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UserError, match=r"no format 'mjfc' to export; choose one of: csv.*did you mean 'mjcf'"):
        stage.run("four_bar", "mjfc")


def test_a_time_that_the_motion_has_not_is_reported(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    stage.run("four_bar", "svg", 0.5)
    assert "warning" not in capsys.readouterr().err
    stage.run("four_bar", "svg", 99.0)
    assert "four_bar: the motion is from 0 to 1 s; the pose is that of 1 s" in capsys.readouterr().err


# No text of a table is a formula to a spreadsheet, and every number is one.


EVIL = '=HYPERLINK("http://elsewhere";A1)'
values = st.one_of(st.text(max_size=20), st.floats(), st.integers())


def _read(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text, newline="")))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


@given(st.lists(st.text(max_size=20), min_size=2, max_size=2), st.lists(st.tuples(values, values), max_size=5))
def test_texts_are_no_formulas_and_numbers_stay(names: list[str], rows: list[tuple[object, object]]) -> None:
    text = csv_text(names, rows)
    assert not [cell for row in _read(text) for cell in row if cell.startswith(FORMULA) and not _is_number(cell)]
    for row, seen in zip(rows, _read(text)[1:], strict=True):
        for value, cell in zip(row, seen, strict=True):
            if isinstance(value, float):
                assert cell == "" if math.isnan(value) else float(cell) == value
            elif isinstance(value, int):
                assert int(cell) == value


@pytest.mark.parametrize("word", ["=1+1", "+crank", "-rod", "@sum", "\tcrank", "-1+1|cmd"])
def test_words_like_a_formula_have_an_apostrophe(word: str) -> None:
    assert _read(csv_text(["name"], [[word]])) == [["name"], [f"'{word}"]]


def test_numbers_below_zero_stay_numbers() -> None:
    assert csv_text(["a"], [[-1.5], ["-1.5"], [-3], [math.nan]]) == 'a\n-1.5\n-1.5\n-3\n""\n'


def test_tables_of_pandas_have_the_same_cells() -> None:
    frame = pandas.DataFrame({EVIL: [-1.5, math.nan], "why": [EVIL, None]})
    assert _read(frame_csv(frame, index=False)) == [[f"'{EVIL}", "why"], ["-1.5", f"'{EVIL}"], ["", ""]]
    assert list(frame.columns) == [EVIL, "why"], "it is left as it was"


def test_names_of_bodies_and_pieces_are_no_formulas() -> None:
    """A body's name went into tables as it was."""
    m = Mechanism("crank")
    crank = m.bar(EVIL, 0.05, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(-1.0))
    content, _ = export.FORMATS["csv"][1](Wanted(m.sweep(steps=4), 0.0, Out("crank"), None))
    head, *rows = _read(content.decode())
    assert any(EVIL in name for name in head)
    assert not [name for name in head if name.startswith(FORMULA)]
    assert all(_is_number(cell) for row in rows for cell in row)
    rows = _read(table([], [Bought("+M3 screw", (EVIL, "b"), "-steel")]))
    assert len(rows[1]) == len(HEADER)
    assert rows[1][1] == "'+M3 screw"
    assert rows[1][3] == "'-steel"
    assert rows[1][-1] == f"'{EVIL} b"


# DXF files have the same bytes in every process, and layers that programs can read, whatever bodies are called.


BOTH = """
import cadquery
from mbsd import Mechanism, constant_rate
from mechanisms.stages.export import drawings
from mechanisms.stages.print import plates
m = Mechanism("crank")
crank = m.bar("crank", 0.05, mass=1.0)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.drive_angle("motor", crank, constant_rate(1.0))
print(drawings.dxf(m.sweep(steps=8), 0.0))
cut = cadquery.Workplane().ellipse(20, 10).spline([(30, 0), (40, 5), (50, -3)]).circle(4).rect(80, 60)
print(plates.dxf(cut, 5.0).decode())
"""


def _printed(seed: int) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": str(seed), "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", BOTH], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_another_process_at_another_time_writes_the_same_bytes() -> None:
    assert _printed(1) == _printed(2)


def test_bodies_with_names_that_no_layer_can_have_are_drawn() -> None:
    """This ended in a traceback of ezdxf."""
    m = Mechanism("press")
    crank, rod = m.bar("crank: 1/2*", 0.05, mass=1.0), m.bar("Crank_ 1_2_", 0.15, mass=1.0)
    slider = m.body("signs", mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.trace("a<b", rod.end)
    m.start_near(**{"crank: 1/2*": 0.0, "Crank_ 1_2_": 0.0})
    document = read(io.StringIO(dxf(m.sweep(steps=8), 0.0)))
    layers = {entity.dxf.layer for entity in document.modelspace()}
    assert {"crank_ 1_2_", "Crank_ 1_2_ (2)", "path a_b", "ground"} <= layers
    assert len({layer for layer in layers if layer.startswith("signs")}) == 2


@given(st.lists(st.text(min_size=1, max_size=300), min_size=1, max_size=6, unique=True))
def test_every_name_has_a_layer_of_its_own(names: list[str]) -> None:
    document = new("R2010")
    layers = Layers(document)
    allowed = [layers.named(name) for name in names]
    assert [layers.named(name) for name in names] == allowed
    assert len({name.casefold() for name in allowed}) == len(names)
    assert all(is_valid_table_name(name) and 0 < len(name) <= LONGEST and name.isprintable() for name in allowed)
    assert all(document.layers.has_entry(name) for name in allowed)
