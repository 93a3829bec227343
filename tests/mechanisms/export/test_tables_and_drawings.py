"""Tables of the motion, and drawings of a pose: one to one, in millimetres."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest
from ezdxf.filemanagement import read

from mbsd import Mechanism, constant_rate
from mbsd.drawing.look import body_inks
from mechanisms.stages.export import stage
from mechanisms.stages.export.assembly import Wanted
from mechanisms.stages.export.drawings import dxf, svg
from shared.stage.errors import UserError
from shared.stage.paths import Out


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
