"""Arrows and bars of an animation: their quantities, scales and words."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from mbsd import Mechanism, constant_rate
from mbsd.base.quantity import written
from mbsd.drawing.animation.arrows import LONGEST, Arc, Arrow, scales_of
from mbsd.drawing.animation.bars import Bars
from mbsd.drawing.animation.brush import Brush
from mbsd.drawing.animation.flow import Balance
from mbsd.drawing.animation.words import round_below
from tests.drawing.test_animation import four_bar, scene
from tools.models.contact_models import ball


def test_reactions_are_those_on_the_body_that_moves() -> None:
    drawn = scene(four_bar().sweep())
    arrows = [mark for mark in drawn.marks(("reactions",)) if isinstance(mark, Arrow)]
    for mark, name, sign in zip(arrows, "ABCD", (1, 1, 1, -1), strict=True):
        view = drawn.sol.joint(name)
        assert np.allclose(mark.vector, sign * view.reaction)
        assert np.allclose(mark.place, np.stack([view.x, view.y], axis=1))


def test_forces_are_weights_and_efforts() -> None:
    drawn = scene(four_bar().sweep())
    weights = [mark for mark in drawn.marks(("forces",)) if isinstance(mark, Arrow) and mark.size.max() > 1e-12]
    assert len(weights) == 3
    assert all(np.allclose(mark.vector, (0.0, -0.1 * 9.80665)) for mark in weights)
    torques = [mark for mark in drawn.marks(("forces",)) if isinstance(mark, Arc)]
    assert any(np.allclose(mark.value, drawn.sol.driver("motor").torque) for mark in torques)


def test_velocities_are_drawn_once_for_each_place_that_moves() -> None:
    drawn = scene(four_bar().sweep())
    places = [mark.place[0] for mark in drawn.marks(("velocities",))]
    assert len(places) == 3  # B, C, P
    gap = np.linalg.norm(np.array(places)[:, None] - np.array(places)[None], axis=-1) + np.eye(3)
    assert gap.min() > 1e-3
    p = drawn.sol.point("P")
    assert any(np.allclose(mark.vector, np.stack([p.vx, p.vy], axis=1)) for mark in drawn.marks(("velocities",)))


def test_a_gear_pushes_where_its_teeth_meet() -> None:
    m = Mechanism("gears", gravity=None)
    pinion, gear = m.body("one", 1.0, inertia=1e-3), m.body("two", 1.0, inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0), pinion.origin)
    m.revolute("B", m.ground.at(0.05, 0), gear.origin)
    m.gear_pair("teeth", pinion.origin, gear.origin, 0.02, 0.03)
    m.torque("load", gear, -1.0)
    m.drive_angle("motor", pinion, constant_rate(3.0))
    drawn = scene(m.sweep(2 * math.pi))
    [mesh] = [k for k, joint in enumerate(drawn.sol.packed.joints) if joint.name == "teeth"]
    marks = [mark for mark in drawn.marks(("reactions",)) if isinstance(mark, Arrow)]
    assert np.allclose(marks[mesh].place, (0.02, 0.0), atol=1e-12)
    spins = [mark for mark in drawn.marks(("velocities",)) if isinstance(mark, Arc)]
    assert sorted(float(mark.value[0]) for mark in spins) == pytest.approx([-2.0, 3.0])


def test_teeth_turn_with_their_wheels_and_stay_in_mesh() -> None:
    from mbsd.drawing.animation.brush import Brush

    m = Mechanism("gears", gravity=None)
    pinion, gear = m.body("one"), m.body("two")
    m.revolute("A", m.ground.at(0, 0), pinion.origin)
    m.revolute("B", m.ground.at(0.05, 0), gear.origin)
    m.gear_pair("teeth", pinion.origin, gear.origin, 0.02, 0.03)
    m.drive_angle("motor", pinion, constant_rate(3.0))
    drawn = scene(m.sweep(2 * math.pi))
    for k in (0, 7, 23):
        brush = Brush(None, drawn.steady.unit)
        drawn.draw(brush, k, {"one": "#112233", "two": "#445566"})
        (z_i, phase_i), (z_j, phase_j) = brush.wheels["one", 0.02], brush.wheels["two", 0.03]
        # a tooth of one meets a gap of two at angle 0 of one, which is pi of two
        assert math.cos(0 * z_i - phase_i) == pytest.approx(-math.cos(math.pi * z_j - phase_j), abs=1e-6)
        turned = float(drawn.tracks.views["one"].theta[k] - drawn.tracks.views["one"].theta[0])
        assert phase_i - drawn.steady.wheels["one", 0.02][1] == pytest.approx(z_i * turned)


def test_energy_flows_from_the_motor_to_the_slider() -> None:
    m = Mechanism("slider_crank", gravity=None)
    crank, rod, slider = m.bar("crank", 0.05), m.bar("rod", 0.15), m.body("slider", 0.5)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(20.0))
    m.start_near(crank=30, rod=-10)
    drawn = scene(m.sweep(), 0.05)
    power = np.abs(drawn.sol.driver("motor").power)
    flows = [mark for mark in drawn.marks(("energy",)) if mark.size.max() > 1e-9]
    assert len(flows) == 3  # motor to crank, crank to rod, rod to slider: without mass they pass all of it on
    assert all(np.allclose(mark.size, power, atol=2e-3 * power.max()) for mark in flows)
    body = drawn.sol.body("slider")
    assert np.allclose(power, np.abs(0.5 * body.ax * body.vx), rtol=1e-3, atol=1e-3 * power.max())
    assert np.allclose(drawn.balance.kinetic, drawn.balance.bodies["slider"])


def test_impacts_ring_at_the_floor() -> None:
    from mbsd.drawing.animation.trails import impacts_of

    drawn = scene(ball(0.5).simulate(2.0))
    impacts = impacts_of(drawn)
    assert impacts[0].time == pytest.approx(math.sqrt(2 / 9.81))
    assert impacts[0].part == 1.0
    assert all(np.allclose(impact.place, 0.0, atol=1e-9) for impact in impacts)


def test_one_scale_for_the_clip_and_a_round_reference() -> None:
    marks = scene(four_bar().sweep()).marks(("velocities",))
    scale = scales_of(marks, {})["m/s"]
    assert scale.largest == pytest.approx(max(float(mark.size.max()) for mark in marks))
    assert scale.reference in (0.1, 0.2, 0.5)
    assert not scale.cut


def test_a_rare_peak_is_cut_and_told() -> None:
    size = np.ones(200)
    size[50] = 30.0
    mark = Arrow("forces", np.zeros((200, 2)), np.stack([size, 0 * size], axis=1))
    scale = scales_of([mark], {})["N"]
    assert scale.cut
    assert scale.largest == 1.0
    assert scale.part(30.0) == LONGEST


@pytest.mark.parametrize(("value", "below"), [(0.93, 0.5), (1.0, 1.0), (4.9, 2.0), (730.0, 500.0)])
def test_round_numbers(value: float, below: float) -> None:
    assert round_below(value) == pytest.approx(below)


def test_units_have_prefixes() -> None:
    assert written(0.005, "N") == "5 mN"
    assert written(2000.0, "N") == "2 kN"
    assert written(0.2, "m/s") == "200 mm/s"
    assert written(2000.0, "m/s²") == "2000 m/s²"


DPI = 100.0


class _Plates(Brush):
    """Keeps the boxes of what is painted (pixels)."""

    def __init__(self) -> None:
        self.boxes: list[Bbox] = []

    def plate(self, corners: np.ndarray, *_: Any, **__: Any) -> None:
        self.boxes.append(Bbox([corners.min(axis=0), corners.max(axis=0)]))

    def stroke(self, *_: Any, **__: Any) -> None:
        pass


@pytest.mark.parametrize("height", [132.0, 180.0, 400.0])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_names_of_powers_are_clear_of_each_other_and_of_the_bars(count: int, height: float) -> None:
    energy, power = np.array([1.0, 2.0]), np.array([-1.0, 1.0])
    powers = {f"gas of cylinder {k}": power * (1.0 + k) for k in range(count)}
    figure = Figure(figsize=(4.0, 5.0), dpi=DPI)
    renderer = FigureCanvasAgg(figure).get_renderer()
    bars, plates = Bars(Balance(energy, energy, powers, {}), (10.0, 20.0, 140.0, height), DPI), _Plates()
    bars.paint_still(figure, renderer)
    bars.draw(plates, 1)
    names = [text for text in figure.texts if text.get_text().startswith("gas")]
    assert len(names) >= min(count, 3)
    words = [text.get_window_extent(renderer) for text in figure.texts]
    for k, box in enumerate(words):
        assert not any(box.overlaps(other) for other in words[k + 1 :])
        assert not any(box.overlaps(other) for other in plates.boxes if other.width > 0 and other.height > 0)
