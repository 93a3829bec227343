"""sol.force(name) of every registered kind: Newton-Euler, power against work, pairs, rates; and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, harmonic
from mbsd.arrays.reactions import marker_places
from mbsd.model.force import ForceKind
from mbsd.results.forces import force_view
from mbsd.results.measured import Moved
from mbsd.results.solution import Solution
from mbsd.testing import force_kinds
from mbsd.testing.forces import example

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
HALF = 0.0025
"""Half of an interval (s)."""


def unbalanced(sol: Solution) -> float:
    """Largest |M a - weight - wrenches of all forces and joints| of a moving body, of the largest of these."""
    packed, system = sol.packed, sol.packed.system
    q = sol.q.reshape(len(sol.t), -1)
    inertia = np.stack([system.mass, system.mass, system.inertia], axis=1) * sol.a
    weight = np.zeros_like(inertia)
    weight[:, :, :2] = system.mass[:, None] * system.gravity
    left, largest = inertia - weight, max(np.abs(inertia).max(), np.abs(weight).max())

    def add(body: int, point: np.ndarray, wrench: np.ndarray) -> float:
        arm = point - q[:, 3 * body : 3 * body + 2]
        moved = wrench.copy()
        moved[:, 2] += arm[:, 0] * wrench[:, 1] - arm[:, 1] * wrench[:, 0]
        left[:, body] -= moved
        return float(np.abs(moved).max())

    for view in sol.forces.values():
        for k, name in enumerate(view.bodies):
            largest = max(largest, add(packed.body_names.index(name), view.points[:, k], view.wrenches[:, k]))
    for k, joint in enumerate(packed.joints):
        if joint.name in sol.forces:
            continue  # the row that holds a joint at rest gives the friction, which is among the forces
        bodies = system.marker_body[packed.markers[k]]
        point = marker_places(packed, q, packed.markers[k, 1])
        for body, sign in zip(bodies, (-1.0, 1.0), strict=True):
            largest = max(largest, add(int(body), point, sign * sol.wrench[:, k]))
    return float(np.abs(left[:, 1:]).max() / largest)


def run(kind: ForceKind, seed: int, to_ground: bool) -> Solution:
    """A simulation of 0.02 s of the example, with outputs at the nodes of Gauss' rule in 4 intervals."""
    m, _packed = example(kind, seed, to_ground)
    random = np.random.default_rng(seed + 9)
    if len(m.joints) == 0:
        for name in list(m.bodies)[1:]:
            m.start_near(**{name: (*random.normal(size=2), 40.0 * random.normal())})
    m.start_moving(second=random.normal() if m.joints else list(random.normal(size=3)))
    times = np.linspace(0.0, 0.02, 5)[:-1, None] + HALF * (NODES + 1)
    return m.simulate(times=[0.0, *times.ravel(), 0.02], tolerance=1e-11)


@pytest.mark.filterwarnings("ignore::mbsd.ModelWarning")
@pytest.mark.filterwarnings("ignore::mbsd.InitialConditionWarning")
@pytest.mark.parametrize("to_ground", [False, True], ids=["two_bodies", "to_ground"])
@pytest.mark.parametrize("kind", force_kinds(), ids=lambda kind: kind.name)
def test_every_kind_fulfils_newton_euler_and_its_power_is_the_work(kind: ForceKind, to_ground: bool) -> None:
    sol = run(kind, 3, to_ground)
    [view] = sol.forces.values()
    assert view.kind == kind.name
    assert np.abs(view.wrenches).max() > 0, "an example that does nothing proves nothing"
    assert unbalanced(sol) < 1e-9
    assert sol.work is not None
    work = float(view.power[1:-1] @ np.tile(HALF * WEIGHTS, 4))
    kinks = view.measures == "gap" or kind.mesh is not None  # a foot between pieces of a profile, flanks that part
    assert work == pytest.approx(sol.work[-1] - sol.work[0], rel=1e-3 if kinks else 1e-6, abs=1e-8)
    speeds = np.zeros_like(view.power)
    q, v = sol.q, sol.v
    for k, name in enumerate(view.bodies):
        b = sol.packed.body_names.index(name)
        arm = view.points[:, k] - q[:, b, :2]
        at = v[:, b, :2] + v[:, b, 2:] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        speeds += (view.wrenches[:, k, :2] * at).sum(axis=1) + view.wrenches[:, k, 2] * v[:, b, 2]
    np.testing.assert_allclose(view.power, speeds, atol=1e-10 * max(1.0, np.abs(view.wrenches).max()))
    if not kind.outside:  # the second body feels the opposite of the first
        assert len(view.bodies) == 2
        moment = view.wrenches[..., 2] + view.points[..., 0] * view.wrenches[..., 1]
        moment -= view.points[..., 1] * view.wrenches[..., 0]
        size = np.abs(view.wrenches).max()
        np.testing.assert_allclose(view.wrenches[..., :2].sum(axis=1), 0.0, atol=1e-12 * size)
        np.testing.assert_allclose(moment.sum(axis=1), 0.0, atol=1e-10 * size)


@pytest.mark.filterwarnings("ignore::mbsd.ModelWarning")
@pytest.mark.filterwarnings("ignore::mbsd.InitialConditionWarning")
@pytest.mark.parametrize("kind", force_kinds(), ids=lambda kind: kind.name)
def test_measured_values_have_their_rates_and_push_by_their_efforts(kind: ForceKind) -> None:
    sol = run(kind, 5, False)
    [view] = sol.forces.values()
    if view.value is not None:
        assert view.rate is not None
        assert view.measures is not None
        np.testing.assert_array_equal(getattr(view, view.measures), view.value)
        q, v = (part.reshape(len(sol.t), -1) for part in (sol.q, sol.v))
        after, before = (
            force_view(Moved(sol.packed, sol.t, q + h * v, v, sol.lam, None, (0.0, 0.02), 0.0 * v), view.name).value
            for h in (1e-6, -1e-6)
        )
        assert after is not None
        assert before is not None
        np.testing.assert_allclose(view.rate, (after - before) / 2e-6, atol=1e-7 * max(1.0, np.abs(v).max()))
    for other in {"length", "angle", "coordinate", "gap"} - {view.measures}:
        with pytest.raises(ModelError, match=f"force 'example' .*(has an? |measures no).*not an? {other}"):
            getattr(view, other)
    if view.effort is not None and view.measures != "gap":
        np.testing.assert_allclose(view.effort * view.rate, view.power, atol=1e-9 * np.abs(view.power).max())
    columns = sol.columns()
    assert f"{view.name}.power [W]" in columns
    assert all(column.shape == sol.t.shape for column in columns.values())


def test_a_spring_and_damper_by_hand() -> None:
    """k 200 N/m, c 3 N s/m, free 0.5 m, between (-1, 0) and a cart that is driven along x."""
    m = Mechanism("cart", gravity=None)
    cart = m.body("cart", 2.0)
    m.prismatic("rail", m.ground.origin, cart.origin)
    m.spring("spring", m.ground.at(-1.0, 0), cart.at(0.1, 0.0), 200.0, damping=3.0, free_length=0.5)
    m.drive_coordinate("hand", m.ground.origin, cart.origin, harmonic(0.2, 5.0))
    sol = m.sweep(1.0, steps=50)
    view, x, speed = sol.force("spring"), sol.body("cart").x, sol.body("cart").vx
    expected = -200.0 * (x + 1.1 - 0.5) - 3.0 * speed
    np.testing.assert_allclose(view.length, x + 1.1)
    np.testing.assert_allclose(view.rate, speed, atol=1e-14)
    np.testing.assert_allclose(view.effort, expected)
    np.testing.assert_allclose(view.force, np.stack([expected, 0 * x], axis=1), atol=1e-12)
    np.testing.assert_allclose(view.magnitude, np.abs(expected))
    np.testing.assert_allclose(view.power, expected * speed)
    np.testing.assert_allclose(view.potential, 100.0 * (x + 0.6) ** 2)
    np.testing.assert_allclose([view.x, view.y, view.torque], [x + 0.1, 0 * x, 0 * x], atol=1e-12)
    first = view.on("ground")
    np.testing.assert_allclose([first.x, first.y, first.fx], [0 * x - 1.0, 0 * x, -expected])
    assert view.bodies == ("ground", "cart")
    assert unbalanced(sol) < 1e-12
    with pytest.raises(ModelError, match="'spring' does not act on 'rail'; it acts on: ground, cart"):
        view.on("rail")
    with pytest.raises(ModelError, match="cart: there is no force 'sprung', did you mean 'spring'"):
        sol.force("sprung")


@pytest.mark.parametrize("formulation", ["reference", "independent"])
def test_both_formulations_and_other_times_give_the_same_forces(formulation: str) -> None:
    m = Mechanism("linkage")
    arm, rod = m.bar("arm", 0.4, mass=1.0), m.bar("rod", 0.5, mass=0.5)
    m.revolute("A", m.ground.origin, arm.start)
    m.revolute("B", arm.end, rod.start)
    m.spring("spring", m.ground.at(0.6, 0.1), rod.at(0.4, 0.1), lambda t: 80.0 + 20.0 * math.sin(9 * t), 2.0, 0.3)
    if formulation == "reference":
        m.friction("rub", "A", 0.2, radius=0.03, preload=5.0)
    m.user_force("own", lambda t, q, v: (0.0, 0.3, 0.1, 1.0, 0.0, -0.2 * v[5]), arm, rod)
    m.start_near(arm=-30, rod=10)
    sol = m.simulate(0.5, steps=20, tolerance=1e-10, formulation=formulation)
    assert sol.stats.independent == (formulation == "independent")
    assert unbalanced(sol) < 1e-9
    once = sol.at(sol.t[[7]])
    assert unbalanced(once) < 1e-9
    for name, view in sol.forces.items():
        np.testing.assert_allclose(once.force(name).wrenches[0], view.wrenches[7], rtol=1e-7, atol=1e-7)
        np.testing.assert_allclose(once.force(name).power[0], view.power[7], rtol=1e-7, atol=1e-7)
    with pytest.raises(
        ModelError, match=r"'own' \(user_force\) acts on arm, rod and has no second body; ask .*on\(body"
    ):
        _ = sol.force("own").force
    np.testing.assert_array_equal(sol.force("own").on("arm").fy, 0.3)


def test_later_changes_of_the_model_are_not_in_the_solution() -> None:
    m = Mechanism("hung")
    block = m.body("block", 2.0, inertia=0.1)
    m.spring("spring", m.ground.at(0, 1.0), block.origin, 100.0)
    sol = m.simulate(0.2, steps=4)
    before = sol.force("spring").effort
    m.change("spring", stiffness=7.0)
    np.testing.assert_array_equal(sol.force("spring").effort, before)


def test_a_joint_that_was_let_go_has_no_friction_and_one_that_sticks_keeps_what_holds_it() -> None:
    m = Mechanism("drop")
    arm, rod = m.bar("arm", 0.5, mass=1.0), m.bar("rod", 0.3, mass=0.4)
    m.revolute("A", m.ground.origin, arm.start)
    m.revolute("B", arm.end, rod.start)
    m.friction("rusty", "A", 0.8, radius=0.2, preload=40.0, sticks=True)
    m.friction("rub", "B", 0.3, radius=0.02, preload=20.0, viscous=0.01)
    m.start_near(arm=-20, rod=-60)
    m.event("breaks", lambda t, now: t - 0.3, action=lambda now: now.release("B"))
    sol = m.simulate(0.6, steps=60)
    broken, rub = sol.t > 0.3, sol.force("rub").effort
    assert rub is not None
    assert np.abs(rub[1:30]).min() > 0.1
    np.testing.assert_array_equal(sol.force("rub").wrenches[broken], 0.0)
    np.testing.assert_array_equal(sol.friction("rub").force[broken], 0.0)
    assert unbalanced(sol) < 1e-9
    assert np.ptp(sol.body("arm").theta) < 1e-12
    lever = 0.25 * np.cos(sol.body("arm").theta[broken]) * 9.80665
    np.testing.assert_allclose(sol.force("rusty").torque[broken], lever, rtol=1e-8)


def test_an_equilibrium_and_efforts_of_inverse_dynamics() -> None:
    m = Mechanism("scale")
    pan = m.body("pan", 3.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0, math.pi / 2), pan.at(0, 0, math.pi / 2))
    m.spring("spring", m.ground.at(0, 1.0), pan.origin, 500.0, free_length=0.4)
    rest = m.equilibrium().force("spring")
    assert float(rest.fy) == pytest.approx(3.0 * 9.80665)
    assert float(rest.length) == pytest.approx(0.4 + 3.0 * 9.80665 / 500.0)
    assert float(rest.effort) == pytest.approx(-3.0 * 9.80665)
    assert float(rest.on("ground").fy) == pytest.approx(-3.0 * 9.80665)

    m.actuator("jack", m.ground.at(0, -1), pan.origin, 5.0)
    m.drive_coordinate("hand", m.ground.at(0, 0, math.pi / 2), pan.at(0, 0, math.pi / 2), harmonic(0.1, 4.0))
    sweep = m.sweep(1.0, steps=20)
    np.testing.assert_allclose(sweep.force("jack").effort, 5.0)
    moved = m.inverse_dynamics(sweep, ["jack"])
    np.testing.assert_array_equal(moved.solution.force("jack").effort, moved.efforts["jack"])
    assert unbalanced(sweep) < 1e-12
    assert unbalanced(moved.solution) < 1e-12
    np.testing.assert_allclose(moved.efforts["jack"] - 5.0, sweep.driver("hand").force, atol=1e-9)


def test_a_failing_function_is_named() -> None:
    m = Mechanism("odd", gravity=None)
    body = m.body("body", 1.0, inertia=1.0)
    good = True
    m.user_force("own", lambda t, q, v: (1.0, 0.0, 0.0 if good else math.nan), body)
    sol = m.simulate(0.1, steps=2)
    good = False
    with pytest.raises(ModelError, match="odd: force 'own'"):
        sol.force("own")
