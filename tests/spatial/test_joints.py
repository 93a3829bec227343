"""Joints in space do what their names say, in driven mechanisms of one or two bodies."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

from mbsd.base.errors import MobilityError, ModelError
from mbsd.spatial import Mechanism, constant_rate, harmonic


def on_a_spindle(name: str = "spindle") -> tuple[Mechanism, object]:
    """Return a wheel that a motor turns at 2 rad/s about z."""
    m = Mechanism(name)
    wheel = m.disc("wheel", (0, 0, 0), (0, 0, 1), radius=0.1, mass=1.0, thickness=0.02)
    m.revolute("bearing", m.ground, wheel, at=(0, 0, 0), axis=(0, 0, 1))
    m.drive_turn("motor", "bearing", constant_rate(2.0))
    return m, wheel


@pytest.mark.parametrize("bend", [0.0, 30.0, 70.0])
def test_a_constant_velocity_joint_turns_both_shafts_alike(bend: float) -> None:
    angle = math.radians(bend)
    out = np.array([math.cos(angle), math.sin(angle), 0.0])
    m = Mechanism("constant velocity")
    a, b = m.shaft("in", (-1, 0, 0), (0, 0, 0), radius=0.01), m.shaft("out", (0, 0, 0), out, radius=0.01)
    m.revolute("bearing 1", m.ground, a, at=(-1, 0, 0), axis=(1, 0, 0))
    m.constant_velocity("joint", a, b, at=(0, 0, 0), first=(1, 0, 0), second=out)
    m.cylindrical("bearing 2", m.ground, b, at=out, axis=out)
    m.drive_turn("motor", "bearing 1", constant_rate(2.0))
    sol = m.sweep(duration=math.pi, steps=60)
    assert np.allclose(sol.joint("bearing 2").turn_rate, 2.0, rtol=0, atol=1e-11)


def test_a_screw_moves_its_lead_in_a_turn() -> None:
    m, wheel = on_a_spindle()
    nut = m.body("nut", 1.0, inertia=(1.0, 1.0, 1.0))
    m.screw("thread", wheel, nut, at=(0, 0, 0), axis=(0, 0, 1), lead=0.01)
    m.prismatic("rail", m.ground, nut, at=(0, 0, 0), axis=(0, 0, 1))
    sol = m.sweep(duration=2 * math.pi, steps=40)
    assert sol.joint("rail").slide[-1] == pytest.approx(-0.02, abs=1e-12)
    assert sol.joint("thread").turn[-1] == pytest.approx(-4 * math.pi, abs=1e-10)


@pytest.mark.parametrize(("crossed", "rate"), [(False, 1.0), (True, -1.0)])
def test_a_belt_turns_wheels_by_their_radii(crossed: bool, rate: float) -> None:
    m, _ = on_a_spindle()
    other = m.disc("other", (1, 0, 0), (0, 0, 1), radius=0.2, mass=1.0, thickness=0.02)
    m.revolute("shaft", other, m.ground, at=(1, 0, 0), axis=(0, 0, 1))  # the carrier second
    m.belt("belt", "bearing", "shaft", radii=(0.1, 0.2), crossed=crossed)
    assert np.allclose(m.sweep(duration=1.0, steps=10).body("other").w[:, 2], rate, rtol=0, atol=1e-12)


def test_a_rack_moves_by_the_radius_of_its_pinion() -> None:
    m, _ = on_a_spindle()
    rack = m.body("rack", 1.0, inertia=(1.0, 1.0, 1.0))
    m.prismatic("rail", m.ground, rack, at=(0, 0.1, 0), axis=(-1, 0, 0))
    m.rack_and_pinion("teeth", "bearing", "rail", radius=0.1)
    sol = m.sweep(duration=1.0, steps=10)
    assert np.allclose(sol.body("rack").velocity[:, 0], -0.2, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("internal", "rate"), [(False, -3.0), (True, 3.0)])
def test_gears_turn_by_their_teeth(internal: bool, rate: float) -> None:
    m, _ = on_a_spindle()
    other = m.disc("other", (0.3, 0, 0), (0, 0, 1), radius=0.07, mass=1.0)
    m.revolute("shaft", m.ground, other, at=(0.3, 0, 0), axis=(0, 0, 1))
    m.gear_pair("teeth", "bearing", "shaft", teeth=(30, 20), internal=internal)
    assert np.allclose(m.sweep(duration=5.0, steps=10).body("other").w[:, 2], rate, rtol=0, atol=1e-12)


def test_points_on_lines_and_planes_leave_what_they_say() -> None:
    """A ball that two slides of a crank and a plane lead: each joint carries only across its way."""
    m, wheel = on_a_spindle()
    pin = m.ball("pin", (0.1, 0, 0), radius=0.01, mass=0.5)
    m.point_on_line("groove", m.ground, pin, at=(0.1, 0, 0), axis=(1, 0, 0))
    m.point_on_plane("slot", wheel, pin, at=(0.1, 0, 0), axis=(1, 0, 0))
    m.lock("level", m.ground, pin)
    sol = m.sweep(duration=0.5, steps=20)
    assert np.allclose(sol.body("pin").x, 0.1 / np.cos(2 * sol.t), rtol=0, atol=1e-12)
    assert np.abs(sol.joint("groove").along).max() < 1e-12
    assert np.abs(sol.joint("slot").local_force[:, :2]).max() < 1e-12
    assert np.abs(sol.joint("slot").moment).max() < 1e-12


def test_a_flat_guide_and_a_fork_hold_a_plate() -> None:
    """A plate on a flat guide, driven along by rods: its height and level stay."""
    m = Mechanism("plate")
    plate = m.body("plate", 3.0, com=(0, 0, 0.2), inertia=(1.0, 1.0, 1.0))
    m.planar("guide", m.ground, plate, at=(0, 0, 0.2), axis=(0, 0, 1))
    m.rod_with_fork("fork", m.ground, plate, start=(-1, 0, 0.2), end=(0, 0, 0.2), axis=(0, 0, 1))
    m.drive_distance("jack", m.ground, plate, harmonic(0.1, 3.0, mean=1.0), start=(0, -1, 0.2), end=(0, 0, 0.2))
    with pytest.raises(MobilityError, match="1 of 2 degrees of freedom is not driven: plate can still move"):
        m.sweep(duration=1.0)
    m.drive_turn("hand", "guide", harmonic(0.3, 2.0))
    sol = m.sweep(duration=1.0, steps=30)
    assert np.allclose(sol.body("plate").z, 0.0, rtol=0, atol=1e-13)
    assert np.allclose(sol.joint("guide").turn, 0.3 * np.sin(2 * sol.t), rtol=0, atol=1e-12)
    carried = sol.joint("guide").along + sol.joint("fork").force[:, 2]  # both hold the height, and share it
    assert np.allclose(carried, 3.0 * 9.80665, rtol=0, atol=1e-9)
    assert sol.mobility.redundant == ("fork",)
    reach = np.linalg.norm(sol.joint("fork").place - [-1, 0, 0.2], axis=1)
    assert np.allclose(reach, 1.0, rtol=0, atol=1e-13)


def test_parallel_axes_and_markers_serve_as_joints() -> None:
    m = Mechanism("markers")
    arm = m.rod("arm", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.05)
    hub = m.ground.marker((0, 0, 0), axis=(0, 0, 1), across=(1, 0, 0))
    own = arm.marker((0, 0, 0), axis=arm.rotation.T @ [0, 0, 1], across=(1, 0, 0))
    m.revolute("hinge", hub, own)
    m.drive_turn("motor", "hinge", constant_rate(1.0))
    assert m.sweep(duration=1.0, steps=4).joint("hinge").turn[-1] == pytest.approx(1.0, abs=1e-12)
    assert m.mobility().dof == 1
    with pytest.raises(ModelError, match="has markers and a place or an axis"):
        m.revolute("other", hub, own, at=(0, 0, 0), axis=(0, 0, 1))
    with pytest.raises(ModelError, match="a marker and a body"):
        m.spherical("third", hub, arm, at=(0, 0, 0))


def test_a_model_in_space_loads_no_compiler() -> None:
    code = (
        "import sys; from mbsd.spatial import Mechanism; m = Mechanism('m'); m.rod('a', (0, 0, 0), (1, 0, 0)); "
        "assert 'numba' not in sys.modules and 'scipy' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_planar_solutions_load_nothing_of_space() -> None:
    code = (
        "import sys; from mbsd import Mechanism; m = Mechanism('m'); m.bar('a', 1.0); "
        "import mbsd.kinematics.sweep, mbsd.dynamics.simulate, mbsd.machines, mbsd.studies; "
        "assert not [name for name in sys.modules if name.startswith('mbsd.spatial')]"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
