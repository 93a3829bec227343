"""Springs and dampers whose numbers are laws of time: Mathieu's equation, closed forms, energy, files."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numba.core import event
from scipy.special import mathieu_a, mathieu_cem

from mbsd import Mechanism, ModelError, harmonic, table
from mbsd.model.laws import Motion, polynomial

M = 2.0


def block(**spring: object) -> Mechanism:
    """2 kg on a rail along x, tied to a point 3 m to the left of the origin, at 1 m and still."""
    m = Mechanism("block", gravity=None)
    body = m.body("block", M)
    m.prismatic("rail", m.ground.origin, body.origin)
    m.spring("spring", m.ground.at(-3.0, 0.0), body.origin, **spring)
    m.start_near(block=(1.0, 0, 0))
    return m


def wheel(**spring: object) -> Mechanism:
    m = Mechanism("wheel", gravity=None)
    body = m.body("wheel", M, (0.0, 0.0), M)
    m.revolute("axle", m.ground.origin, body.origin)
    m.torsion_spring("spring", m.ground, body, **spring)
    m.start_near(wheel=math.degrees(1.0))
    return m


def mathieu(order: int, q: float) -> tuple[Motion, float]:
    """A stiffness k(t) by which M x'' + k x = 0 has the even Mathieu function of this order, and its value at 0."""
    return harmonic(-2 * q * M, 2.0, math.pi / 2, M * float(mathieu_a(order, q))), float(mathieu_cem(order, q, 0.0)[0])


@pytest.mark.parametrize(("order", "q"), [(0, 0.8), (1, 2.0), (3, 1.5)])
def test_a_stiffness_in_time_gives_functions_of_mathieu(order: int, q: float) -> None:
    """Where the stiffness is below zero the spring pushes away; the periodic solutions know of it."""
    law, start = mathieu(order, q)
    t = np.linspace(0.0, math.pi, 41)
    for sol, x in (
        (block(stiffness=law, free_length=3.0).simulate(times=t, tolerance=1e-11), lambda s: s.body("block").x),
        (wheel(stiffness=law).simulate(times=t, tolerance=1e-11), lambda s: s.body("wheel").theta),
    ):
        np.testing.assert_allclose(x(sol), mathieu_cem(order, q, np.degrees(t))[0] / start, atol=1e-7)
        assert sol.audit is not None
        assert np.ptp(sol.audit) < 1e-7
        np.testing.assert_allclose(sol.energy.potential, 0.0)


def test_a_damping_in_time_stops_by_its_integral() -> None:
    """M v' = -c(t) v with c = 3 t: v = v0 exp(-3 t^2 / 2 M)."""
    m = block(stiffness=0.0, damping=polynomial(0.0, 3.0))
    m.start_moving(block=(0.4, 0, 0))
    sol = m.simulate(2.0, steps=20, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("block").vx, 0.4 * np.exp(-1.5 * sol.t**2 / M), atol=1e-9)
    m = wheel(stiffness=0.0, damping=polynomial(0.0, 3.0))
    m.start_moving(wheel=0.4)
    np.testing.assert_allclose(
        m.simulate(2.0, steps=20, tolerance=1e-10).body("wheel").omega, 0.4 * np.exp(-1.5 * sol.t**2 / M), atol=1e-9
    )


@pytest.mark.parametrize("build", [block, wheel])
def test_a_free_value_in_time_drives_an_oscillator(build) -> None:
    """M x'' + k x = k l(t), l = a sin w t: at rest at 1 with l = 1 + ... the sum of free and forced swings."""
    k, a, w = 50.0, 0.3, 3.0
    own = math.sqrt(k / M)
    rest = 4.0 if build is block else 1.0
    free = {"free_length" if build is block else "free_angle": harmonic(a, w, 0.0, rest)}
    sol = build(stiffness=k, **free).simulate(2.0, steps=40, tolerance=1e-11)
    forced = a / (1 - (w / own) ** 2)
    expected = 1.0 + forced * (np.sin(w * sol.t) - w / own * np.sin(own * sol.t))
    name, field = ("block", "x") if build is block else ("wheel", "theta")
    np.testing.assert_allclose(getattr(sol.body(name), field), expected, atol=1e-8)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-7


def test_a_law_that_stands_still_is_its_number() -> None:
    still = {"stiffness": 40.0, "damping": 2.0, "free_length": 3.5}
    expected = block(**still).simulate(1.0, steps=20, tolerance=1e-11).body("block").x
    for name, value in still.items():
        sol = block(**still | {name: polynomial(value)}).simulate(1.0, steps=20, tolerance=1e-11)
        np.testing.assert_allclose(sol.body("block").x, expected, atol=1e-9)


def test_laws_are_changed_saved_and_used_in_statics(tmp_path: Path) -> None:
    m = block(stiffness=40.0, free_length=3.5)
    assert m.equilibrium().body("block").x == pytest.approx(0.5)
    m.change("spring", free_length=polynomial(3.5, 0.2))
    assert m.equilibrium(time=2.0).body("block").x == pytest.approx(0.9)
    m.simulate(0.1, steps=2)
    with event.install_recorder("numba:compile") as compiled:
        m.change("spring", free_length=table([0, 1, 2, 3, 4, 5], [3.5, 3.6, 3.8, 3.7, 3.6, 3.5]))
        m.simulate(0.1, steps=2)
    assert not compiled.buffer
    m.save(tmp_path / "block.json")
    loaded = Mechanism.load(tmp_path / "block.json")
    assert set(loaded.forces["spring"].laws) == {"free_length"}
    assert loaded.forces["spring"].params == {"stiffness": 40.0, "damping": 0.0}
    m.draw().save(tmp_path / "block.svg")


def test_invalid_requests_are_refused() -> None:
    with pytest.raises(ModelError, match="block: force 'spring': stiffness and free_length are both laws of time"):
        block(stiffness=lambda t: 1.0 + t, free_length=lambda t: 1.0 - t)
    with pytest.raises(ModelError, match="force 'spring': damping is -1; it cannot be negative"):
        block(stiffness=lambda t: 1.0 + t, damping=-1.0)
    with pytest.raises(ModelError, match="force 'spring': stiffness is 'soft'; it must be a number"):
        block(stiffness="soft")
