"""Drawings: every kind has its mark in the right place, names do not cover each other, equal models equal bytes."""

from __future__ import annotations

import itertools
import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from mbsd import Mechanism, ModelError, constant_rate, tolerances
from mbsd.drawing import look
from mbsd.drawing.canvas import Canvas
from mbsd.drawing.pose import pose_of, start_pose
from mbsd.drawing.skeleton import draw_on, measure
from mbsd.drawing.strokes import ROLES, Recorder, moved, strokes_of
from mbsd.drawing.symbols.geometry import free_side, hull, rounded
from mbsd.drawing.symbols.wheels import draw_gear_pair
from mbsd.measures import largest
from mbsd.model.force import ForceKind
from mbsd.model.joint import JointKind
from mbsd.testing import force_kinds, joint_kinds
from mbsd.testing.forces import example as force_example
from shared.stage.paths import ROOT
from tests.kinematics.test_mobility import four_bar, parallelogram
from tools.models import four_bars, linkages


def slider_crank() -> Mechanism:
    law = constant_rate(10.0, math.radians(50))
    m = linkages.slider_crank(0.05, 0.15, 0.0, masses=(0.2, 0.3, 0.5), law=law, start=(50, -15))
    m.trace("P", m.bodies["rod"].at(0.075, 0.02))
    return m


def words(ax: Axes) -> dict[str, tuple[float, float, float, float]]:
    """Names in the drawing and their boxes (pixels)."""
    return {t.get_text(): t.get_window_extent().extents for t in ax.texts}


@pytest.mark.parametrize("build", [four_bar, parallelogram, slider_crank], ids=lambda build: build.__name__)
def test_every_name_is_there_and_none_covers_another(build) -> None:
    m = build()
    labels = words(m.draw().ax)
    shown = {name for text in labels for name in text.split(", ")}
    assert shown == {*m.bodies, *m.joints, *m.drivers, *m.traces} - {"ground"}
    for a, b in itertools.combinations(labels.values(), 2):
        assert a[2] < b[0] or b[2] < a[0] or a[3] < b[1] or b[3] < a[1]


def test_pins_stand_where_the_joints_are() -> None:
    m = slider_crank()
    sol = m.sweep(steps=24)
    ax = sol.draw(step=7).ax
    centres = [
        np.asarray(patch.get_path().vertices)[:-1].mean(axis=0) for patch in ax.patches if patch.get_zorder() == 8
    ]
    for name in ("O", "A", "B"):
        view = sol.joint(name)
        nearest = min(np.hypot(*(c - [view.x[7], view.y[7]])) for c in centres)
        assert nearest < 1e-9
    trails = [np.asarray(line.get_path().vertices) for line in ax.lines if line.get_zorder() == 1]
    (trail,) = (path for path in trails if len(path) == 25)
    np.testing.assert_allclose(trail[:, 1], sol.point("P").y)


@pytest.mark.parametrize("build", [four_bar, slider_crank], ids=lambda build: build.__name__)
def test_strokes_are_what_is_drawn(build) -> None:
    """Every line and outline of the matplotlib drawing, with its width and order, and every name."""
    sol = build().sweep(steps=24)
    ax = sol.draw(step=7).ax
    (first,) = strokes_of(sol, [7])
    polylines = [np.asarray(line.get_path().vertices) for line in ax.lines if line.get_zorder() != 1]
    looks = [(line.get_linewidth(), line.get_zorder()) for line in ax.lines if line.get_zorder() != 1]
    mine = [stroke for stroke in first.strokes if not stroke.closed]
    assert len(mine) == len(polylines) > 10
    for stroke, points, look_of in zip(mine, polylines, looks, strict=True):
        np.testing.assert_array_equal(stroke.points, points)
        assert (stroke.width, stroke.order) == look_of
    outlines = [stroke for stroke in first.strokes if stroke.closed]
    for stroke, patch in zip(outlines, ax.patches, strict=True):
        np.testing.assert_array_equal(stroke.points, np.asarray(patch.get_path().vertices)[: len(stroke.points)])
    assert {text for label in first.labels for text in label.text.split(", ")} == {
        name for text in words(ax) for name in text.split(", ")
    }
    known = {*ROLES.values(), *(f"body:{name}" for name in sol.mechanism.bodies)}
    assert {stroke.ink for stroke in first.strokes} | {label.colour for label in first.labels} <= known
    first, other = strokes_of(sol, [7, 12])
    assert first.unit == other.unit  # symbols of one size, so that poses can be compared
    elsewhere = moved(first, other)
    assert 0 < len(elsewhere) < len(other.strokes)  # what stands on the ground stays
    assert moved(first, first) == []


@pytest.mark.parametrize("kind", joint_kinds(), ids=lambda kind: kind.name)
def test_every_kind_has_strokes_on_a_canvas_without_matplotlib(kind: JointKind) -> None:
    m = Mechanism("example")
    first = m.body("first", 1.0, (0.4, 0.1), 0.3)
    kind.example(m, first.at(0.11, 0.2, 0.3), m.body("second", 1.5, (0.3, 0.0), 0.2).at(-0.4, 0.5, -0.6))
    pose = start_pose(m)
    recorder = Recorder(None, measure(m, pose)[2])
    draw_on(recorder, m, pose, {name: f"body:{name}" for name in m.bodies if name != "ground"}, frames=False)
    assert recorder.strokes
    assert all(np.isfinite(stroke.points).all() and len(stroke.points) > 1 for stroke in recorder.strokes)


def test_the_start_is_that_of_the_solution() -> None:
    m = slider_crank()
    start, first = start_pose(m), pose_of(m.sweep(steps=4), None, None)
    for name, frame in start.frames.items():
        np.testing.assert_allclose(frame, first.frames[name], atol=1e-12)


def test_a_time_or_a_step_not_both_and_within_the_solution() -> None:
    sol = slider_crank().sweep(duration=0.2, steps=10)
    assert pose_of(sol, 0.1004, None).title == pose_of(sol, None, 5).title == "t = 0.1 s"
    assert pose_of(sol, None, -1).title == "t = 0.2 s"
    for arguments, says in (
        ((0.1, 5), "not both"),
        ((0.3, None), "t = 0.3 s is outside of the solution, 0 .. 0.2 s"),
        ((math.nan, None), "is nan"),
        ((None, 11), "steps 0 .. 10"),
        ((None, 1.5), "step is 1.5"),
    ):
        with pytest.raises(ModelError, match=says):
            sol.draw(*arguments)


@pytest.mark.parametrize("to_ground", [False, True], ids=["two_bodies", "to_ground"])
@pytest.mark.parametrize("kind", joint_kinds(), ids=lambda kind: kind.name)
def test_every_kind_can_be_drawn(kind: JointKind, to_ground: bool) -> None:
    m = Mechanism("example")
    first = m.ground if to_ground else m.body("first", 1.0, (0.4, 0.1), 0.3)
    kind.example(m, first.at(0.11, 0.2, 0.3), m.body("second", 1.5, (0.3, 0.0), 0.2).at(-0.4, 0.5, -0.6))
    picture = m.draw()
    assert "example" in words(picture.ax)
    assert picture.ax.get_aspect() == 1.0
    assert "example" in {element.text for element in ET.fromstring(m.topology().text).iter()}


@pytest.mark.parametrize("to_ground", [False, True], ids=["two_bodies", "to_ground"])
@pytest.mark.parametrize("kind", force_kinds(), ids=lambda kind: kind.name)
def test_every_kind_of_force_can_be_drawn(kind: ForceKind, to_ground: bool) -> None:
    m, _ = force_example(kind, 1, to_ground)
    ax = m.draw().ax
    assert "example" in words(ax)
    assert any(line.get_color() == look.LOAD for line in ax.lines) or any(
        to_hex(patch.get_edgecolor()) == look.LOAD for patch in ax.patches
    )
    assert "example" in {element.text for element in ET.fromstring(m.topology().text).iter()}


@settings(max_examples=25)
@given(
    teeth=st.tuples(st.integers(12, 30), st.integers(12, 30), st.integers(40, 70)),
    turned=st.floats(-3.0, 3.0),
)
def test_gears_that_touch_show_a_tooth_at_a_gap(teeth: tuple[int, int, int], turned: float) -> None:
    sun, planet, _ = (0.01 * n for n in teeth)
    ring = sun + 2 * planet
    m = Mechanism("train")
    bodies = {name: m.body(name) for name in ("sun", "planet", "ring")}
    place = (sun + planet) * np.array([math.cos(turned), math.sin(turned)])
    m.revolute("A", m.ground.origin, bodies["sun"].origin)
    m.revolute("B", m.ground.at(*place), bodies["planet"].origin)
    m.revolute("C", m.ground.origin, bodies["ring"].origin)
    m.gear_pair("inner", bodies["sun"].origin, bodies["planet"].origin, sun, planet)
    m.gear_pair("outer", bodies["ring"].origin, bodies["planet"].origin, ring, planet, internal=True)
    colours = dict.fromkeys(m.bodies, "#000000")
    canvas = Canvas(Figure().subplots(), 0.02)
    for joint in (m.joints["inner"], m.joints["outer"]):
        draw_gear_pair(canvas, joint, start_pose(m), colours)

    def out(name: str, radius: float, direction: float) -> float:
        """1 at a tooth of a gear's outside, -1 at a gap."""
        count, phase = canvas.wheels[name, radius]
        return math.cos(count * direction - phase)

    line = math.atan2(place[1], place[0])
    assert out("sun", sun, line) == pytest.approx(-out("planet", planet, line + math.pi), abs=1e-6)
    # the ring's teeth point inwards: its outward profile is the negative
    assert -out("ring", ring, line) == pytest.approx(out("planet", planet, line), abs=1e-6)


def test_links_that_do_not_close_are_shown_open() -> None:
    m = four_bar(rocker=0.01)
    picture = m.draw()
    assert picture.ax.get_title(loc="left") == "four bar,  the joints in red do not close"
    assert any(line.get_color() == "#c81e1e" for line in picture.ax.lines)
    assert "do not close" in m.topology().text


def test_a_notebook_shows_it_and_files_have_equal_bytes(tmp_path: Path) -> None:
    pictures = [four_bar().draw() for _ in range(2)]
    assert (pictures[0]._repr_png_() or b"").startswith(b"\x89PNG")
    assert "<svg" in (pictures[0]._repr_svg_() or "")
    for suffix in ("png", "svg", "pdf"):
        for k, picture in enumerate(pictures):
            picture.save(tmp_path / f"{k}.{suffix}")
        assert (tmp_path / f"0.{suffix}").read_bytes() == (tmp_path / f"1.{suffix}").read_bytes()
    with pytest.raises(ModelError, match="saved as png, svg, pdf"):
        pictures[0].save(tmp_path / "x.jpg")
    with pytest.raises(ModelError, match=r"end the path with \.svg"):
        four_bar().topology().save(tmp_path / "x.png")
    four_bar().topology().save(tmp_path / "x.svg")
    assert (tmp_path / "x.svg").read_text() == four_bar().topology().text


def test_names_with_dollar_signs_are_no_formulas(tmp_path: Path) -> None:
    m = Mechanism("$m_{$")
    first, second = m.bar("$x_{$", 0.04), m.bar("b$y^{}}$", 0.12)
    m.revolute("$A_{$", m.ground.at(0, 0), first.start)
    m.revolute("$B", first.end, second.start)
    picture = m.draw()
    written = {text.get_text() for text in picture.ax.texts}
    assert {"$x_{$", "b$y^{}}$", "$A_{$"} <= written
    picture.save(tmp_path / "drawn.svg")
    sizes = {"$x_{$": 1e-4, "b$y^{}}$": 1e-4}
    m.drive_angle("one", first, constant_rate(1.0))
    m.drive_angle("two", second, constant_rate(1.0))
    tolerances(m, sizes, largest("b$y^{}}$.x"), n=20, steps=4).plot().save(tmp_path / "strays.svg")
    assert rcParams["text.parse_math"]


def test_axes_of_the_user_are_used_and_shown_by_the_user() -> None:
    left, right = Figure().subplots(1, 2)
    picture = four_bar().draw(ax=left)
    assert picture.ax is left
    assert picture._repr_png_() is None
    assert picture._repr_svg_() is None
    assert len(left.patches) > 10
    assert not right.patches


@given(points=st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=1, max_size=8))
def test_an_outline_keeps_its_distance_from_every_point(points: list[tuple[float, float]]) -> None:
    places = np.round(np.array(points), 3)
    outline = rounded(places, 0.5)
    assert np.hypot(*(outline[:, None] - places).transpose(2, 0, 1)).min() >= 0.5 - 1e-9
    corners = hull(places)
    reach = np.hypot(*(outline[:, None] - corners).transpose(2, 0, 1)).min(axis=1)
    assert reach.max() <= 0.5 + 1e-9  # arcs end on the corners; straight parts run between them


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_an_outline_goes_once_around_points_on_a_line(size: float) -> None:
    rng = np.random.default_rng(1)
    for _ in range(500):  # rounding lifts a point off the line in some places only
        angle, parts = rng.uniform(0, 2 * math.pi), np.append([0.0, 1.0], rng.uniform(0, 1, 3))
        places = parts[:, None] * [math.cos(angle), math.sin(angle)] + rng.uniform(-1, 1, 2)
        outline = rounded(size * places, size)
        length = np.hypot(*(np.roll(outline, -1, axis=0) - outline).T).sum()
        assert length == pytest.approx((2 + 2 * math.pi) * size, rel=0.01)


@pytest.mark.parametrize(
    ("directions", "side"),
    [
        ([], (0, -1)),
        ([0.0], (0, -1)),
        ([-1.5], (0, 1)),
        ([-1.5, 1.5], (-1, 0)),
        ([-1.2, 1.2, 3.1], (1, 0)),
    ],
)
def test_ground_is_below_unless_a_link_is_there(directions: list[float], side: tuple[int, int]) -> None:
    np.testing.assert_array_equal(free_side(directions), side)


def test_an_empty_model_is_ground_alone() -> None:
    m = Mechanism("empty")
    assert "ground" in m.topology().text
    assert m.draw().ax.get_title(loc="left") == "empty"


def test_the_driven_random_four_bar_is_drawn_closed() -> None:
    picture = four_bars.model((4.0, 1.0, 3.5, 3.0)).draw(frames=False, names=False)
    assert not picture.ax.texts
    assert picture.ax.get_title(loc="left") == "random"


def test_the_diagrams_of_the_documents_are_those_of_their_code() -> None:
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / "docs" / "model.md").read_text(), re.MULTILINE | re.DOTALL)
    made: dict[str, Any] = {}
    wanted = next(k for k, block in enumerate(blocks) if "wide.topology()" in block)
    exec("\n".join(blocks[: wanted + 1]), made)
    for model, name in ((made["m"].draw()._repr_svg_(), "drawing"), (made["wide"].topology().text, "topology")):
        file = ROOT / "docs" / f"model_{name}.svg"
        assert file.stat().st_size < 300_000
        assert _marks(model) == _marks(file.read_text())


def _marks(svg: str) -> list[str]:
    """Return the texts of a diagram and its number of shapes; places may differ in the last digit."""
    elements = list(ET.fromstring(svg).iter())
    return sorted(e.text for e in elements if e.tag.endswith("text") and e.text) + [e.tag for e in elements]
