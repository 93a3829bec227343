"""Plots: drawn from data.json alone, written once, equal bytes each time; no label covers another."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from PIL import Image

from render import plots
from render.plots.style import Labels, spread
from shared.contract import EventMark, Motion
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
    assert labels == ["reaction force / N", "reaction torque / (mN·m)", "driver torque / (mN·m)", "driver force / mN"]
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


@pytest.mark.parametrize("plot", NAMES)
def test_no_label_covers_another(plot: str) -> None:
    assert overlaps(figure(plot, MOTION)) == []


def test_many_bodies_and_joints_stay_readable() -> None:
    bodies = {f"link_{i:02d}": MOTION.bodies["rocker"] for i in range(40)}
    pins = {f"J{i:02d}": ("ground", name) for i, name in enumerate(bodies)}
    joints = {name: msgspec.structs.replace(MOTION.joints["A"], bodies=pair, shape=None) for name, pair in pins.items()}
    motion = msgspec.structs.replace(MOTION, bodies=bodies, joints=joints, drivers={}, points={})
    assert overlaps(figure("bodies", motion)) == []
    assert overlaps(figure("reactions", motion)) == []
    assert len([axes for axes in figure("hodographs", motion).axes if axes.get_visible()]) == 12


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 6, 8, 9, 12])
@pytest.mark.parametrize("name", ["J", "pin_of_the_combination_lever_"])
def test_words_of_a_hodograph_stay_clear_of_the_others(count: int, name: str) -> None:
    motion = msgspec.structs.replace(MOTION, joints={f"{name}{i}": MOTION.joints["A"] for i in range(count)})
    drawn = figure("hodographs", motion)
    assert overlaps(drawn) == []
    for axes in drawn.axes:
        label = axes.yaxis.label.get_window_extent()
        assert not any(label.overlaps(other.get_window_extent()) for other in drawn.axes if other.get_visible())


def test_words_of_neighbouring_marks_do_not_meet() -> None:
    times = np.linspace(0.0, MOTION.time[-1], 9)
    events = [
        EventMark(time=float(t), energy=0.0, name=f"combination_lever_{k}", what="closes") for k, t in enumerate(times)
    ]
    drawn = figure("bodies", msgspec.structs.replace(MOTION, events=events))
    assert overlaps(drawn) == []
    words = [text for text in drawn.axes[0].texts if "combination lever" in text.get_text()]
    assert len(words) > 1
    frame = drawn.axes[0].get_window_extent()
    assert all(
        frame.x0 - 2 <= text.get_window_extent().x0 and text.get_window_extent().x1 <= frame.x1 + 2 for text in words
    )


def test_long_names_stay_on_the_page() -> None:
    names = ("a", "coupler_of_the_first_loop", "crank_of_the_engine")
    bodies = MOTION.bodies | dict.fromkeys(names, MOTION.bodies["rocker"])
    motion = msgspec.structs.replace(MOTION, bodies=bodies)
    drawn = figure("bodies", motion)
    drawn.canvas.draw()
    boxes = [text.get_window_extent() for axes in drawn.axes for text in axes.texts if text.get_text() in names]
    assert len(boxes) == 3 * len(names)
    assert max(box.x1 for box in boxes) < drawn.bbox.x1


def test_names_of_a_machine_that_throws_far_stand_apart() -> None:
    """Ten names at points that are one pixel apart, in a plane as wide as the flight of what is thrown."""
    axes = Figure(figsize=(16, 10), dpi=100).add_axes((0.1, 0.1, 0.8, 0.8))
    axes.plot([0.0, 200.0], [0.0, 100.0])
    labels = Labels(axes)
    for k in range(10):
        labels.add(f"combination_lever_{k}", (20.0 + 0.1 * k, 40.0), "black")
    labels.write()
    assert len(axes.texts) == 10
    assert overlaps(axes.get_figure()) == []


@given(st.lists(st.floats(0, 300), min_size=1, max_size=12), st.floats(5, 20))
def test_labels_are_spread_apart_in_their_order(wishes: list[float], gap: float) -> None:
    placed = spread(np.array(wishes), gap, 300.0)
    order = np.argsort(wishes, kind="stable")
    assert all(b - a >= min(gap, 300 / max(len(wishes) - 1, 1)) - 1e-6 for a, b in pairwise(placed[order]))
    assert placed.min() >= -1e-6
    assert placed.max() <= 300 + 1e-6
    if len(wishes) == 1:
        assert placed[0] == wishes[0]
