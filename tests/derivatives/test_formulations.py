"""Tangents of runs of added formulations, q' = N(q) v: a body in space with Euler parameters, and a point on a rod.

Compared with closed forms, with differences of whole runs, and in the plane with ``m.sensitivities``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbsd import Mechanism, ModelError
from mbsd.compiling.callback import SIGNATURE
from mbsd.compiling.jit import apart, at_address, internal
from mbsd.derivatives.formulations import Parameter, Run, run_tangents
from mbsd.dynamics.events.packing import contacts_of
from mbsd.dynamics.formulation import add_formulation
from mbsd.dynamics.integrators.kind import INTEGRATORS
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.state import TIME, Settings, start_state
from tests.derivatives.test_near_toggles import whip
from tests.dynamics.rigid_body import Flight, RigidBody, entries, watched

INERTIA = np.array([0.3, 0.5, 0.7])
CORNER = np.array([0.3, -0.2, 0.4])
START = np.array([0.1, -0.2, 2.0, 0.5, 0.5, -0.5, 0.5])
RATES = np.array([0.5, 0.3, 1.0, 0.1, 6.0, 0.2])
SLOW = np.array([0.5, 0.3, 0.0, 0.1, 0.4, 0.2])
DOP853 = INTEGRATORS["dop853"]
WEIGHTS = {-2.0: 1 / 12, -1.0: -8 / 12, 1.0: 8 / 12, 2.0: -1 / 12}


def slope(function: Callable[[float], np.ndarray], h: float) -> np.ndarray:
    """Central difference of fourth order at zero."""
    return np.sum([weight * function(k * h) for k, weight in WEIGHTS.items()], axis=0) / h


def of_start(name: str, q: int = -1, v: int = -1) -> Parameter:
    """A coordinate or a velocity of the body's start."""
    return Parameter(name, np.eye(7)[q] * (q >= 0), np.eye(6)[v] * (v >= 0))


def pulled(flight: Flight, gravity: float) -> RigidBody:
    """The body under another gravity (m/s^2)."""
    weight = flight.dyn.weight.copy()
    weight[5] = -2.0 * gravity
    return flight.dyn._replace(weight=weight)


def cornered(flight: Flight, corner: np.ndarray) -> RigidBody:
    """The body with another corner (m)."""
    return flight.dyn._replace(corner=corner)


def run_of(flight: Flight, q: np.ndarray, v: np.ndarray) -> Run:
    """A flight without contact."""
    flight.dyn.schur.rows[...] = -1
    start = start_state(entries(q, v), 1, 0.0)
    return Run(DOP853, flight.dyn, flight.scratch, flight.settings(1e-12, 1e-3), start, 6)


def point_of(q: np.ndarray, point: np.ndarray) -> np.ndarray:
    """(3,) place (m) of a point (3,) of the body, of q (7,)."""
    return q[:3] + Rotation.from_quat(q[[4, 5, 6, 3]]).as_matrix() @ point


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the product of two quaternions (4,), real or complex."""
    return np.concatenate([[a[0] * b[0] - a[1:] @ b[1:]], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def turn(vector: np.ndarray) -> np.ndarray:
    """The quaternion of a rotation vector (rad)."""
    size = np.sqrt(vector @ vector)
    return np.concatenate([[np.cos(size / 2)], np.sin(size / 2) / size * vector])


def symmetric_top(t: float, e: np.ndarray, w: np.ndarray, inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """e, w of a free symmetric top: it turns about its angular momentum, and spins about its axis."""
    spin = np.array([0.0, 0.0, w[2] * (1.0 - inertia[2] / inertia[0])])
    turning = np.concatenate([[0.0], w - spin])  # L / I_1 in the body's axes
    back = e * [1, -1, -1, -1]
    steady = product(product(e, turning), back)[1:]
    now = product(product(turn(t * steady), e), turn(t * spin))
    there = turn(-t * spin)
    return now, product(product(there, turning), there * [1, -1, -1, -1])[1:] + spin


def test_changes_of_a_symmetric_top_are_those_of_its_closed_form() -> None:
    """By its start, and by moments of inertia; complex steps differentiate the closed form."""
    inertia, e, w, t = np.array([0.3, 0.3, 0.7]), START[3:], np.array([0.4, 0.1, 6.0]), 1.3
    flight = Flight(DOP853, inertia, CORNER)
    h = 1e-4

    def heavier(by: float) -> RigidBody:
        more = inertia + np.array([0.0, 0.0, by])
        return flight.dyn._replace(
            inertia=np.concatenate([flight.dyn.inertia[:6], more, [0.0]]),
            inverse=np.concatenate([flight.dyn.inverse[:6], 1.0 / more, [0.0]]),
        )

    turned = 0.5 * product(e, np.array([0.0, 1.0, 0.0, 0.0]))
    every = [
        Parameter("inertia", np.zeros(7), np.zeros(6), heavier(-h), heavier(h), h),
        Parameter("turn", np.concatenate([np.zeros(3), turned]), np.zeros(6)),
        of_start("w_x", v=3),
        of_start("w_z", v=5),
    ]
    tangents = run_tangents(run_of(flight, START, np.concatenate([np.zeros(3), w])), t, [0.3, 0.7, t], every)
    assert tangents.error < 1e-5
    step = 1e-30j
    for row, time in enumerate([0.3, 0.7, t]):
        exact = [
            symmetric_top(time, e, w, inertia + np.array([0, 0, step])),
            symmetric_top(time, e + step * turned, w, inertia),
            symmetric_top(time, e, w + np.array([step, 0, 0]), inertia),
            symmetric_top(time, e, w + np.array([0, 0, step]), inertia),
        ]
        for p, (attitude, rates) in enumerate(exact):
            assert np.abs(tangents.q[p, row, 3:] - attitude.imag / 1e-30).max() < 1e-8
            assert np.abs(tangents.v[p, row, 3:] - rates.imag / 1e-30).max() < 1e-8
    size = (tangents.q[:, :, 3:] * tangents.y[:, 0, 6:]).sum(axis=2)
    assert np.abs(size).max() < 1e-9  # Euler parameters stay a unit
    assert np.allclose(tangents.end_q, tangents.q[:, -1], rtol=0.0, atol=1e-12)


def bouncing(flight: Flight, q: np.ndarray, v: np.ndarray, events: Any = None) -> Run:
    """A flight that strikes the plane."""
    run = run_of(flight, q, v)
    contacts = flight.contacts(run.start)
    return replace(run, contacts=contacts if events is None else contacts._replace(events=events))


def end_of(corner: np.ndarray, restitution: float, q: np.ndarray, v: np.ndarray, end: float) -> np.ndarray:
    """(13,) q, v at the end of a whole run."""
    y = Flight(DOP853, INERTIA, corner, restitution).bounce(q, v, end)[2]
    return np.concatenate([y[0, 3:], y[1, 3:9]])


def test_a_bounce_of_a_point_is_that_of_its_closed_form() -> None:
    """z falls from h, meets the plane at t = sqrt(2 h / g) and leaves it with e g t."""
    height, restitution, gravity, end = 1.2, 0.7, 9.81, 0.9
    flight = Flight(DOP853, INERTIA, np.zeros(3), restitution)
    start = np.concatenate([[0.0, 0.0, height], START[3:]])
    run = bouncing(flight, start, np.array([0.3, 0.0, 0.0, 1.0, 2.0, 3.0]))
    h = 1e-4
    sides = tuple(Flight(DOP853, INERTIA, np.zeros(3), restitution + by).contacts(run.start) for by in (-h, h))
    every = [
        of_start("z", q=2),
        Parameter("restitution", np.zeros(7), np.zeros(6), step=h, contacts=sides),
        Parameter("gravity", np.zeros(7), np.zeros(6), *(pulled(flight, gravity + by) for by in (-h, h)), h),
    ]
    tangents = run_tangents(run, end, [0.2, 0.8, end], every)

    def flies(t: float, h: complex, e: complex, g: complex) -> tuple[complex, complex]:
        met = np.sqrt(2 * h / g)
        if t < met.real:
            return h - g * t**2 / 2, -g * t
        return e * g * met * (t - met) - g * (t - met) ** 2 / 2, e * g * met - g * (t - met)

    [met] = tangents.events
    assert met.moved == pytest.approx([1 / np.sqrt(2 * height * gravity), 0.0, -met.t / 2 / gravity], abs=1e-8)
    for row, t in enumerate(tangents.t):
        for p, by in enumerate(np.eye(3) * 1e-30j):
            z, w = flies(t, *(np.array([height, restitution, gravity]) + by))
            assert tangents.q[p, row, 2] == pytest.approx(z.imag / 1e-30, abs=1e-7)
            assert tangents.v[p, row, 2] == pytest.approx(w.imag / 1e-30, abs=1e-7)


@pytest.mark.parametrize(("restitution", "rates", "end"), [(0.8, RATES, 1.5), (0.0, SLOW, 0.9)])
def test_changes_beyond_impacts_of_a_turning_body_are_those_of_whole_runs(
    restitution: float, rates: np.ndarray, end: float
) -> None:
    """It bounces several times, or its corner stays on the plane."""
    flight, h = Flight(DOP853, INERTIA, CORNER, restitution), 1e-4
    run, side = bouncing(flight, START, rates), np.array([1.0, 0.0, 0.0])
    every = [
        of_start("z", q=2),
        of_start("w_y", v=4),
        Parameter("corner", np.zeros(7), np.zeros(6), *(cornered(flight, CORNER + by * side) for by in (-h, h)), h),
    ]
    tangents = run_tangents(run, end, np.linspace(0.0, end, 91), every)
    assert len(tangents.events) >= 1
    z, w = np.eye(7)[2], np.eye(6)[4]
    truth = [
        slope(lambda by: end_of(CORNER, restitution, START + by * z, rates, end), 2e-4),
        slope(lambda by: end_of(CORNER, restitution, START, rates + by * w, end), 2e-4),
        slope(lambda by: end_of(CORNER + by * side, restitution, START, rates, end), 2e-4),
    ]
    assert np.abs(np.concatenate([tangents.end_q, tangents.end_v], axis=1) - truth).max() < 1e-5 * np.abs(truth).max()
    if restitution == 0.0:
        on_plane = [row for row, y in enumerate(tangents.y) if abs(point_of(y[0, 3:], CORNER)[2]) < 1e-10]
        assert len(on_plane) > 3
        for row in on_plane:  # the corner stays where it is while numbers of the start change
            moved = [point_of(tangents.y[row, 0, 3:] + by * tangents.q[0, row], CORNER)[2] for by in (1e-6, -1e-6)]
            assert abs(moved[0] - moved[1]) < 1e-13


@at_address(SIGNATURE)
def fallen(t, inputs, outputs):
    """Put out how far a point is above 0.7 m."""
    outputs[0] = inputs[2] - 0.7


def test_functions_of_the_user_get_points_of_an_added_formulation() -> None:
    """The event is where a point of the body is at 0.7 m, and its time moves with the start."""
    point, flight = np.array([-0.1, 0.2, 0.3]), Flight(DOP853, INERTIA, CORNER)
    run = bouncing(flight, START, RATES, watched(point, fallen.address, ends=True))
    z, w = np.eye(7)[2], np.eye(6)[4]
    tangents = run_tangents(run, 1.5, [0.1, 0.2], [of_start("z", q=2), of_start("w_y", v=4)])
    assert point_of(tangents.end.y[0, 3:], point)[2] == pytest.approx(0.7, abs=1e-11)

    def ends(by: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        own = bouncing(Flight(DOP853, INERTIA, CORNER), START + by * q, RATES + by * v, run.contacts.events)
        end = run_tangents(own, 1.5, [], []).end
        return np.concatenate([[end.clock[TIME]], end.y[0, 3:], end.y[1, 3:9]])

    truth = np.array([slope(lambda by: ends(by, z, 0 * w), 2e-4), slope(lambda by: ends(by, 0 * z, w), 2e-4)])
    [met] = tangents.events
    assert np.abs(met.moved - truth[:, 0]).max() < 1e-7
    assert np.abs(np.concatenate([tangents.end_q, tangents.end_v], axis=1) - truth[:, 1:]).max() < 1e-6


@at_address(SIGNATURE)
def thrown_up(t, inputs, outputs):
    """Put out the velocity of a point as it was, but upwards, and the faster the farther it is aside."""
    outputs[0] = inputs[3]
    outputs[1] = inputs[4]
    outputs[2] = abs(inputs[5]) * (1.0 + 0.1 * inputs[0])


def test_actions_of_the_user_move_points_and_are_differentiated() -> None:
    """Wherever a point of the body comes down to 0.7 m it is thrown up."""
    point, end = np.array([-0.1, 0.2, 0.3]), 0.9

    def thrown(q: np.ndarray, v: np.ndarray) -> Run:
        events = watched(point, fallen.address, action=thrown_up.address)
        return bouncing(Flight(DOP853, INERTIA, CORNER), q, v, events)

    z, w = np.eye(7)[2], np.eye(6)[4]
    tangents = run_tangents(thrown(START, RATES), end, [], [of_start("z", q=2), of_start("w_y", v=4)])
    assert tangents.events

    def ends(by: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        state = run_tangents(thrown(START + by * q, RATES + by * v), end, [], []).end
        return np.concatenate([state.y[0, 3:], state.y[1, 3:9]])

    truth = np.array([slope(lambda by: ends(by, z, 0 * w), 2e-4), slope(lambda by: ends(by, 0 * z, w), 2e-4)])
    assert np.abs(np.concatenate([tangents.end_q, tangents.end_v], axis=1) - truth).max() < 1e-6 * np.abs(truth).max()


class Skate(NamedTuple):
    """A blade that turns, and goes along itself ever faster: x' = u cos(theta), y' = u sin(theta), u' = push."""

    push: float
    inertia: Any
    schur: Any
    loads: Any
    per_size: Any


@apart
def push_along(dyn, scratch, t, state, a, lam):
    """See mbsd/dynamics/formulation.py."""
    a[3] = dyn.push
    a[4] = 0.0
    return 0.0


@apart
def close_nothing(dyn, scratch, t, state, passes):
    """See mbsd/dynamics/formulation.py."""
    scratch.report[1] = 0.0
    scratch.report[2] = 0.0


@internal
def go_along(dyn, q, v, out):
    """See mbsd/dynamics/formulation.py."""
    out[3] = v[3] * math.cos(q[5])
    out[4] = v[3] * math.sin(q[5])
    out[5] = v[4]


add_formulation(Skate, accelerate=push_along, project=close_nothing, rates=go_along)


def test_more_places_are_reached_than_there_are_velocities() -> None:
    """A constraint of velocities alone leaves three changes of places: all three begin, and all three are carried."""
    flight, h, end = Flight(DOP853, INERTIA, CORNER), 1e-4, 1.5
    skate = Skate(0.5, np.zeros(6), flight.dyn.schur, flight.dyn.loads, np.ones(6))
    scratch: Any = scratch_for(skate, flight.ready.packed.ws, 0, DOP853.stages)  # pyright: ignore[reportArgumentType]
    numbers = np.array([0.2, 0.3, 0.4, 0.6, 1.1, 0.5])  # x, y, theta, u, omega, push
    start = start_state(np.array([[0, 0, 0, 0.2, 0.3, 0.4], [0, 0, 0, 0.6, 1.1, 0.0]]), 1, 0.0)
    every = np.full((2, 6), 1e-12)
    settings = Settings(every, 1e-12, every.copy(), 0.2, 1e-14, 1e-3, np.zeros(0))
    tangents = run_tangents(
        Run(DOP853, skate, scratch, settings, start, 2),
        end,
        [0.4, end],
        [
            *(Parameter(name, np.eye(3)[k], np.zeros(2)) for k, name in enumerate(["x", "y", "theta"])),
            *(Parameter(name, np.zeros(3), np.eye(2)[k]) for k, name in enumerate(["u", "omega"])),
            Parameter("push", np.zeros(3), np.zeros(2), skate._replace(push=0.5 - h), skate._replace(push=0.5 + h), h),
        ],
    )

    def glides(t: float, numbers: np.ndarray) -> np.ndarray:
        x, y, theta, u, omega, push = numbers
        way = np.array([x, y]) + 0j
        for sign, at in ((1.0, t), (-1.0, 0.0)):
            c, s, fast = np.cos(theta + omega * at), np.sin(theta + omega * at), u + push * at
            way += sign * np.array([fast * s / omega + push * c / omega**2, -fast * c / omega + push * s / omega**2])
        return np.array([*way, theta + omega * t, u + push * t, omega])

    for row, t in enumerate([0.4, end]):
        for p, by in enumerate(np.eye(6) * 1e-30j):
            exact = glides(t, numbers + by).imag / 1e-30
            assert np.abs(np.concatenate([tangents.q[p, row], tangents.v[p, row]]) - exact).max() < 1e-9


def resting(flight: Flight) -> np.ndarray:
    """The start with the corner on the plane."""
    return START - np.eye(7)[2] * point_of(START, CORNER)[2]


def test_starts_in_contact_have_derivatives_that_keep_it_alone() -> None:
    flight = Flight(DOP853, INERTIA, CORNER, 0.0)
    at, still = resting(flight), np.zeros(6)
    tangents = run_tangents(bouncing(flight, at, still), 0.1, [], [of_start("x", q=0)])
    assert tangents.end_q[0] == pytest.approx(np.eye(7)[0], abs=1e-9)
    with pytest.raises(ModelError, match="no derivative by 'z': it opens contact 0"):
        run_tangents(bouncing(flight, at, still), 0.1, [], [of_start("z", q=2)])
    with pytest.raises(ModelError, match="begins with an impact"):
        run_tangents(bouncing(flight, at, -np.eye(6)[2]), 0.1, [], [of_start("x", q=0)])


def test_what_has_no_derivatives_raises_an_error() -> None:
    flight = Flight(DOP853, INERTIA, CORNER)
    run = bouncing(flight, START, RATES, watched(np.zeros(3), fallen.address))
    rough = run.contacts._replace(friction=run.contacts.friction._replace(gap=np.zeros(1, np.int64)))
    with pytest.raises(ModelError, match="friction of contacts"):
        run_tangents(replace(run, contacts=rough), 1.0, [], [])
    events = run.contacts.events._replace(release=np.array([[0, 0, -1, -1, -1, -1, -1]]))
    with pytest.raises(ModelError, match="joints that event 0 releases"):
        run_tangents(replace(run, contacts=run.contacts._replace(events=events)), 1.0, [], [])


def door(stiffness: float = 2.0, restitution: float = 0.4, omega: float = -1.0) -> Mechanism:
    """A rod that falls on a stop."""
    m = Mechanism("door")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.torsion_spring("k", m.ground, rod, stiffness=stiffness, damping=0.3, free_angle=-2.0)
    m.angle_stop("end", m.ground.at(0, 0), rod.start, at=-1.2, restitution=restitution)
    m.start_near(rod=0)
    m.start_moving(rod=omega)
    return m


def test_the_plane_is_the_case_where_rates_are_velocities() -> None:
    """A stop of a mechanism in reference coordinates, as ``m.sensitivities`` knows it."""
    end, h = 0.45, 1e-5
    ready = prepare_dynamics(door(), 0.0, end, contacts=True)
    start = start_state(np.stack([ready.initial.q, ready.initial.v]), len(ready.packed.ws.phi), 0.0)
    scratch = scratch_for(ready.dynamics, ready.packed.ws, 0, DOP853.stages, DOP853.matrices)
    width = start.y.shape[1]
    every = np.full((2, width), 1e-11)
    settings = Settings(every, 1e-11, every.copy(), 0.1, 1e-14, 1e-3, np.zeros(0))

    def beside(**given: float) -> PreparedDynamics:
        return prepare_dynamics(door(**given), 0.0, end, contacts=True)

    def shared(other: PreparedDynamics) -> Any:
        return other.dynamics._replace(schur=ready.dynamics.schur)

    def contacts(of: PreparedDynamics) -> Any:
        return contacts_of(of, start, [], 0.1, DOP853, log=True)

    none = np.zeros(width - 3)
    stiffer = tuple(shared(beside(stiffness=2.0 + by)) for by in (-h, h))
    livelier = tuple(contacts(beside(restitution=0.4 + by)) for by in (-h, h))
    faster = (beside(omega=-1.0 + h).initial.v - beside(omega=-1.0 - h).initial.v)[3:] / (2 * h)
    tangents = run_tangents(
        Run(DOP853, ready.dynamics, scratch, settings, start, width - 3, contacts(ready)),
        end,
        [end],
        [
            Parameter("stiffness", none, none, *stiffer, h),
            Parameter("restitution", none, none, step=h, contacts=livelier),
            Parameter("omega", none, faster),
        ],
    )
    assert len(tangents.events) >= 1
    numbers = ["k.stiffness", "end.restitution", "rod.moving.omega"]
    known = door().sensitivities(["rod.theta", "rod.omega"], numbers, times=[0.0, end])
    assert tangents.q[:, -1, 2] == pytest.approx(known["rod.theta"][-1], rel=1e-6)
    assert np.abs(known["rod.theta"][-1]).min() > 1e-3
    assert tangents.v[:, -1, 2] == pytest.approx(known["rod.omega"][-1], rel=1e-6)


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
def test_a_toggle_of_no_time_leaves_the_changes_of_a_run_their_digits() -> None:
    """Light links that stop a flywheel of 1e5 kg: in their toggle the changes are thousands of times as large."""
    end, h = 0.6, 1e-4

    def ready_for(rod: float = 0.45) -> PreparedDynamics:
        return prepare_dynamics(whip(1e5, rod=rod), 0.0, end, contacts=True)

    ready = ready_for()
    start = start_state(np.stack([ready.initial.q, ready.initial.v]), len(ready.packed.ws.phi), 0.0)
    scratch = scratch_for(ready.dynamics, ready.packed.ws, 0, DOP853.stages, DOP853.matrices)
    width = start.y.shape[1]
    every = np.full((2, width), 1e-11)
    settings = Settings(every, 1e-11, every.copy(), 0.1, 1e-14, 1e-3, np.zeros(0))
    heavier = tuple(ready_for(0.45 + by).dynamics._replace(schur=ready.dynamics.schur) for by in (-h, h))
    none = np.zeros(width - 3)
    run = Run(DOP853, ready.dynamics, scratch, settings, start, width - 3)
    tangents = run_tangents(run, end, [end], [Parameter("rod", none, none, *heavier, h)])
    column = 3 * ready.packed.body_names.index("flywheel") + 2 - 3
    known = whip(1e5).sensitivities("flywheel.omega", "rod.mass", times=[0.0, end], simulate=True, tolerance=1e-11)
    assert tangents.v[0, -1, column] == pytest.approx(known["flywheel.omega"][-1, 0], rel=3e-4)
