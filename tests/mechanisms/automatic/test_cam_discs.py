"""Discs of cams with any closed outline, and what the CAD kernel cannot make of automatic parts."""

from __future__ import annotations

import numpy as np
import pytest
from OCP.StdFail import StdFail_NotDone

from mechanisms.stages.automatic import assembly
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.curves import curve_path, set_back
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.cams import cam_disc
from shared.shapes.facets import volume_of
from shared.shapes.outline import distances
from shared.stage.errors import UserError
from tools.models.four_bars import model

SAW = ((0.0, 1.0), (0.08, 0.0), (0.5, 0.3))
"""Places of a tooth: parts of its pitch, and of its height."""


def _wheel(teeth: int, low: float, radius: float = 60.0) -> list[tuple[float, float]]:
    """Points of an escape wheel, clockwise (mm)."""
    turn = [-2 * np.pi * (tooth + part) / teeth for tooth in range(teeth) for part, _ in SAW]
    away = [radius * (low + (1 - low) * height) for _ in range(teeth) for _, height in SAW]
    return [(r * np.cos(t), r * np.sin(t)) for r, t in zip(away, turn, strict=True)]


@pytest.mark.parametrize(("teeth", "low"), [(15, 0.7)])
def test_a_wheel_of_sharp_teeth_is_a_sound_disc(teeth: int, low: float) -> None:
    """The kernel's chamfer failed with "command not done"."""
    path = curve_path(_wheel(teeth, low), True)
    shape = only_solid(cam_disc(path, 7.0), "cam")
    mesh = read_mesh(stl_bytes(shape))
    check_mesh(mesh, volume_of(shape), 0, "cam")
    x, y = path.T
    area = abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1))) / 2
    assert mesh.volume == pytest.approx(7.0 * area, rel=2e-3)
    assert distances(mesh.vertices[:, :2], np.vstack([path, path[:1]])).max() < 0.03


def test_a_smooth_disc_keeps_its_chamfer() -> None:
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    outline = np.column_stack([30 * np.cos(turn), 24 * np.sin(turn)])
    assert cam_disc(outline, 7.0).faces().size() == 5
    assert cam_disc(outline, 7.0, 0.0).faces().size() == 3


def test_a_curve_with_sharp_corners_is_set_back_without_loops() -> None:
    path = curve_path(_wheel(15, 0.8), True)
    moved = set_back(path, 4.0)
    gap = distances(moved, np.vstack([path, path[:1]]))
    assert gap.min() == pytest.approx(4.0, abs=0.05)
    assert gap.max() < 4.0 + 0.05
    assert len(set_back(path, 70.0)) == 0


def test_what_the_kernel_cannot_make_is_refused_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    m = model((0.03, 0.1, 0.08, 0.09))
    made = Automatic(m, m.sweep(times=np.linspace(0, 1, 11)))

    def fails(*_: object) -> None:
        raise StdFail_NotDone("BRep_API: command not done")

    monkeypatch.setattr(assembly, "body_shape", fails)
    with pytest.raises(UserError, match=r"the CAD kernel cannot make the plate of 'crank'.*command not done"):
        made.solids(engraved_too=False)
