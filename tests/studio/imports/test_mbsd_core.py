"""Files of mbsd-core: a slider-crank against its closed form; what is spatial, a result or open is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from shared.stage.errors import UserError
from studio.imports.reading import read
from tests.studio.imports.imported import SAMPLES, built

SAMPLE = SAMPLES / "slider_crank_mbsd_core.json"
CRANK, ROD, OFFSET = 0.05, 0.15, 0.01


def changed(tmp_path: Path, **parts: object) -> Path:
    file = tmp_path / "changed.json"
    file.write_text(json.dumps({**json.loads(SAMPLE.read_text()), **parts}))
    return file


def test_a_slider_crank_moves_as_its_closed_form() -> None:
    sketch, m, _ = built(SAMPLE)
    assert sketch.left_out == []
    assert m.mobility().dof == 1
    assert m.gravity == (0.0, -9.81)
    assert (m.bodies["rod"].mass, m.bodies["rod"].inertia) == (0.3, 0.001)
    sol = m.sweep(0.5, steps=50)
    angle = 0.4 + 12.0 * sol.t
    side = np.sqrt(ROD**2 - (OFFSET - CRANK * np.sin(angle)) ** 2)
    x = CRANK * np.cos(angle) + side * np.sign(sol.body("piston").x[0] - CRANK * np.cos(angle[0]))
    np.testing.assert_allclose(sol.body("crank").theta, angle, atol=1e-9)
    np.testing.assert_allclose(sol.body("piston").x, x, atol=1e-9)
    np.testing.assert_allclose(sol.body("piston").y, OFFSET, atol=1e-9)
    assert m.bodies["crank"].com == pytest.approx((0.02, 0.0), abs=1e-9)


def test_functions_of_python_are_named(tmp_path: Path) -> None:
    drive = {"index": 0, "kind": "coordinate_drive", "count": 1, "body": 1, "coordinate": "theta", "value": "law"}
    sketch = read(str(changed(tmp_path, user_constraints=[drive])))
    assert sketch.motors == []
    assert "constraint 0 of crank (theta): its function is Python" in sketch.left_out[0]


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        ({"schema": "mbsd.spatial.model"}, "it is a spatial mechanism"),
        ({"schema": "mbsd.planar.result"}, "not a mechanism"),
        ({"schema_version": 3}, "its schema_version is 3"),
        ({"joints": {}}, "KeyError"),
        ({"bodies": "none"}, "TypeError"),
    ],
)
def test_files_without_a_planar_mechanism_are_refused(tmp_path: Path, parts: dict[str, object], said: str) -> None:
    with pytest.raises(UserError, match=said):
        read(str(changed(tmp_path, **parts)))


def test_links_that_cannot_close_are_refused(tmp_path: Path) -> None:
    joints = json.loads(SAMPLE.read_text())["joints"]
    joints["prismatic"][0]["point_rail"] = [0.0, 0.5]
    with pytest.raises(UserError, match="no pose was found"):
        read(str(changed(tmp_path, joints=joints)))
