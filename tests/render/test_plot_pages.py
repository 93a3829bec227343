"""Pages of plots show the numbers they were given, with their units: motion, energies, shaking."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import numpy as np
import pytest

from mbsd import Mechanism, harmonic
from mechanisms.stages.solve.motion_file import to_motion
from render import plots
from render.magnitudes import shaking
from render.plots import plots_of
from render.plots.measures import horizon
from render.plots.pages.energy import powers, statement
from render.plots.pages.forces import frame
from render.plots.quantities import known_names, quantity
from render.plots.style import house_style
from render.report import report
from render.view.payload import couple_of, frame_of
from shared.contract import Motion, read_motion, write_motion
from tests.render.plotted import MOTION, NAMES, figure, overlaps, shown
from tests.results.test_couples import two_cylinders
from tools.models.motions import bouncing_ball, plain_skeleton


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
        said = "clipped: up to 20 TN·m near a singular pose"
        assert (said in shown(drawn)) is cut
        assert bool(drawn.axes[1].get_ylim()[1] < 10) is cut


def test_angles_that_keep_turning_are_drawn_within_a_turn() -> None:
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
    assert [axes.get_ylabel() for axes in drawn.axes] == ["force / N", "torque / (mN·m)", "power / W"]
    np.testing.assert_array_equal(lines[0]["spring"], motion.forces["spring"].effort)
    np.testing.assert_array_equal(lines[1]["twist"], motion.forces["twist"].effort)
    assert max(lines[1]["end lower"]) > 0.0
    assert {"spring", "twist", "air"} <= set(lines[2])
    assert overlaps(drawn) == []


def test_an_impact_is_marked_in_joules_and_is_no_power() -> None:
    ball = bouncing_ball()
    given, rate = powers(ball)
    assert np.abs(given).max() == np.abs(rate).max() == 0.0  # a gradient over the samples would show tens of watts
    assert (
        statement(ball) == "nothing gives or takes power: the energy stays, but for 1 impact that takes 1.47 J at once"
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
    assert "drivers and other forces (friction, dampers, loads; up to 300 mW) is the rate" in statement(motion)
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
                if "angle / °" not in axes.get_ylabel() and len(values) == count:
                    assert np.ptp(values) == 0.0, (plot, line.get_label())
    assert [axes.get_ylabel() for axes in figure("reactions", motion).axes] == [
        "reaction force / mN",
        "driver torque / (N·m)",
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


def motion_of(m: Mechanism) -> Motion:
    sources = dict.fromkeys(m.bodies, "mechanism")
    return to_motion(m.sweep(steps=360), None, "0" * 64, {}, sources)  # pyright: ignore[reportArgumentType]


def test_couples_are_shown_everywhere_as_the_solution_has_them() -> None:
    m = two_cylinders()
    motion, exact = motion_of(m), m.sweep(steps=360).shaking()
    assert motion.couple is not None
    assert (motion.couple.about, motion.couple.reach) == (0.0, pytest.approx(0.1))
    assert motion.couple.mx == pytest.approx(exact.mx, abs=1e-12)
    largest = float(np.abs(exact.mx).max())
    assert quantity(motion, "shaking couple").components["x"] == pytest.approx(exact.mx, abs=1e-9 * largest)
    assert "| couple | 5 N·m | 0 N·m |" in report(motion, None, None)
    on_the_page = couple_of(motion)
    assert on_the_page is not None
    assert not on_the_page["my"].any()
    assert shaking(motion).fy == pytest.approx(exact.fy, abs=1e-6 * np.abs(exact.fy).max())


def test_without_places_nothing_is_said_of_couples() -> None:
    motion = motion_of(two_cylinders((0.0, 0.0)))
    assert motion.couple is None
    assert "shaking couple" not in known_names(motion)
    assert "Shaking" not in report(motion, None, None)
    assert couple_of(motion) is None


def test_orders_are_in_the_file_the_report_and_the_page_as_the_solution_has_them(tmp_path: Path) -> None:
    m = two_cylinders()
    m.bodies["piston_1"].mass = 0.7
    motion, sol = motion_of(m), m.sweep(steps=360)
    vibration, exact = motion.vibration, sol.orders(sol.shaking().force)
    assert vibration is not None
    assert (vibration.crank, vibration.turns) == ("crank", 1)
    force_orders, k = vibration.harmonics["shaking force"], vibration.order.index(1.0)
    row = exact.index(1)
    assert force_orders.amplitude[1][k] == pytest.approx(exact.amplitude[row, 1])
    assert force_orders.phase[1][k] == pytest.approx(exact.phase[row, 1])
    assert force_orders.forward[k] + force_orders.backward[k] == pytest.approx(exact.largest[row])
    torque = sol.orders(sol.driver("motor").effort)
    assert vibration.harmonics["motor"].amplitude[0][1] == pytest.approx(torque.amplitude[torque.index(2)])
    main = sol.orders(sol.joint("main").reaction)
    assert vibration.harmonics["main"].amplitude[0][1] == pytest.approx(main.amplitude[main.index(2), 0])
    centre = sol.centre_of_mass()
    assert vibration.y == pytest.approx(centre.y)
    text = report(motion, None, None)
    assert "## Orders" in text
    assert "goes 0 m along x" in text
    page = frame_of(motion)
    assert page is not None
    assert page["crank"] == "crank"
    assert all(bars["size"].any() for bars in page["harmonics"].values())  # what is rounding is no bar
    assert page["harmonics"]["motor"]["size"][1] == pytest.approx(torque.largest[torque.index(2)], rel=1e-6)
    assert "frame" in plots_of(motion)
    with house_style():
        assert len(frame(motion).axes) == 3
    write_motion(tmp_path / "data.json", motion)
    assert read_motion(tmp_path / "data.json").vibration == vibration


def test_a_motion_without_a_crank_or_without_mass_has_no_orders() -> None:
    m = Mechanism("pendulum")
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("A", m.ground.origin, arm.start)
    m.drive_angle("motor", arm, harmonic(0.3, 1.0))
    assert motion_of(m).vibration is None
    m = two_cylinders()
    for name in ("piston_1", "piston_2"):
        m.bodies[name].mass = 0.0
    assert motion_of(m).vibration is None
