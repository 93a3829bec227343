"""Cams with followers and Geneva drives as automatic parts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from OCP.StdFail import StdFail_NotDone

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, flat_cam, roller_cam
from mechanisms.stages.automatic import assembly
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.cams import Cam, GenevaDrive
from mechanisms.stages.automatic.layout.curves import curve_path, set_back
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.cams import cam_disc
from shared.shapes.facets import volume_of
from shared.shapes.outline import distances
from shared.stage.errors import UserError
from tools.models.four_bars import model
from tools.models.guided import geneva

# Layers and places of Geneva drives and cams by themselves. No CAD is built.


LIFT = Lift.of((2.0, 0.02, "cycloidal"), (1.0, 0.02), (2.0, 0.0, "cycloidal"), (2 * math.pi - 5.0, 0.0))


def _planned(m: Mechanism, duration: float) -> Automatic:
    return Automatic(m, m.sweep(duration, 300))


def _follower(flat: bool) -> Mechanism:
    """A cam of 35 mm base radius under a follower on a guide, which turns at 2 pi rad/s."""
    m = Mechanism("lifter")
    cam, follower = m.body("cam"), m.body("follower")
    m.revolute("O", m.ground.at(0, 0), cam.origin)
    m.prismatic("guide", m.ground.at(0, 0.12, math.pi / 2), follower.at(0, 0.075, math.pi / 2))
    if flat:
        m.cam_flat("contact", cam.origin, follower.origin, flat_cam(LIFT, 0.035))
    else:
        m.cam_roller("contact", cam.origin, follower.origin, roller_cam(LIFT, 0.035, 0.012))
    m.drive_angle("motor", cam, constant_rate(2 * math.pi))
    m.start_near(follower=(0, 0.04, 0))
    return m


def _cam(made: Automatic) -> Cam:
    return made.layout.select(Cam)[0]


@pytest.mark.parametrize("slots", [3, 4, 6])
def test_geneva_has_room_for_its_hubs_and_pins(slots: int) -> None:
    made = _planned(geneva(slots), 2 * math.pi)
    assert made.levels["crank"] != made.levels["wheel"]
    drive = made.layout.select(GenevaDrive)[0]
    sizes, shape = made.sizes, drive.shape
    assert shape.distance == pytest.approx(sizes.of_metres(0.1))
    assert shape.bottom > sizes.eye  # the hub stays within the slots' bottoms
    assert shape.least_hub > sizes.hardware + 2.5  # the disc's hole stays within its cut
    assert shape.lock < shape.radius - shape.slot / 2 - 3.9
    assert 2 * shape.rim * math.sin(math.pi / slots) > 2 * shape.slot


@pytest.mark.parametrize(("top", "head"), [("arm", True), ("wheel", False)])
def test_head_of_the_pin_of_a_geneva_has_room_under_an_arm_that_carries_both(top: str, head: bool) -> None:
    m = Mechanism("carried")
    arm, crank, wheel = m.body("arm"), m.body("crank"), m.body("wheel")
    m.revolute("A", m.ground.at(0, 0), arm.origin)
    m.revolute("O", arm.at(0, 0), crank.origin)
    m.revolute("W", arm.at(0.1, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, 4, 0.1 * math.sin(math.pi / 4))
    m.drive_angle("turn", arm, constant_rate(0.2))
    m.drive_relative_angle("motor", arm, crank, constant_rate(1.0))
    m.start_near(wheel=5)
    made = _planned(m, 2 * math.pi)
    drive = made.layout.select(GenevaDrive)[0]
    levels = {"crank": 0, "wheel": 1, "arm": 2} if top == "arm" else {"arm": 0, "crank": 1, "wheel": 2}
    above = [need for need in drive.needs(levels, made.layout) if need.gap == levels["wheel"]]
    assert bool(above) == head
    assert all(need.height > made.sizes.head.height for need in above)


def test_roller_is_short_of_the_cam_by_the_clearance_all_the_way() -> None:
    made = _planned(_follower(flat=False), 1.0)
    assert made.levels["cam"] != made.levels["follower"]
    cam, scale = _cam(made), made.sizes.scale
    assert cam.roller is not None
    centre = made.layout.seen("follower", cam.at[:2], "cam")
    gaps = np.linalg.norm(cam.outline[None] - centre[:, None], axis=2).min(axis=1) - cam.roller
    assert gaps.min() * scale == pytest.approx(cam.clear * scale, abs=2e-3)
    assert gaps.max() * scale == pytest.approx(cam.clear * scale, abs=5e-3)
    assert cam.clear * scale > 0.05


def test_face_is_short_of_the_cam_and_long_enough() -> None:
    made = _planned(_follower(flat=True), 1.0)
    assert made.levels["cam"] != made.levels["follower"]
    cam, scale = _cam(made), made.sizes.scale
    # A translating face is touched at the speed of the lift beside its line (Norton, Design of Machinery, ch. 8).
    fastest = 2 * 0.02 / 2.0 * 1e3 / scale
    assert max(abs(cam.face[0]), abs(cam.face[1])) == pytest.approx(fastest, rel=0.04)
    deepest = max(made.layout.seen("cam", (u, v), "follower")[:, 1].max() for u, v in cam.outline[::10])
    assert deepest < 0.01
    assert all(y == pytest.approx(cam.clear + 6.0) for _, y in cam.shoe())


def test_parts_on_ground_and_undercut_cams_are_refused() -> None:
    m = Mechanism("turned")
    frame, wheel = m.body("frame"), m.body("wheel")
    m.revolute("O", m.ground.at(0, 0), frame.origin)
    m.revolute("W", frame.at(0.1, 0), wheel.origin)
    m.geneva("index", m.ground.origin, wheel.origin, 4, 0.1 * math.sin(math.pi / 4))
    m.drive_angle("motor", frame, constant_rate(1.0, math.pi))
    m.start_near(frame=180, wheel=5)
    with pytest.raises(UserError, match="joint 'index' is a geneva with a part on ground"):
        _ = _planned(m, 1.0).levels


# Discs of cams with any closed outline, and what the CAD kernel cannot make of automatic parts.


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
