"""Couples of bodies in different places along the normal of the plane, against sums over particles."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate

SPEED, R, ROD, PISTON = 50.0, 0.04, 0.16, 0.5


def two_cylinders(z: tuple[float, float] = (-0.05, 0.05)) -> Mechanism:
    """In line along y, throws opposite: no force of the first order, but a couple."""
    m = Mechanism("twin")
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, (sign, place) in enumerate(zip((1, -1), z, strict=True), start=1):
        rod = m.bar(f"rod_{k}", ROD, z=place)
        piston = m.body(f"piston_{k}", mass=PISTON, z=place)
        m.revolute(f"pin_{k}", crank.at(0, sign * R, z=place), rod.start)
        m.revolute(f"wrist_{k}", rod.end, piston.origin)
        m.prismatic(f"bore_{k}", m.ground.at(0, 0, math.pi / 2), piston.at(0, 0, math.pi / 2))
        m.start_near(**{f"rod_{k}": 90})
    m.drive_angle("motor", crank, constant_rate(SPEED))
    return m


def test_the_rocking_couple_of_two_cylinders_is_that_of_the_books() -> None:
    sol = two_cylinders().sweep(steps=360)
    first = PISTON * R * SPEED**2
    shaking = sol.shaking()
    orders = sol.orders(shaking.mx)
    assert orders.amplitude[orders.index(1)] == pytest.approx(first * 0.1, rel=1e-12)
    assert orders.amplitude[orders.index(2)] == pytest.approx(0.0, abs=1e-9 * first)
    assert np.abs(shaking.my).max() < 1e-9 * first
    force = sol.orders(shaking.fy)
    assert force.amplitude[force.index(1)] == pytest.approx(0.0, abs=1e-9 * first)


def test_couples_are_sums_over_particles() -> None:
    """A body of four particles in four places, pinned to ground and turning unevenly, about another place."""
    rng = np.random.default_rng(4)
    at, z, mass = rng.normal(size=(4, 2)), rng.normal(size=4), rng.uniform(0.5, 2, 4)
    com, middle = mass @ at / mass.sum(), float(mass @ z / mass.sum())
    products = mass * (z - middle) @ (at - com)
    m = Mechanism("particles")
    inertia = float(mass @ ((at - com) ** 2).sum(axis=1))
    body = m.body("body", mass=float(mass.sum()), com=com.tolist(), inertia=inertia, z=middle, products=products)
    m.revolute("pin", m.ground.at(0.2, 0.1), body.at(0.3, -0.2))
    m.start_moving(body=7.0)
    sol = m.simulate(1.0)
    points = [body.at(*place) for place in at]
    accelerations = np.array([np.stack([(p := sol.place(point)).ax, p.ay], axis=-1) for point in points])
    felt = -np.einsum("p,ptk->tk", mass * (z - 0.25), accelerations)
    shaking = sol.shaking(z=0.25)
    largest = np.abs(felt).max()
    assert np.abs(shaking.my - felt[:, 0]).max() < 1e-10 * largest
    assert np.abs(shaking.mx + felt[:, 1]).max() < 1e-10 * largest
    assert shaking.couple.shape == (len(sol.t), 2)
    assert np.array_equal(pickle.loads(pickle.dumps(sol)).shaking(z=0.25).mx, shaking.mx)


def test_places_move_nothing_and_a_solution_keeps_those_of_its_time() -> None:
    m, flat = two_cylinders(), two_cylinders((0.0, 0.0))
    sol, plain = m.sweep(steps=90), flat.sweep(steps=90)
    assert np.array_equal(sol.q, plain.q)
    assert np.array_equal(sol.wrench, plain.wrench)
    assert not plain.shaking().couple.any()
    before = sol.shaking().mx
    m.change("piston_1", z=0.2)
    assert np.array_equal(sol.shaking().mx, before)
    fresh = two_cylinders((0.2, 0.05))
    assert np.array_equal(m.sweep(steps=90).shaking().mx, fresh.sweep(steps=90).shaking().mx)


def test_places_come_back_from_a_file(tmp_path: Path) -> None:
    m = two_cylinders()
    m.change("crank", products=(0.001, 0.002))
    file = tmp_path / "twin.json"
    m.save(file)
    again = Mechanism.load(file)
    assert (again.bodies["rod_1"].z, again.bodies["crank"].products) == (-0.05, (0.001, 0.002))
    assert again.joints["pin_1"].i.z == -0.05
    saved = file.read_bytes()
    again.save(file)
    assert file.read_bytes() == saved


def test_forces_of_one_plane_are_warned_of_in_two() -> None:
    m = Mechanism("gears")
    first, second = m.body("one", z=0.01), m.body("two", z=0.03)
    for k, body in enumerate((first, second)):
        m.revolute(f"axle_{k}", m.ground.at(0.03 * k, 0), body.origin)
    m.gear_pair("mesh", first.origin, second.origin, radius_i=0.01, radius_j=0.02)
    [finding] = m.check()
    assert "planes z = 0.01 m and z = 0.03 m, and a gear pair acts in one" in str(finding)
    m.change("two", z=0.01)
    assert not m.check()
    assert not two_cylinders().check()


@pytest.mark.parametrize("value", [math.nan, "1", (1.0, 2.0)])
def test_a_place_is_a_number(value: object) -> None:
    m = Mechanism("bad")
    with pytest.raises(ModelError, match="z"):
        m.body("body", z=value)  # pyright: ignore[reportArgumentType]
    body = m.body("body")
    with pytest.raises(ModelError, match="z"):
        body.at(0, 0, z=value)  # pyright: ignore[reportArgumentType]
