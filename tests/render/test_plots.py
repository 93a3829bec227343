"""Plots: drawn from data.json alone, the same bytes each time, and showing the numbers they were given."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from render import plots
from render.plots import figures
from render.plots.horizon import horizon
from render.plots.pages.energy import powers, statement
from render.plots.style import colour, spread
from shared.contract import Motion, write_motion
from shared.contract.skeleton import read_skeleton, write_skeleton
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.models.motions import bouncing_ball, four_bar_motion, plain_skeleton

MOTION = four_bar_motion(steps=72)
NAMES = ["bodies", "energy", "hodographs", "path", "point-P", "reactions"]


def figure(plot: str, motion: Motion) -> Figure:
    return figures.figure(plot, motion, plain_skeleton(motion))


def write(out: Out, motion: Motion) -> None:
    write_motion(out.motion, motion)
    write_skeleton(out.skeleton, plain_skeleton(motion))


@pytest.fixture
def out(out_root: Path) -> Out:
    out = Out("four_bar")
    write(out, MOTION)
    return out


def shown(drawn: Figure) -> set[str]:
    """Every text on the page."""
    drawn.canvas.draw()
    return {text.get_text() for text in drawn.findobj(Text) if isinstance(text, Text)}


def overlaps(drawn: Figure) -> list[tuple[str, str]]:
    """Pairs of labels that cover each other."""
    drawn.canvas.draw()
    texts = [t for axes in drawn.axes for t in axes.texts if t.get_text()]
    boxes = [(t.get_text(), t.get_window_extent()) for t in texts]
    return [(a, b) for i, (a, box) in enumerate(boxes) for b, other in boxes[i + 1 :] if box.overlaps(other)]


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


@pytest.mark.parametrize("plot", NAMES)
def test_no_label_covers_another(plot: str) -> None:
    assert overlaps(figure(plot, MOTION)) == []


@pytest.mark.parametrize("plot", [name for name in NAMES if name not in ("path",)])
def test_axes_carry_units(plot: str) -> None:
    drawn = figure(plot, MOTION)
    labels = [axes.get_ylabel() for axes in drawn.axes] + [drawn.axes[-1].get_xlabel()]
    assert all("(" in label and label.endswith(")") for label in labels), labels


def test_lines_hold_the_numbers_of_the_motion() -> None:
    angle, speed, acceleration = figure("bodies", MOTION).axes
    rocker = MOTION.bodies["rocker"]
    for axes, series in ((angle, np.degrees(rocker.theta)), (speed, rocker.omega), (acceleration, rocker.alpha)):
        (line,) = [line for line in axes.lines if line.get_label() == "rocker"]
        np.testing.assert_array_equal(line.get_ydata(), series)
        np.testing.assert_allclose(np.asarray(line.get_xdata()), np.linspace(0, 360, 73), atol=1e-9)
    force, torque = figure("reactions", MOTION).axes
    (line,) = [line for line in force.lines if line.get_label() == "C"]
    np.testing.assert_array_equal(line.get_ydata(), np.hypot(MOTION.joints["C"].fx, MOTION.joints["C"].fy))
    (line,) = [line for line in torque.lines if line.get_label() == "motor"]
    np.testing.assert_array_equal(line.get_ydata(), MOTION.drivers["motor"].effort)


def test_the_path_shows_joints_points_and_bodies() -> None:
    assert {"A", "B", "C", "D", "P", "crank", "coupler", "rocker", "Four-bar: path"} <= shown(figure("path", MOTION))


def test_the_axis_is_the_angle_of_one_forward_driver_else_time() -> None:
    assert horizon(MOTION).label == "motor angle (deg; a turn takes 1 s)"
    motor = MOTION.drivers["motor"]
    swinging = msgspec.structs.replace(motor, value=list(np.sin(np.multiply(6, MOTION.time))))
    pushing = msgspec.structs.replace(motor, kind="coordinate")
    for drivers in ({"motor": swinging}, {"motor": pushing}, {"motor": motor, "second": motor}, {}):
        other = msgspec.structs.replace(MOTION, drivers=drivers)
        assert horizon(other).label == "time (s)"
        np.testing.assert_array_equal(horizon(other).values, MOTION.time)


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
    pusher = msgspec.structs.replace(MOTION.drivers["motor"], kind="distance")
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
    labels = [axes.get_ylabel() for axes in figure("reactions", motion).axes]
    assert labels == ["reaction force (N)", "reaction torque (N m)", "driver torque (N m)", "driver force (N)"]
    assert all(overlaps(figure(plot, motion)) == [] for plot in ("path", "reactions", "bodies", "hodographs"))


def test_joints_in_one_place_share_a_label_and_sliders_have_no_angle() -> None:
    motion = with_slider_and_torque()
    assert {"C, guide", "slider"} <= shown(figure("path", motion))
    assert "slider" not in shown(figure("bodies", motion))


def test_along_one_axis_there_is_one_line() -> None:
    count = len(MOTION.time)
    still = msgspec.structs.replace(MOTION.points["P"], y=[0.02] * count, vy=[0.0] * count, ay=[0.0] * count)
    motion = msgspec.structs.replace(MOTION, points={"P": still})
    assert {"x", "vx", "ax"} <= shown(figure("point-P", motion))
    assert not {"y", "vy", "ay", "|v|", "|a|"} & shown(figure("point-P", motion))


def test_many_bodies_and_joints_stay_readable() -> None:
    bodies = {f"link_{i:02d}": MOTION.bodies["rocker"] for i in range(40)}
    joints = {f"J{i:02d}": MOTION.joints["A"] for i in range(40)}
    motion = msgspec.structs.replace(MOTION, bodies=bodies, joints=joints)
    assert overlaps(figure("bodies", motion)) == []
    assert overlaps(figure("reactions", motion)) == []
    assert len([axes for axes in figure("hodographs", motion).axes if axes.get_visible()]) == 12


def test_long_names_stay_on_the_page() -> None:
    names = ("a", "coupler_of_the_first_loop", "crank_of_the_engine")
    motion = msgspec.structs.replace(MOTION, bodies=dict.fromkeys(names, MOTION.bodies["rocker"]))
    drawn = figure("bodies", motion)
    drawn.canvas.draw()
    boxes = [text.get_window_extent() for axes in drawn.axes for text in axes.texts if text.get_text() in names]
    assert len(boxes) == 3 * len(names)
    assert max(box.x1 for box in boxes) < drawn.bbox.x1


def test_a_motion_without_drivers_or_joints_is_drawn() -> None:
    motion = msgspec.structs.replace(MOTION, drivers={}, joints={}, points={}, period=None)
    assert plots.plots_of(motion) == ["path", "bodies", "energy"]
    for plot in plots.plots_of(motion):
        shown(figure(plot, motion))


@given(st.lists(st.floats(0, 300), min_size=1, max_size=12), st.floats(5, 20))
def test_labels_are_spread_apart_in_their_order(wishes: list[float], gap: float) -> None:
    placed = spread(np.array(wishes), gap, 300.0)
    order = np.argsort(wishes, kind="stable")
    assert all(b - a >= min(gap, 300 / max(len(wishes) - 1, 1)) - 1e-6 for a, b in pairwise(placed[order]))
    assert placed.min() >= -1e-6
    assert placed.max() <= 300 + 1e-6
    if len(wishes) == 1:
        assert placed[0] == wishes[0]


def test_an_impact_is_marked_in_joules_and_is_no_power() -> None:
    ball = bouncing_ball()
    given, rate = powers(ball)
    assert np.abs(given).max() == np.abs(rate).max() == 0.0  # a gradient over the samples would show tens of watts
    assert (
        statement(ball) == "nothing gives or takes power: the energy stays, but for an impact that takes 1.47 J at once"
    )
    drawn = figure("energy", ball)
    assert "\N{MINUS SIGN}1.47 J" in shown(drawn)
    assert overlaps(drawn) == []
    for plot in plots.plots_of(ball):
        figure(plot, ball).canvas.draw()


def test_the_balance_is_said_as_it_is() -> None:
    assert statement(MOTION) == "the drivers' power is the rate of the energy"
    dragged = msgspec.structs.replace(
        MOTION.drivers["motor"], power=[power + 0.3 for power in MOTION.drivers["motor"].power]
    )
    motion = msgspec.structs.replace(MOTION, drivers={"motor": dragged})
    assert "drivers and other forces (friction, dampers, loads; up to 0.3 W) is the rate" in statement(motion)
    (line,) = [line for line in figure("energy", motion).axes[1].lines if line.get_label() == "other forces"]
    np.testing.assert_allclose(line.get_ydata(), -0.3, atol=1e-9)
    assert not [line for line in figure("energy", MOTION).axes[1].lines if line.get_label() == "other forces"]


def test_elastic_energy_counts_but_not_across_an_event() -> None:
    ball = bouncing_ball()
    stored = np.where(np.arange(len(ball.time)) < ball.time.index(ball.events[0].time) + 1, 0.0, 0.5)
    elastic = msgspec.structs.replace(ball.energy, potential=list(np.add(ball.energy.potential, stored)))
    _, rate = powers(msgspec.structs.replace(ball, energy=elastic))
    assert np.abs(rate).max() < 1e-9
    ramp = msgspec.structs.replace(
        ball.energy, potential=list(np.add(ball.energy.potential, np.multiply(3, ball.time)))
    )
    _, rate = powers(msgspec.structs.replace(ball, energy=ramp))
    np.testing.assert_allclose(rate, 3.0, rtol=1e-9)


def test_rounding_is_drawn_as_a_flat_line() -> None:
    """A balanced wheel at constant speed: energy, torque and reactions are constant but for the last digit."""
    random = np.random.default_rng(1)
    count = len(MOTION.time)

    def noise(size: float, value: float = 0.0) -> list[float]:
        return list(value + size * random.normal(size=count))

    crank = msgspec.structs.replace(MOTION.bodies["crank"], com=(0.0, 0.0), alpha=noise(1e-14))
    joint = msgspec.structs.replace(MOTION.joints["A"], fx=noise(1e-16), fy=noise(1e-15, 0.49), torque=noise(1e-17))
    motor = msgspec.structs.replace(MOTION.drivers["motor"], effort=noise(1e-17), power=noise(1e-16))
    energy = msgspec.structs.replace(MOTION.energy, kinetic=noise(1e-17, 0.02), potential=noise(1e-17))
    motion = msgspec.structs.replace(
        MOTION, bodies={"crank": crank}, joints={"A": joint}, drivers={"motor": motor}, energy=energy, points={}
    )
    for plot in ("energy", "bodies", "reactions"):
        for axes in figure(plot, motion).axes:
            low, high = axes.get_ylim()
            assert high - low > 1e-3, (plot, axes.get_ylabel())
            for line in axes.lines:
                values = np.asarray(line.get_ydata())
                if "angle (deg)" not in axes.get_ylabel() and len(values) == count:
                    assert np.ptp(values) == 0.0, (plot, line.get_label())
    assert [axes.get_ylabel() for axes in figure("reactions", motion).axes] == [
        "reaction force (N)",
        "driver torque (N m)",
    ]


def test_small_machines_are_not_taken_for_noise() -> None:
    """Energies of nanojoules are drawn as they are: what is noise follows from the motion's own size."""
    small = {
        "bodies": {
            name: msgspec.structs.replace(body, mass=1e-8 * body.mass, inertia=1e-8 * body.inertia)
            for name, body in MOTION.bodies.items()
        },
        "joints": {
            name: msgspec.structs.replace(
                joint, fx=list(np.multiply(1e-8, joint.fx)), fy=list(np.multiply(1e-8, joint.fy))
            )
            for name, joint in MOTION.joints.items()
        },
        "drivers": {
            "motor": msgspec.structs.replace(
                MOTION.drivers["motor"],
                effort=list(np.multiply(1e-8, MOTION.drivers["motor"].effort)),
                power=list(np.multiply(1e-8, MOTION.drivers["motor"].power)),
            )
        },
        "energy": msgspec.structs.replace(
            MOTION.energy,
            kinetic=list(np.multiply(1e-8, MOTION.energy.kinetic)),
            potential=list(np.multiply(1e-8, MOTION.energy.potential)),
        ),
    }
    motion = msgspec.structs.replace(MOTION, **small)
    for plot in ("energy", "reactions"):
        for axes, other in zip(figure(plot, motion).axes, figure(plot, MOTION).axes, strict=True):
            for line, same in zip(axes.lines, other.lines, strict=True):
                if len(np.asarray(line.get_ydata())) == len(MOTION.time):
                    np.testing.assert_allclose(1e8 * np.asarray(line.get_ydata()), same.get_ydata(), atol=1e-12)


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


def test_the_path_holds_every_stroke_in_its_bodys_colour() -> None:
    skeleton = plain_skeleton(MOTION)
    (axes,) = figure("path", MOTION).axes
    drawn = {tuple(np.ravel(line.get_xydata()).round(9)): line for line in axes.lines}
    for pose in skeleton.poses:
        for stroke in pose.strokes:
            closed = stroke.points + (stroke.points[:2] if stroke.closed else [])
            line = drawn[tuple(np.round(closed, 9))]
            assert line.get_color() == colour(list(MOTION.bodies).index(stroke.ink.removeprefix("body:")))
            assert (line.get_alpha() == 0.3) is (pose is not skeleton.poses[0])


def test_forces_and_contacts_have_a_page_of_their_own() -> None:
    from mbsd import Mechanism
    from mechanisms.stages.solve.motion_file import to_motion

    m = Mechanism("arm", gravity=(0.0, -9.81))
    arm = m.bar("arm", 0.3, mass=0.4)
    pin = m.revolute("A", m.ground.at(0, 0), arm.start)
    m.spring("spring", m.ground.at(0.2, 0.3), arm.end, stiffness=4.0, damping=0.3, free_length=0.15)
    m.torsion_spring("twist", m.ground, arm, stiffness=0.2)
    m.drag("air", arm.end, 0.05)
    m.stop("end", pin, lower=-0.5)
    m.start_near(arm=10)
    motion = to_motion(m.simulate(0.5, steps=60, event_rows=True), None, "", {}, {"arm": "mechanism"})
    assert "forces" in plots.plots_of(motion)
    assert "forces" not in plots.plots_of(MOTION)
    drawn = figure("forces", motion)
    lines = [{line.get_label(): line.get_ydata() for line in axes.lines} for axes in drawn.axes]
    assert [axes.get_ylabel() for axes in drawn.axes] == ["force (N)", "torque (N m)", "power (W)"]
    np.testing.assert_array_equal(lines[0]["spring"], motion.forces["spring"].effort)
    np.testing.assert_array_equal(lines[1]["twist"], motion.forces["twist"].effort)
    assert max(lines[1]["end lower"]) > 0.0
    assert {"spring", "twist", "air"} <= set(lines[2])
    assert overlaps(drawn) == []
