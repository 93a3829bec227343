"""Pages of plots show the numbers they were given, with their units, over the axis that fits."""

from __future__ import annotations

import re

import msgspec
import numpy as np
import pytest

from render import plots
from render.plots.measures import horizon
from tests.render.plotted import MOTION, NAMES, figure, overlaps, shown
from tools.models.motions import plain_skeleton


@pytest.mark.parametrize("plot", [name for name in NAMES if name not in ("path",)])
def test_axes_carry_units(plot: str) -> None:
    drawn = figure(plot, MOTION)
    labels = [axes.get_ylabel().replace("\n", " ") for axes in drawn.axes] + [drawn.axes[-1].get_xlabel()]
    assert all(re.fullmatch(r"[^/]+ / ([^\s/()]+|\([^()]+\))(; a turn takes 1 s)?", label) for label in labels), labels


def test_near_a_singular_pose_an_axis_is_cut_and_says_so() -> None:
    """As a slider-crank driven by its slider at a dead point, where the torque goes to infinity."""
    motor, count = MOTION.drivers["motor"], len(MOTION.time)
    effort = np.sin(np.linspace(0, 2 * np.pi, count))
    effort[30] = 2e13
    near = np.where(np.arange(count) == 30, 1e-12, 0.4).tolist()
    high = {"motor": msgspec.structs.replace(motor, effort=effort.tolist())}
    for margin, cut in ((near, True), ([0.4] * count, False)):  # elsewhere a peak is part of the motion
        diagnostics = msgspec.structs.replace(MOTION.diagnostics, singularity_margin=margin)
        motion = msgspec.structs.replace(MOTION, drivers=high, diagnostics=diagnostics)
        drawn = figure("reactions", motion)
        said = "clipped: up to 20 TN m near a singular pose"
        assert (said in shown(drawn)) is cut
        assert bool(drawn.axes[1].get_ylim()[1] < 10) is cut


def test_what_turns_round_and_round_is_drawn_within_a_turn() -> None:
    (_, motion), upwards = ("four_bar", MOTION), np.degrees(MOTION.bodies["crank"].theta)
    for turns in (1.0, -3.0):
        crank = msgspec.structs.replace(motion.bodies["crank"], theta=np.radians(turns * upwards).tolist())
        axes = figure("bodies", msgspec.structs.replace(motion, bodies=motion.bodies | {"crank": crank})).axes[0]
        (line,) = [line for line in axes.lines if line.get_label() == "crank"]
        assert np.nanmin(line.get_ydata()) >= 0.0
        assert np.nanmax(line.get_ydata()) <= 360.0
        assert np.isnan(np.asarray(line.get_ydata(), float)).sum() == abs(turns) - 1
        assert set(np.diff(axes.get_yticks())) <= {45.0, 90.0}


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


def test_the_path_holds_every_stroke_in_its_bodys_colour() -> None:
    skeleton = plain_skeleton(MOTION)
    (axes,) = figure("path", MOTION).axes
    drawn = {tuple(np.ravel(line.get_xydata()).round(9)): line for line in axes.lines}
    for pose in skeleton.poses:
        for stroke in pose.strokes:
            closed = stroke.points + (stroke.points[:2] if stroke.closed else [])
            line = drawn[tuple(np.round(closed, 9))]
            assert line.get_color() == MOTION.bodies[stroke.ink.removeprefix("body:")].colour
            assert (line.get_alpha() == 0.3) is (pose is not skeleton.poses[0])


def test_the_axis_is_the_angle_of_one_forward_driver_else_time() -> None:
    over = horizon(MOTION)
    assert (over.words, over.unit, over.note) == ("motor angle", "°", "; a turn takes 1 s")
    motor = MOTION.drivers["motor"]
    swinging = msgspec.structs.replace(motor, value=list(np.sin(np.multiply(6, MOTION.time))))
    pushing = msgspec.structs.replace(motor, unit="m", effort_unit="N")
    for drivers in ({"motor": swinging}, {"motor": pushing}, {"motor": motor, "second": motor}, {}):
        other = msgspec.structs.replace(MOTION, drivers=drivers)
        assert (horizon(other).words, horizon(other).unit) == ("time", "s")
        np.testing.assert_array_equal(horizon(other).values, MOTION.time)


def test_along_one_axis_there_is_one_line() -> None:
    count = len(MOTION.time)
    still = msgspec.structs.replace(MOTION.points["P"], y=[0.02] * count, vy=[0.0] * count, ay=[0.0] * count)
    motion = msgspec.structs.replace(MOTION, points={"P": still})
    assert {"x", "vx", "ax"} <= shown(figure("point-P", motion))
    assert not {"y", "vy", "ay", "|v|", "|a|"} & shown(figure("point-P", motion))


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
    assert [axes.get_ylabel() for axes in drawn.axes] == ["force / N", "torque / (mN m)", "power / W"]
    np.testing.assert_array_equal(lines[0]["spring"], motion.forces["spring"].effort)
    np.testing.assert_array_equal(lines[1]["twist"], motion.forces["twist"].effort)
    assert max(lines[1]["end lower"]) > 0.0
    assert {"spring", "twist", "air"} <= set(lines[2])
    assert overlaps(drawn) == []
