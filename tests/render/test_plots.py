"""Plots: drawn from data.json alone, written once, the same bytes each time; which there are."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from PIL import Image

from render import plots
from shared.contract import Motion
from shared.contract.skeleton import read_skeleton, write_skeleton
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.render.plotted import MOTION, NAMES, figure, overlaps, shown, write
from tools.models.motions import plain_skeleton


@pytest.fixture
def out(out_root: Path) -> Out:
    out = Out("four_bar")
    write(out, MOTION)
    return out


def test_all_plots_are_written_once(out: Out, capsys: pytest.CaptureFixture[str]) -> None:
    plots.run("four-bar")
    assert sorted(path.stem for path in out.plots.glob("*")) == NAMES
    assert all(Image.open(path).size == (1600, 1000) for path in out.plots.glob("*.png"))
    before = {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in out.plots.iterdir()}
    capsys.readouterr()
    plots.run("four_bar")
    assert capsys.readouterr().out == "plots: four_bar: nothing to do\n"
    assert before == {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in out.plots.iterdir()}
    (out.plots / "path.png").write_bytes(b"")
    (out.plots / "point-Q.png").write_bytes(b"of a point that is no more")
    plots.run("four_bar")
    assert {path: path.read_bytes() for path in out.plots.iterdir()} == {
        p: content for p, (_, content) in before.items()
    }
    assert all(b"Software" not in content and b"tIME" not in content for _, content in before.values())


def test_without_a_motion_the_stage_says_what_to_make(out_root: Path) -> None:
    with pytest.raises(UserError, match=r"data\.json does not exist"):
        plots.run("four_bar")


def test_a_skeleton_of_another_motion_is_refused(out: Out) -> None:
    other = msgspec.structs.replace(MOTION.provenance, inputs="1" * 64)
    write_skeleton(out.skeleton, msgspec.structs.replace(plain_skeleton(MOTION), provenance=other))
    with pytest.raises(
        UserError, match=r"skeleton\.json is of another motion than data\.json; run make solve-four-bar"
    ):
        plots.run("four_bar")
    out.skeleton.write_text(out.skeleton.read_text().replace('"points": [', '"points": [0.0, ', 1))
    with pytest.raises(UserError, match=r"poses\[0\]\.strokes\[0\]\.points has 5 numbers; x and y in turn"):
        read_skeleton(out.skeleton)


def with_slider_and_torque() -> Motion:
    """The four-bar with a body that only slides, a joint that carries torque and a driver that pushes."""
    count = len(MOTION.time)
    body = msgspec.structs.replace(
        MOTION.bodies["rocker"], theta=[0.0] * count, omega=[0.0] * count, alpha=[0.0] * count
    )
    guide = msgspec.structs.replace(
        MOTION.joints["C"],
        kind="prismatic",
        bodies=("ground", "slider"),
        torque=[0.1 * x for x in MOTION.joints["C"].fx],
    )
    pusher = msgspec.structs.replace(MOTION.drivers["motor"], kind="distance", unit="m", effort_unit="N")
    return msgspec.structs.replace(
        MOTION,
        bodies={**MOTION.bodies, "slider": body},
        joints={**MOTION.joints, "guide": guide},
        drivers={**MOTION.drivers, "pusher": pusher},
        points={},
    )


def test_a_slider_a_joint_torque_and_a_pusher_get_their_plots(out: Out) -> None:
    motion = with_slider_and_torque()
    write(out, motion)
    plots.run("four_bar")
    assert (out.plots / "slider-slider.png").is_file()
    assert not list(out.plots.glob("point-*"))
    labels = [axes.get_ylabel().replace("\n", " ") for axes in figure("reactions", motion).axes]
    assert labels == ["reaction force / N", "reaction torque / (mN m)", "driver torque / (mN m)", "driver force / mN"]
    assert all(overlaps(figure(plot, motion)) == [] for plot in ("path", "reactions", "bodies", "hodographs"))


def test_joints_in_one_place_share_a_label_and_sliders_have_no_angle() -> None:
    motion = with_slider_and_torque()
    assert {"C, guide", "slider"} <= shown(figure("path", motion))
    assert "slider" not in shown(figure("bodies", motion))


def test_a_motion_without_drivers_or_joints_is_drawn() -> None:
    motion = msgspec.structs.replace(MOTION, drivers={}, joints={}, points={}, period=None)
    assert plots.plots_of(motion) == ["path", "bodies", "energy"]
    for plot in plots.plots_of(motion):
        shown(figure(plot, motion))
