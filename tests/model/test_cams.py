"""Cams: laws by their published peaks, discs by closed forms, followers by the lift they must follow."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.base.errors import ModelWarning
from mbsd.cams import (
    RISES,
    CamProfile,
    Lift,
    cam_from,
    flat_cam,
    oscillating_flat_cam,
    oscillating_roller_cam,
    roller_cam,
)

TABLE = json.loads((Path(__file__).parents[1] / "published" / "reference" / "analytic_cams.json").read_text())[
    "expected"
]["table"]
NAMES = {"simple harmonic": "harmonic", "3-4-5 polynomial": "3-4-5", "4-5-6-7 polynomial": "4-5-6-7"}
SPEED = 3.0
TURN = 2 * math.pi


def _name(row: dict[str, Any]) -> str:
    name = str(row["name"])
    return NAMES.get(name, name.replace(" ", "_"))


@pytest.mark.parametrize("row", TABLE, ids=_name)
def test_peaks_of_the_laws(row: dict) -> None:
    u = np.linspace(0.0, 1.0, 200_001)
    peaks = np.abs(RISES[_name(row)](u)).max(axis=0)
    expected = [1.0, row["Cv"], row["Ca"], 15.503138340149910 if "harmonic" in row["name"] else row["Cj"]]
    np.testing.assert_allclose(peaks, expected, rtol=1e-8)


@pytest.mark.parametrize("name", RISES)
def test_rises_are_smooth_and_their_derivatives_true(name: str) -> None:
    law, h = RISES[name], 1e-5
    u = np.linspace(0.0171, 0.9834, 301)
    u = u[np.abs(u[:, None] - np.array([1, 3, 5, 7]) / 8).min(axis=1) > 2 * h]
    slope = (law(u + h) - law(u - h)) / (2 * h)
    np.testing.assert_allclose(slope[:, :3], law(u)[:, 1:], atol=2e-6)
    ends = law(np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends[:, 0], [0, 1], atol=1e-15)
    np.testing.assert_allclose(ends[:, 1], 0, atol=1e-14)
    if name != "harmonic":
        np.testing.assert_allclose(ends[:, 2], 0, atol=1e-14)
    joints = np.array([1, 3, 4, 5, 7]) / 8
    np.testing.assert_allclose(law(joints - 1e-12)[:, :3], law(joints + 1e-12)[:, :3], atol=1e-9)


def _lift(height: float, rise: str = "cycloidal", fall: str = "3-4-5") -> Lift:
    turn = 2 * math.pi
    return Lift.of((0.3 * turn, height, rise), (0.1 * turn, height), (0.35 * turn, 0.0, fall), (0.25 * turn, 0.0))


# -- discs ------------------------------------------------------------------------------------------------------


def test_an_eccentric_circle_is_the_cam_of_a_harmonic_lift() -> None:
    """s = h (1 - cos theta) / 2 under a flat face: a circle of radius R_b + h / 2 about a centre h / 2 away."""
    base, height = 0.03, 0.01
    cam = flat_cam(Lift.of((math.pi, height, "harmonic"), (math.pi, 0.0, "harmonic")), base)
    np.testing.assert_allclose(cam.curvature_radius, base + height / 2, rtol=1e-12)
    centre = cam.outline.mean(axis=0)
    assert np.hypot(*centre) == pytest.approx(height / 2, rel=1e-9)
    np.testing.assert_allclose(np.hypot(*(cam.outline - centre).T), base + height / 2, rtol=1e-12)
    assert not cam.undercut
    assert cam.largest_pressure_angle == 0.0


@given(
    base=st.floats(0.03, 0.1),
    roller=st.floats(0.005, 0.02),
    offset=st.floats(-0.02, 0.02),
    rise=st.sampled_from(sorted(RISES)),
)
@settings(max_examples=25)
def test_roller_cam_by_its_formulas(base: float, roller: float, offset: float, rise: str) -> None:
    """tan(pressure angle) = (s' - e) / (d + s); the outline is one roller radius off the pitch curve."""
    lift = _lift(0.02, rise)
    cam = roller_cam(lift, base, roller, offset)
    s = lift.pieces()[1][:, 0]
    d = math.sqrt((base + roller) ** 2 - offset**2)
    tangent = (s[:, 1] - offset) / (d + s[:, 0])
    np.testing.assert_allclose(np.abs(np.tan(cam.pressure_angle)), np.abs(tangent), atol=1e-9)
    gap = cam.pitch - cam.outline
    np.testing.assert_allclose(np.hypot(*gap.T), roller, rtol=1e-12)
    assert ((gap * cam.pitch).sum(axis=1) > 0).all()  # the roller is outside
    # radius of curvature of the pitch curve in polar form: Norton eq. 8.32 for e = 0
    if offset == 0.0:
        r = d + s[:, 0]
        pitch_radius = (r**2 + s[:, 1] ** 2) ** 1.5 / (r**2 + 2 * s[:, 1] ** 2 - r * s[:, 2])
        np.testing.assert_allclose(cam.curvature_radius, pitch_radius - roller, rtol=1e-8)


def test_curvature_of_a_centred_roller_cam() -> None:
    lift = _lift(0.02, "4-5-6-7")
    cam = roller_cam(lift, 0.05, 0.01)
    s = lift.pieces()[1][:, 0]
    r = 0.06 + s[:, 0]
    pitch_radius = (r**2 + s[:, 1] ** 2) ** 1.5 / (r**2 + 2 * s[:, 1] ** 2 - r * s[:, 2])
    np.testing.assert_allclose(cam.curvature_radius, pitch_radius - 0.01, rtol=1e-8)


def test_undercut_is_told_with_its_place_and_remedy() -> None:
    quick = Lift.of(
        (math.radians(60), 0.03, "cycloidal"), (math.radians(60), 0.0, "cycloidal"), (math.radians(240), 0.0)
    )
    s = quick.pieces()[1][:, 0]
    flat = flat_cam(quick, 0.03)
    assert flat.undercut == bool((0.03 + s[:, 0] + s[:, 2]).min() <= 0)
    assert flat.undercut
    assert "undercut between cam angles" in flat.problems[0]
    enough = float(-(s[:, 0] + s[:, 2]).min())
    assert not flat_cam(quick, enough * 1.001).undercut
    assert flat_cam(quick, enough * 0.999).undercut
    small, large = roller_cam(quick, 0.02, 0.02), roller_cam(quick, 0.02, 0.03)
    assert (small.undercut, large.undercut) == (False, True)
    assert "smaller roller" in large.problems[0]
    assert "pressure angle reaches" in small.problems[0]
    assert not roller_cam(_lift(0.01), 0.06, 0.01).problems
    m = Mechanism("press")
    with pytest.warns(ModelWarning, match="press: joint 'contact': the outline is undercut"):
        m.cam_flat("contact", m.body("cam").origin, m.body("follower").origin, flat)


# -- followers --------------------------------------------------------------------------------------------------


def _translating(cam: CamProfile, mass: float = 0.0) -> Mechanism:
    m = Mechanism("cam", gravity=(0.0, -9.81))
    disc, follower = m.body("disc"), m.body("follower", mass)
    m.revolute("shaft", m.ground.origin, disc.origin)
    offset = cam.sizes.get("offset", 0.0)
    m.prismatic("guide", m.ground.at(offset, 0, math.pi / 2), follower.at(0, 0, math.pi / 2))
    (m.cam_flat if cam.flat else m.cam_roller)("contact", disc.origin, follower.origin, cam)
    reach = cam.sizes["base_radius"] + cam.sizes.get("roller_radius", 0.0)
    m.start_near(follower=(offset, math.sqrt(reach**2 - offset**2), 0))
    m.drive_angle("motor", disc, constant_rate(SPEED))
    return m


def _oscillating(cam: CamProfile, mass: float = 0.0) -> tuple[Mechanism, float]:
    """The mechanism and the arm's angle psi on the base circle."""
    sizes = cam.sizes
    m = Mechanism("cam", gravity=(0.0, -9.81))
    disc, arm = m.body("disc"), m.body("arm", mass, (0.05, 0.0), 1e-3)
    m.revolute("shaft", m.ground.origin, disc.origin)
    m.revolute("pivot", m.ground.at(sizes["pivot_distance"], 0), arm.origin)
    if cam.flat:
        rest = math.asin((sizes["base_radius"] + sizes["face_offset"]) / sizes["pivot_distance"])
        m.cam_flat("contact", disc.origin, arm.at(0, sizes["face_offset"], math.pi), cam)
    else:
        f, length, reach = sizes["pivot_distance"], sizes["arm"], sizes["base_radius"] + sizes["roller_radius"]
        rest = math.acos((f**2 + length**2 - reach**2) / (2 * f * length))
        m.cam_roller("contact", disc.origin, arm.at(length, 0), cam)
    m.start_near(arm=180 - math.degrees(rest))
    m.drive_angle("motor", disc, constant_rate(SPEED))
    return m, rest


TRANSLATING: dict[str, Callable[[Lift], CamProfile]] = {
    "roller": lambda lift: roller_cam(lift, 0.05, 0.01, 0.008),
    "flat": lambda lift: flat_cam(lift, 0.09),
}
OSCILLATING: dict[str, Callable[[Lift], CamProfile]] = {
    "roller": lambda lift: oscillating_roller_cam(lift, 0.05, 0.01, 0.1, 0.11),
    "flat": lambda lift: oscillating_flat_cam(lift, 0.05, 0.12, -0.01),
}


@pytest.mark.parametrize("rise", ["cycloidal", "3-4-5", "4-5-6-7", "modified_sine"])
@pytest.mark.parametrize("kind", TRANSLATING)
def test_a_translating_follower_follows_its_lift(kind: str, rise: str) -> None:
    lift = _lift(0.015, rise, "modified_trapezoid")
    cam = TRANSLATING[kind](lift)
    sol = _translating(cam, mass=0.4).sweep(steps=500)
    s, view = lift(SPEED * sol.t), sol.body("follower")
    np.testing.assert_allclose(view.y - view.y[0], s[:, 0], atol=1e-10)
    np.testing.assert_allclose(view.vy, SPEED * s[:, 1], atol=1e-7)
    np.testing.assert_allclose(view.ay, SPEED**2 * s[:, 2], atol=1e-4)
    load = 0.4 * (9.81 + view.ay)
    np.testing.assert_allclose(sol.driver("motor").torque, load * s[:, 1], atol=1e-7)  # virtual work
    contact = sol.joint("contact")
    np.testing.assert_allclose(contact.fy, load, rtol=1e-7)
    if kind == "roller":
        pressure = np.interp(np.mod(SPEED * sol.t, 2 * math.pi), cam.angle, cam.pressure_angle)[:-1]
        np.testing.assert_allclose(np.abs(contact.fx / contact.fy)[:-1], np.abs(np.tan(pressure)), atol=1e-4)


def _acceleration(kind: str, cam: CamProfile, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and the follower's acceleration (or angular one, along the lift) of a sweep at constant speed."""
    if kind.startswith("oscillating"):
        sol = _oscillating(cam)[0].sweep(steps=steps)
        return sol.t, -sol.body("arm").alpha
    sol = _translating(cam).sweep(steps=steps)
    return sol.t, sol.body("follower").ay


DISCS = {"roller": TRANSLATING["roller"], "flat": TRANSLATING["flat"]}
DISCS |= {f"oscillating {kind}": make for kind, make in OSCILLATING.items()}


@pytest.mark.parametrize("kind", DISCS)
@pytest.mark.parametrize("rise", RISES)
def test_between_its_nodes_a_disc_gives_the_exact_acceleration(rise: str, kind: str) -> None:
    """Within 1e-8 of the peak, for wide and narrow rises, at 1709 times that are no nodes."""
    height = 0.08 if kind.startswith("oscillating") else 0.006
    lift = Lift.of(
        (0.4, 0.0),
        (math.radians(75), height, rise),
        (0.3, height),
        (2.9, 0.0, rise),
        (TURN - 3.6 - math.radians(75), 0.0),
    )
    t, got = _acceleration(kind, DISCS[kind](lift), 1709)
    exact = SPEED**2 * lift(SPEED * t)[:, 2]
    inside = np.abs(SPEED * t[:, None] - lift.edges).min(axis=1) > 1e-9  # at the edges of a harmonic rise it jumps
    assert np.abs(got - exact)[inside].max() < 1e-8 * np.abs(exact).max()


@pytest.mark.parametrize("kind", ["roller", "oscillating flat"])
def test_a_disc_of_a_table_gives_the_acceleration_of_its_spline(kind: str) -> None:
    angles = TURN * (np.arange(37) + 0.3 * np.sin(np.arange(37))) / 37  # rows that fall on no even division
    height = 0.08 if kind.startswith("oscillating") else 0.006
    lift = Lift.table(angles, height * np.sin(angles) ** 2)
    t, got = _acceleration(kind, DISCS[kind](lift), 1709)
    exact = SPEED**2 * lift(SPEED * t)[:, 2]
    assert np.abs(got - exact).max() < 1e-8 * np.abs(exact).max()


@pytest.mark.parametrize("kind", OSCILLATING)
def test_an_oscillating_follower_follows_its_lift(kind: str) -> None:
    lift = _lift(0.25, "modified_sine", "4-5-6-7")
    m, rest = _oscillating(OSCILLATING[kind](lift), mass=0.3)
    sol = m.sweep(steps=500)
    s, arm = lift(SPEED * sol.t), sol.body("arm")
    np.testing.assert_allclose(math.pi - arm.theta, rest + s[:, 0], atol=1e-9)
    np.testing.assert_allclose(arm.omega, -SPEED * s[:, 1], atol=1e-6)
    np.testing.assert_allclose(arm.alpha, -(SPEED**2) * s[:, 2], atol=1e-3)
    weight = -0.3 * 9.81 * 0.05 * np.cos(arm.theta)
    wanted = (1e-3 + 0.3 * 0.05**2) * arm.alpha - weight
    np.testing.assert_allclose(sol.driver("motor").torque, -wanted * s[:, 1], atol=1e-6)


def test_pressure_angle_of_an_oscillating_flat_face_from_its_reaction() -> None:
    """Without friction the contact force is along the normal; its arm about the pivot tells where it acts."""
    lift = _lift(0.25)
    cam = oscillating_flat_cam(lift, 0.05, 0.12, -0.01)
    m, _ = _oscillating(cam, mass=0.3)
    sol = m.sweep(steps=360)
    contact, arm = sol.joint("contact"), sol.body("arm")
    force = np.hypot(contact.fx, contact.fy)
    along = contact.fx * np.cos(arm.theta) + contact.fy * np.sin(arm.theta)
    np.testing.assert_allclose(along, 0, atol=1e-9 * force.max())
    world = SPEED * sol.t[:-1]
    place = np.stack([np.interp(np.mod(world, 2 * math.pi), cam.angle, part) for part in cam.outline.T], axis=1)
    c, s = np.cos(world), np.sin(world)
    place = np.stack([c * place[:, 0] - s * place[:, 1], s * place[:, 0] + c * place[:, 1]], axis=1)
    reach = np.hypot(place[:, 0] - 0.12, place[:, 1])
    pressure = np.interp(np.mod(world, 2 * math.pi), cam.angle, cam.pressure_angle)
    moment = contact.torque + contact.fy * (contact.x - 0.12) - contact.fx * contact.y
    np.testing.assert_allclose(np.abs(moment[:-1]), force[:-1] * reach * np.abs(np.cos(pressure)), rtol=1e-3)


def test_a_lift_from_a_table_is_the_same_cam() -> None:
    theta = np.linspace(0, 2 * math.pi, 181)
    table = Lift.table(theta, 0.01 * (1 - np.cos(theta)) + 0.002 * np.sin(2 * theta) ** 2)
    sol = _translating(roller_cam(table, 0.05, 0.01)).sweep(steps=300)
    s = 0.01 * (1 - np.cos(SPEED * sol.t)) + 0.002 * np.sin(2 * SPEED * sol.t) ** 2
    np.testing.assert_allclose(sol.body("follower").y - sol.body("follower").y[0], s, atol=1e-9)


def test_cams_go_to_plain_data_and_back() -> None:
    cams = [make(_lift(0.02)) for make in TRANSLATING.values()] + [make(_lift(0.2)) for make in OSCILLATING.values()]
    for cam in cams:
        again = cam_from(json.loads(json.dumps(cam.data)))
        np.testing.assert_array_equal(again.numbers, cam.numbers)
    table = Lift.table(np.linspace(0, 6, 40), np.sin(np.linspace(0, 6, 40)) ** 2)
    np.testing.assert_array_equal(Lift.from_data(table.data)(np.array([0.3, 9.0])), table(np.array([0.3, 9.0])))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Lift.of((1.0, 0.1, "cycloidal")), "add up to 57.2958 degrees"),
        (lambda: Lift.of((math.pi, 0.1, "cycloidal"), (math.pi, 0.1)), "let it return"),
        (lambda: Lift.of((math.pi, 0.1, "square")), "there is: harmonic"),
        (lambda: Lift.of((math.pi, 0.1), (math.pi, 0.0)), "name its rise"),
        (lambda: Lift.of((-1.0, 0.1, "harmonic")), "must be positive"),
        (lambda: Lift.table(range(5), range(5)), "8 numbers or more"),
        (lambda: Lift.table(range(0, 360, 30), [0.0] * 12), "within one turn; they are in rad"),
        (lambda: roller_cam(_lift(0.01), -0.1, 0.01), "base_radius is -0.1 m"),
        (lambda: roller_cam(_lift(0.01), 0.03, 0.01, 0.05), "offset 0.05 m is outside"),
        (lambda: oscillating_roller_cam(_lift(0.1), 0.05, 0.01, 0.02, 0.11), "does not put its roller on a base"),
        (lambda: oscillating_flat_cam(_lift(0.1), 0.05, 0.04), "must be below"),
        (lambda: cam_from({"follower": "pointed"}), "there is no follower 'pointed'"),
    ],
)
def test_cams_that_cannot_be_are_refused(make, says: str) -> None:
    with pytest.raises(ModelError, match=says):
        make()


def test_a_profile_for_the_other_follower_is_refused() -> None:
    m = Mechanism("press")
    with pytest.raises(ModelError, match="its profile is for the follower 'flat'; use cam_flat"):
        m.cam_roller("contact", m.body("cam").origin, m.body("follower").origin, flat_cam(_lift(0.01), 0.1))
