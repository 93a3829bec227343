"""Properties of any closed linkage: energy, constraints, balance, objectivity, inverse dynamics."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import assume, given, reject, settings
from hypothesis import strategies as st

from mbsd import Mechanism, SingularPoseError, harmonic, table
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.mechanism import Marker
from mbsd.results.solution import Solution
from tools.random_mechanisms.linkages import Carried, Linkage, linkage

SEEDS = st.integers(0, 10**6)
LOOPS = st.integers(1, 5)


def moving(seed: int, loops: int, damping: bool = False, carried: Carried | None = None) -> Linkage:
    """A linkage that starts with one of its motions, the fastest body at 5 (m/s and rad/s)."""
    made, rng = linkage(seed, loops, damping, carried), np.random.default_rng(seed + 1)
    speeds = {crank.name: float(rng.uniform(-4, 4)) for host, crank in made.cranks if host.name == "ground"}
    made.m.start_moving(**speeds)
    v = prepare_dynamics(made.m, 0.0, 1.0).initial.v.reshape(-1, 3)
    fastest = float(np.linalg.norm(v, axis=1).max())  # enormous near a toggle of the crank; the same however turned
    made.m.start_moving(**{name: speed * 5.0 / fastest for name, speed in speeds.items()})
    return made


@settings(max_examples=40)
@given(seed=SEEDS, loops=LOOPS)
def test_closed_linkages_keep_their_energy_and_stay_closed(seed: int, loops: int) -> None:
    made = moving(seed, loops)
    sol = made.m.simulate(1.0, steps=50, tolerance=1e-10)
    assert sol.mobility.dof == len(made.cranks)
    assert np.ptp(sol.energy.kinetic) > 1e-3
    assert np.ptp(sol.energy.total) < 1e-7 * max(1.0, float(sol.energy.kinetic.max()))
    assert sol.stats.position_residual < 1e-13
    assert sol.stats.velocity_residual < 1e-11 * max(1.0, float(np.abs(sol.v).max()))
    assert sol.stats.acceleration_residual < 1e-9 * max(1.0, float(np.abs(sol.a).max()))


@settings(max_examples=20)
@given(seed=SEEDS, loops=LOOPS, turned=st.floats(-3, 3), moved=st.tuples(st.floats(-3, 3), st.floats(-3, 3)))
def test_a_linkage_carried_off_moves_alike(seed: int, loops: int, turned: float, moved: tuple[float, float]) -> None:
    carried = Carried(turned, moved)
    here = moving(seed, loops, True).m.simulate(0.5, steps=10, tolerance=1e-10)
    there = moving(seed, loops, True, carried).m.simulate(0.5, steps=10, tolerance=1e-10)
    size = 1.0 + math.hypot(*moved)
    np.testing.assert_allclose(there.q[:, 1:, :2], carried.place(here.q[:, 1:, :2]), atol=1e-8 * size)
    np.testing.assert_allclose(there.q[:, 1:, 2], here.q[:, 1:, 2] + turned, atol=1e-7)
    np.testing.assert_allclose(there.energy.kinetic, here.energy.kinetic, atol=1e-6)
    for name in here.mechanism.joints:
        largest = max(1.0, float(here.joint(name).magnitude.max()))
        np.testing.assert_allclose(there.joint(name).reaction, carried(here.joint(name).reaction), atol=1e-6 * largest)


def end_of(sol: Solution, marker: Marker) -> tuple[np.ndarray, np.ndarray]:
    """(T, 2) place and velocity of a marker, from the motion of its body."""
    if marker.body.name == "ground":
        return np.tile([marker.x, marker.y], (len(sol.t), 1)), np.zeros((len(sol.t), 2))
    view = sol.body(marker.body.name)
    c, s = np.cos(view.theta), np.sin(view.theta)
    arm = np.stack([c * marker.x - s * marker.y, s * marker.x + c * marker.y], axis=1)
    turning = view.omega[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    return np.stack([view.x, view.y], axis=1) + arm, np.stack([view.vx, view.vy], axis=1) + turning


def imbalance(sol: Solution, made: Linkage) -> float:
    """Largest violation of Newton's and Euler's laws over all bodies and times, as part of the largest load.

    Everything is summed anew from places, velocities and accelerations: weights, inertia, springs, reactions, efforts.
    """
    m = made.m
    force = {
        name: body.mass * (np.array(m.gravity) - sol.a[:, b, :2]) for b, (name, body) in enumerate(m.bodies.items())
    }
    moment = {name: -body.inertia * sol.a[:, b, 2] for b, (name, body) in enumerate(m.bodies.items())}
    centre = {name: sol.q[:, b, :2] for b, name in enumerate(m.bodies)}
    largest = max(float(np.abs(value).max()) for values in (force, moment) for value in values.values())

    def pull(body: str, place: np.ndarray, push: np.ndarray, torque: np.ndarray) -> None:
        nonlocal largest
        arm = place - centre[body]
        force[body] = force[body] + push
        moment[body] = moment[body] + arm[:, 0] * push[:, 1] - arm[:, 1] * push[:, 0] + torque
        largest = max(largest, float(np.abs(push).max()), float(np.abs(torque).max()))

    none = np.zeros(len(sol.t))
    for spring in made.springs:
        (a, va), (b, vb) = (end_of(sol, marker) for marker in (spring.i, spring.j))
        length = np.hypot(*(b - a).T)
        along = (b - a) / length[:, None]
        rate = ((vb - va) * along).sum(axis=1)
        tension = spring.stiffness * (length - spring.free_length) + spring.damping * rate
        pull(spring.i.body.name, a, tension[:, None] * along, none)
        pull(spring.j.body.name, b, -tension[:, None] * along, none)
    for twist in made.twists:
        i, j = (list(m.bodies).index(body.name) for body in (twist.first, twist.second))
        angle, rate = sol.q[:, j, 2] - sol.q[:, i, 2], sol.v[:, j, 2] - sol.v[:, i, 2]
        torque = twist.stiffness * (angle - twist.free_angle) + twist.damping * rate
        pull(twist.first.name, centre[twist.first.name], np.zeros((len(sol.t), 2)), torque)
        pull(twist.second.name, centre[twist.second.name], np.zeros((len(sol.t), 2)), -torque)
    for name, joint in m.joints.items():
        view = sol.joint(name)
        place = np.stack([view.x, view.y], axis=1)
        pull(joint.j.body.name, place, view.reaction, view.torque)
        pull(joint.i.body.name, place, -view.reaction, -view.torque)
    for name, driver in m.drivers.items():
        effort = sol.driver(name).torque
        pull(driver.j.body.name, centre[driver.j.body.name], np.zeros((len(sol.t), 2)), effort)
        pull(driver.i.body.name, centre[driver.i.body.name], np.zeros((len(sol.t), 2)), -effort)
    left = [float(np.abs(values[name]).max()) for values in (force, moment) for name in m.bodies if name != "ground"]
    return max(left) / largest


def driven(seed: int, loops: int, time: float) -> tuple[Linkage, Solution]:
    """All cranks swing a little against the bodies they are pinned to; linkages that cannot follow are passed over."""
    made, rng = linkage(seed, loops, damping=True), np.random.default_rng(seed + 2)
    for k, (host, crank) in enumerate(made.cranks):
        lies = made.frames[crank.name][2] - made.frames[host.name][2]
        swing, rate, phase = rng.uniform(0.02, 0.08), rng.uniform(4, 9), rng.uniform(-1, 1)
        law = harmonic(swing, rate, phase, lies - swing * math.sin(phase))
        made.m.drive_relative_angle(f"motor{k}", host, crank, law)
    try:
        sol = made.m.sweep(time, steps=300)
    except SingularPoseError:
        reject()
    assume(sol.singularity_margin.min() > 0.02)
    return made, sol


@settings(max_examples=30)
@given(seed=SEEDS, loops=LOOPS)
def test_loads_balance_on_every_body_of_a_moving_linkage(seed: int, loops: int) -> None:
    made = moving(seed, loops, damping=True)
    assert imbalance(made.m.simulate(0.5, steps=20, tolerance=1e-7), made) < 1e-9


@settings(max_examples=20)
@given(seed=SEEDS, loops=LOOPS)
def test_loads_balance_on_every_body_of_a_driven_linkage(seed: int, loops: int) -> None:
    made, sol = driven(seed, loops, 0.5)
    assert imbalance(sol, made) < 1e-9


def released(m: Mechanism, sol: Solution) -> Mechanism:
    """The linkage without its drivers, under their efforts, where the motion begins."""
    free = m.with_efforts(**{name: table(sol.t, sol.driver(name).effort) for name in m.drivers})
    for name in list(m.bodies)[1:]:
        view = sol.body(name)
        free.start_near(**{name: (view.x[0], view.y[0], math.degrees(view.theta[0]))})
        free.start_moving(**{name: (view.vx[0], view.vy[0], view.omega[0])})
    return free


@settings(max_examples=20)
@given(seed=SEEDS, loops=LOOPS)
def test_efforts_of_inverse_dynamics_return_the_motion(seed: int, loops: int) -> None:
    made, sol = driven(seed, loops, 0.3)
    again = released(made.m, sol).simulate(times=sol.t, tolerance=1e-10)
    np.testing.assert_allclose(again.q, sol.q, atol=1e-6)
    speed = max(1.0, float(np.abs(sol.v).max()))
    np.testing.assert_allclose(again.v, sol.v, atol=1e-5 * speed)
    for name in made.m.joints:
        largest = max(1.0, float(sol.joint(name).magnitude.max()))
        np.testing.assert_allclose(again.joint(name).reaction, sol.joint(name).reaction, atol=1e-4 * largest)
