"""Animations: their pictures and times, files that players read, refusals."""

from __future__ import annotations

import math
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.drawing.animation import encoders
from mbsd.drawing.animation.arrows import Arrow
from mbsd.drawing.animation.clip import HOLD, at_times, clip_of
from mbsd.drawing.animation.page import BETWEEN, MARGIN, Page, legend_rows
from mbsd.drawing.animation.panel import LEGEND_ROW
from mbsd.drawing.animation.scene import Scene, scene_of
from mbsd.drawing.animation.words import EVERYTHING
from mbsd.drawing.look import PAPER
from mbsd.results.solution import Solution
from tools.models.contact_models import ball

SMALL = (320, 180)


def four_bar(mass: float = 0.1) -> Mechanism:
    m = Mechanism("four_bar")
    crank, coupler, rocker = m.bar("crank", 0.04, mass), m.bar("coupler", 0.12, mass), m.bar("rocker", 0.09, mass)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", rocker.start, m.ground.at(0.12, 0))  # ground is the second body
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.trace("P", coupler.at(0.06, 0.03))
    m.start_near(crank=0, coupler=45, rocker=100)
    return m


def scene(sol: Solution, rate: float | None = None, fps: float = 30.0) -> Scene:
    return scene_of(sol, clip_of(sol, rate, fps))


def listed(film: Path) -> list[list[str]]:
    """A line of ffmpeg's framecrc for each picture: stream, dts, pts, duration, size, checksum."""
    command = [encoders.ffmpeg(), "-v", "error", "-i", str(film), "-f", "framecrc", "-"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [line.split(",") for line in done.stdout.splitlines() if not line.startswith("#")]


# -- times -----------------------------------------------------------------------------------------------------------


def test_a_motion_that_repeats_has_no_doubled_picture() -> None:
    clip = clip_of(four_bar().sweep(), None, 30.0)
    assert clip.repeats
    assert (clip.rate, clip.words) == (1.0, "")
    assert np.allclose(clip.times, np.arange(30) / 30)


def test_a_motion_that_does_not_plays_to_its_end_and_holds() -> None:
    clip = clip_of(ball(0.5).simulate(3.0), None, 30.0)
    assert not clip.repeats
    assert np.allclose(np.diff(clip.times), 1 / 30)
    assert clip.times[-1] == pytest.approx(3.0)
    assert clip.seconds == pytest.approx(91 / 30 + HOLD)


@pytest.mark.parametrize(("duration", "rate", "words"), [(0.3, 0.2, "5 times slower"), (100.0, 5.0, "5 times faster")])
def test_a_round_part_of_real_time_is_chosen_and_told(duration: float, rate: float, words: str) -> None:
    m = ball(0.0)
    clip = clip_of(m.simulate(duration), None, 30.0)
    assert clip.rate == pytest.approx(rate)
    assert clip.words == words


def test_too_many_pictures_are_refused_with_the_remedy() -> None:
    with pytest.raises(ModelError, match="higher rate=, a lower fps="):
        clip_of(ball(0.0).simulate(10.0), 0.001, 30.0)


def test_a_sweep_between_its_outputs_is_the_sweep_at_those_times() -> None:
    m = four_bar()
    times = np.linspace(0.013, 0.977, 41)
    between, exact = at_times(m.sweep(), times), m.sweep(times=times)
    assert np.abs(between.q - exact.q).max() < 1e-9
    assert np.abs(between.v - exact.v).max() < 1e-7
    assert np.abs(between.a - exact.a).max() < 1e-3 * np.abs(exact.a).max()
    assert np.abs(between.wrench - exact.wrench).max() < 2e-3 * np.abs(exact.wrench).max()


# -- pictures --------------------------------------------------------------------------------------------------------


def test_pictures_show_the_machine_where_it_is_and_nothing_is_left_behind() -> None:
    sol = four_bar().sweep()
    page = Page(sol, scene(sol), (("velocities",),), SMALL, True)
    first, later = page.picture(0).copy(), page.picture(10).copy()
    assert first.shape == (180, 320, 4)
    assert (first != later).any(axis=-1).mean() > 0.01
    assert np.array_equal(page.picture(0), first)
    assert tuple(first[0, 0, :3]) == tuple(int(PAPER[k : k + 2], 16) for k in (1, 3, 5))


def test_without_masses_all_shows_what_there_is() -> None:
    sol = four_bar(0.0).sweep()
    page = Page(sol, scene(sol), EVERYTHING, SMALL, True)
    assert [panel.quantities for panel in page.panels] == [("velocities",), ("accelerations",)]
    alone = Page(sol, scene(sol), (("reactions",),), SMALL, True)
    assert alone.panels[0].is_empty
    alone.picture(3)


def test_arrows_stay_within_their_panel() -> None:
    sol = four_bar().sweep()
    page = Page(sol, scene(sol), EVERYTHING, (1280, 720), True)
    for panel in page.panels:
        left, low, right, top = panel.room
        for k in range(0, 30, 5):
            for mark in panel.marks:
                if isinstance(mark, Arrow):
                    tip = panel.brush.view.pixels(mark.place + panel._drawn(mark) * (0.5 if mark.middle else 1.0))[k]
                    assert left - 1 <= tip[0] <= right + 1
                    assert low - 1 <= tip[1] <= top + 1


@pytest.mark.parametrize(("size", "most"), [((640, 360), 2), ((1280, 720), 1)])
def test_legends_end_within_their_panel_and_below_the_machine(size: tuple[int, int], most: int) -> None:
    """Forces, torques, weights and reactions in half of a picture: they ran into the panel beside it."""
    model = four_bar()
    model.gravity = (0.0, -9.81)
    model.torsion_spring("spring", model.ground, model.bodies["rocker"], 5.0, damping=0.1)
    model.spring("coil", model.ground.at(0.0, 0.2), model.bodies["coupler"].at(0.06, 0.0), 20.0, 0.1)
    sol = model.sweep()
    page = Page(sol, scene(sol), EVERYTHING, size, True)
    assert len(page.panels) == 4
    longest = 0
    for panel in page.panels:
        px, rows = panel.dpi / 100, legend_rows(panel)
        longest = max(longest, len(rows))
        for row in rows:
            wide = sum(entry.width(px) for entry in row) + BETWEEN * px * (len(row) - 1)
            assert 2 * MARGIN * px + wide <= panel.box[2] + 1e-6
        assert panel.room[1] - panel.box[1] >= (19 + LEGEND_ROW * (len(rows) - 1)) * px
    assert longest == most


def test_a_legend_names_weights_alone_where_no_other_force_acts() -> None:
    model = four_bar()
    model.gravity = (0.0, -9.81)
    sol = model.sweep()
    page = Page(sol, scene(sol), (("forces", "reactions"),), (640, 360), True)
    texts = [entry.text for row in legend_rows(page.panels[0]) for entry in row]
    assert [text.split("  ")[-1] for text in texts if "  " in text] == ["weights", "reactions"]


# -- files -----------------------------------------------------------------------------------------------------------


def test_an_mp4_repeats_short_rounds_without_a_doubled_picture(tmp_path: Path) -> None:
    film = tmp_path / "film.mp4"
    seen: list[tuple[int, int]] = []
    made = (
        four_bar()
        .sweep()
        .animate(film, show="velocities", fps=20, size=SMALL, progress=lambda *counts: seen.append(counts))
    )
    assert (made.pictures, made.rate) == (20, 1.0)
    assert seen == [(k + 1, 20) for k in range(20)]
    rows = listed(film)
    assert len(rows) == 120  # six rounds of a second
    starts = [int(row[2]) for row in rows]
    assert len(set(np.diff(starts))) == 1
    sums = [row[5] for row in rows]
    assert sums[:20] == sums[20:40]
    assert len(set(sums[:20])) == 20
    assert list(tmp_path.iterdir()) == [film]


def test_an_mp4_of_a_simulation_holds_its_end(tmp_path: Path) -> None:
    film = tmp_path / "ball.mp4"
    ball(0.5).simulate(2.0).animate(film, show=(), fps=20, size=SMALL)
    assert len(listed(film)) == 41 + round(20 * HOLD)


def test_a_gif_plays_for_ever_at_real_time_with_the_same_bytes(tmp_path: Path) -> None:
    from PIL import Image

    sol = four_bar().sweep()
    first, second = tmp_path / "one.gif", tmp_path / "two.gif"
    made = sol.animate(first, size=SMALL)
    sol.animate(second, size=SMALL)
    assert first.read_bytes() == second.read_bytes()
    with Image.open(first) as picture:
        assert picture.size == SMALL
        assert picture.info["loop"] == 0
        corner = picture.convert("RGB").getpixel((0, 0))
        assert corner == tuple(int(PAPER[k : k + 2], 16) for k in (1, 3, 5))
        times = []
        for k in range(picture.n_frames):
            picture.seek(k)
            times.append(picture.info["duration"])
    assert len(times) == made.pictures
    assert sum(times) == pytest.approx(1000.0, abs=40)
    assert "data:image/gif" in str(made._repr_mimebundle_())


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"path": "film.avi"}, "ends with .avi; an animation is an .mp4 or a .gif"),
        ({"path": 3}, "path is 3"),
        ({"show": "velocity"}, "there is no quantity 'velocity', did you mean 'velocities'"),
        ({"show": ("reactions", 3)}, "there is no quantity 3"),
        ({"size": (321, 180)}, "two even whole numbers"),
        ({"size": "large"}, "size is 'large'"),
        ({"size": (90, 90)}, "120 .. 4096"),
        ({"rate": 0.0}, "rate is 0; it must be positive"),
        ({"rate": "slow"}, "rate is 'slow'"),
        ({"fps": 1000}, "fps is 1000"),
        ({"names": 1}, "names is 1; it must be True"),
    ],
)
def test_invalid_animations_are_refused(asked: dict[str, object], words: str, tmp_path: Path) -> None:
    sol = four_bar().sweep(steps=8)
    arguments = {"path": tmp_path / "film.mp4"} | asked
    with pytest.raises(ModelError, match=re.escape(words)):
        sol.animate(**arguments)


def test_a_single_time_is_no_motion(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="the solution has one time"):
        four_bar().sweep(times=[0.1]).animate(tmp_path / "film.gif")


def test_without_ffmpeg_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(encoders.shutil, "which", lambda name: None)
    with pytest.raises(ModelError, match=r"install mbsd\[animate\], or ffmpeg itself; a path that ends with .gif"):
        four_bar().sweep(steps=8).animate(tmp_path / "film.mp4")
    four_bar().sweep(steps=8).animate(tmp_path / "film.gif", show=(), size=SMALL)


def test_a_failure_leaves_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(encoders, "H264", ("-c:v", "no_such_codec"))
    with pytest.raises(ModelError, match="ffmpeg failed"):
        four_bar().sweep(steps=8).animate(tmp_path / "film.mp4", size=SMALL)
    with pytest.raises(ModelError, match="cannot write"):
        four_bar().sweep(steps=8).animate(tmp_path / "no" / "film.mp4", size=SMALL)
    assert list(tmp_path.iterdir()) == []


def test_a_chain_names_its_traced_end_alone_and_its_lines_are_thin() -> None:
    m = Mechanism("chain")
    before = m.ground.at(0, 0)
    for k in range(20):
        link = m.bar(f"link {k}", 0.05, 0.05)
        m.revolute(f"pin {k}", before, link.start)
        before = link.end
    m.trace("end", before)
    m.start_near(**{f"link {k}": 0 for k in range(20)})
    sol = m.simulate(0.2, steps=8)
    page = Page(sol, scene(sol), EVERYTHING, (640, 360), True)
    for panel in page.panels:
        assert len(panel.placed) == 1
        assert panel.brush.thin < 1.0
    page.picture(3)


def test_panels_of_one_scale_share_their_machine() -> None:
    sol = four_bar().sweep()
    page = Page(sol, scene(sol), (("velocities",), ("accelerations",)), SMALL, True)
    picture = page.picture(5).copy()
    alone = [panel.scene.drawn(panel.brush, 5, panel.colours) for panel in page.panels]
    assert alone[0] is alone[1]
    page.scene._drawn.clear()
    assert np.array_equal(page.picture(5), picture)
