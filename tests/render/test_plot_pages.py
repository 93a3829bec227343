"""Pages of plots show the numbers they were given, with their units, over the axis that fits."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from render import plots
from render.plots.horizon import horizon
from render.plots.style import colour
from tests.models.motions import plain_skeleton
from tests.render.plotted import MOTION, NAMES, figure, overlaps, shown


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


def test_the_axis_is_the_angle_of_one_forward_driver_else_time() -> None:
    assert horizon(MOTION).label == "motor angle (deg; a turn takes 1 s)"
    motor = MOTION.drivers["motor"]
    swinging = msgspec.structs.replace(motor, value=list(np.sin(np.multiply(6, MOTION.time))))
    pushing = msgspec.structs.replace(motor, kind="coordinate")
    for drivers in ({"motor": swinging}, {"motor": pushing}, {"motor": motor, "second": motor}, {}):
        other = msgspec.structs.replace(MOTION, drivers=drivers)
        assert horizon(other).label == "time (s)"
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
    assert [axes.get_ylabel() for axes in drawn.axes] == ["force (N)", "torque (N m)", "power (W)"]
    np.testing.assert_array_equal(lines[0]["spring"], motion.forces["spring"].effort)
    np.testing.assert_array_equal(lines[1]["twist"], motion.forces["twist"].effort)
    assert max(lines[1]["end lower"]) > 0.0
    assert {"spring", "twist", "air"} <= set(lines[2])
    assert overlaps(drawn) == []
