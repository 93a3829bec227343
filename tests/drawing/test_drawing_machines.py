"""Symbols of racks, discs, curves, cams and Geneva wheels: what touches in the mechanism touches in its drawing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.path import Path

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, flat_cam, roller_cam
from mbsd.drawing.look import INKS, apart

LIFT = Lift.of((math.pi / 2, 0.02, "cycloidal"), (math.pi / 2, 0.02), (math.pi, 0.0, "3-4-5"))


def outlines(ax: Axes, number: int, order: float) -> list[np.ndarray]:
    """Filled outlines of the body of this number, drawn at this height."""
    from matplotlib.colors import to_hex

    edge = colours(ax)[number]
    return [
        np.asarray(patch.get_path().vertices)
        for patch in ax.patches
        if to_hex(patch.get_edgecolor()) == edge and patch.get_zorder() == order
    ]


def colours(ax: Axes) -> list[str]:
    """Of the bodies, whose names are written in the model's order."""
    from matplotlib.colors import to_hex

    shades = set(apart({f"{ink} {k}": ink for ink in INKS.values() for k in range(5)}).values())
    return list(dict.fromkeys(ink for text in ax.texts if (ink := to_hex(text.get_color())) in shades))


def lines(ax: Axes) -> list[np.ndarray]:
    return [np.asarray(line.get_xydata()) for line in ax.lines]


def geneva(slots: int, start: float) -> Mechanism:
    m = Mechanism("geneva")
    crank, wheel = m.body("crank"), m.body("wheel")
    m.revolute("O", m.ground.at(0.2, 0.1), crank.origin)
    m.revolute("W", m.ground.at(0.2, 0.2), wheel.origin)
    m.geneva("index", crank.origin, wheel.at(0, 0, 0.3), slots, 0.1 * math.sin(math.pi / slots))
    m.drive_angle("motor", crank, constant_rate(1.0, start))
    return m


@pytest.mark.parametrize("slots", [3, 4, 6, 8])
def test_the_locking_disc_of_a_geneva_turns_in_the_arcs_of_its_wheel(slots: int) -> None:
    sol = geneva(slots, 0.1).sweep(2 * math.pi, steps=48)
    for step in range(0, 48, 3):
        ax = sol.draw(step=step).ax
        [lock], [wheel] = outlines(ax, 0, 1.9), outlines(ax, 1, 1.8)
        centre = lock.mean(axis=0)
        assert not Path(wheel).contains_points(centre + 0.98 * (lock - centre)).any(), f"step {step}"


@pytest.mark.parametrize("slots", [3, 4, 6, 8])
def test_the_pin_of_a_geneva_stands_in_a_slot_or_outside(slots: int) -> None:
    sol = geneva(slots, 0.1).sweep(2 * math.pi, steps=48)
    inside = 0
    for step in range(0, 48, 3):
        [wheel] = outlines(sol.draw(step=step).ax, 1, 1.8)
        angle = sol.body("crank").theta[step]
        pin = np.array([0.2, 0.1]) + 0.1 * math.sin(math.pi / slots) * np.array([math.cos(angle), math.sin(angle)])
        assert not Path(wheel).contains_point(pin)
        inside += np.hypot(*(pin - [0.2, 0.2])) < 0.1 * math.cos(math.pi / slots)
    assert inside, "it is in a slot for part of the turn"


@pytest.mark.parametrize("on_ground", [False, True], ids=["rack_moves", "pinion_moves"])
def test_teeth_of_a_rack_stand_in_the_gaps_of_its_pinion(on_ground: bool) -> None:
    m = Mechanism("steering")
    pinion, other = m.body("pinion"), m.body("other", 1.0)
    if on_ground:
        m.prismatic("rail", m.ground.at(0, 0.1), other.origin)
        m.revolute("axle", other.origin, pinion.origin)
        m.rack_and_pinion("teeth", m.ground.at(0, 0), pinion.origin, 0.1)
    else:
        m.revolute("axle", m.ground.at(0, 0.1), pinion.origin)
        m.prismatic("guide", m.ground.at(0, -0.03), other.at(0, -0.03))
        m.rack_and_pinion("teeth", other.origin, pinion.origin, 0.1)
    ax = m.draw().ax
    gear = max(outlines(ax, 0, 1.8), key=len)
    from matplotlib.colors import to_hex

    from mbsd.drawing.look import QUIET

    edge = QUIET if on_ground else colours(ax)[1]
    [rack] = [
        np.asarray(p.get_path().vertices)
        for p in ax.patches
        if to_hex(p.get_edgecolor()) == edge and p.get_zorder() == 1.8 and len(p.get_path().vertices) > 50
    ]
    near = gear[(np.abs(gear[:, 0]) < 0.012) & (gear[:, 1] < 0.05)]
    assert len(near) > 4
    top = np.interp(near[:, 0], rack[:-3, 0], rack[:-3, 1])
    assert (near[:, 1] - top > -5e-4).all(), "they do not cut into each other"
    assert np.abs(near[:, 1] - top).min() < 1e-3, "they touch"


def test_a_disc_stands_on_its_line() -> None:
    m = Mechanism("slope")
    disc = m.body("disc", 2.0, inertia=0.04)
    m.rolling_disc("road", m.ground.at(0.3, 0.1, -0.3), disc.origin, 0.2)
    m.start_near(disc=(0.3, 0.3, 0))
    ax = m.draw().ax
    rim = max(outlines(ax, 0, 1.8), key=lambda points: np.ptp(points[:, 0]))
    normal = np.array([math.sin(0.3), math.cos(0.3)])
    height = (rim - [0.3, 0.1]) @ normal
    assert height.min() == pytest.approx(0.0, abs=1e-3)
    assert height.max() == pytest.approx(0.4, abs=1e-3)


def test_a_curve_is_drawn_through_its_points() -> None:
    points = [(0, 1), (0.3, 0.4), (0.8, 0.1), (1.5, 0.3), (2, 0.2), (2.5, 0.6)]
    m = Mechanism("bead")
    bead = m.body("bead", 1.0, inertia=0.01)
    m.point_on_curve("wire", m.ground.at(0.1, 0.2), bead.origin, points)
    m.start_near(bead=(0.4, 0.6, 0))
    wire = max(lines(m.draw().ax), key=len)
    for x, y in points:
        assert np.hypot(wire[:, 0] - x - 0.1, wire[:, 1] - y - 0.2).min() < 0.02


@pytest.mark.parametrize("start", [0.0, 1.0, 2.0, 4.5])
def test_roller_and_face_touch_the_cam(start: float) -> None:
    for flat in (False, True):
        m = Mechanism("cam")
        cam, follower = m.body("cam"), m.body("follower", 0.2)
        m.revolute("shaft", m.ground.at(0, 0), cam.origin)
        m.prismatic("guide", m.ground.at(0, 0.1, math.pi / 2), follower.at(0, 0.05, math.pi / 2))
        if flat:
            m.cam_flat("contact", cam.origin, follower.origin, flat_cam(LIFT, 0.06))
        else:
            m.cam_roller("contact", cam.origin, follower.origin, roller_cam(LIFT, 0.04, 0.01))
        m.drive_angle("motor", cam, constant_rate(1.0, start))
        m.start_near(follower=(0, 0.06, 0))
        ax = m.draw().ax
        disc = max(outlines(ax, 0, 1.8), key=len)
        place = float(m.sweep(steps=1, duration=1e-3).body("follower").y[0])
        gap = place - disc[:, 1].max() if flat else np.hypot(disc[:, 0], disc[:, 1] - place).min() - 0.01
        assert abs(gap) < 2e-4
