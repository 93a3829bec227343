"""A rigid body in space as a formulation of its own: four Euler parameters change by three rates.

    q = (r, e)      v = (r', w)      r' in the world, w about the body's principal axes, e to the world
    r' = r',        e' = e (0, w) / 2                                                q' = N(q) v
    m r'' = m g + J^T N,    I w' = I w x w + J^T N

A corner of the body at s lies above the plane z = 0, where it may strike: Phi = (r + A(e) s)_z. Entries of a state:
three idle ones, then the seven of q; of v the last one is idle. Functions of the user get places (m) of points of the
body and their velocities (m/s).

Source: Haug 1989, ch. 9 and 11.
"""

from __future__ import annotations

import math
from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from mbsd import Mechanism
from mbsd.compiling.jit import apart, inlined, internal
from mbsd.dynamics.events.arrays import AFTER, PAUSES, Contacts
from mbsd.dynamics.events.loop import JUMPED, run_events
from mbsd.dynamics.events.packing import contacts_of
from mbsd.dynamics.events.user_search import MOST_VALUES
from mbsd.dynamics.events.users import Events, move_frames, read_frames
from mbsd.dynamics.formulation import add_formulation
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.dynamics.state import TIME, Settings, State, output_for, start_state

ENTRIES = 10
NO_TIMES = np.zeros(0)


class RigidBody(NamedTuple):
    """One body as integrators and events read it."""

    corner: Any
    """(3,) s (m)."""
    jac: Any
    """(10,) the row of J."""
    held: Any
    """(10,) scratch: W^-1 J^T."""
    inertia: Any
    """(10,) kg, kg m2; zero for idle entries."""
    inverse: Any
    weight: Any
    per_size: Any
    schur: Any
    """Schur: its rows say whether the corner is held."""
    sliding: Any
    loads: Any
    baumgarte: Any


@internal
def _turned(q, x, y, z, axis):
    """A world component of a vector in body axes."""
    e0, e1, e2, e3 = q[6], q[7], q[8], q[9]
    size = e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3
    if axis == 0:
        out = (e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3) * x + 2 * (e1 * e2 - e0 * e3) * y + 2 * (e1 * e3 + e0 * e2) * z
    elif axis == 1:
        out = 2 * (e1 * e2 + e0 * e3) * x + (e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3) * y + 2 * (e2 * e3 - e0 * e1) * z
    else:
        out = 2 * (e1 * e3 - e0 * e2) * x + 2 * (e2 * e3 + e0 * e1) * y + (e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3) * z
    return out / size


@internal
def _find_row(dyn, q):
    """Fill the row of J: e_z . (r' + A (w x s))."""
    s = dyn.corner
    dyn.jac[5] = 1.0
    dyn.jac[6] = _turned(q, 0.0, -s[2], s[1], 2)
    dyn.jac[7] = _turned(q, s[2], 0.0, -s[0], 2)
    dyn.jac[8] = _turned(q, -s[1], s[0], 0.0, 2)


@internal
def _gamma(dyn, q, v):
    """-e_z . A (w x (w x s))."""
    s = dyn.corner
    a, b, c = v[6], v[7], v[8]
    x, y, z = b * s[2] - c * s[1], c * s[0] - a * s[2], a * s[1] - b * s[0]
    return -_turned(q, b * z - c * y, c * x - a * z, a * y - b * x, 2)


@internal
def _push_by_row(dyn, force, gamma, a):
    """Accelerations a (10,) under a force, of which J^T lam is taken, with J a = gamma where the row holds; lam."""
    lam = 0.0
    if dyn.schur.rows[0, 0] >= 0:
        down = 0.0
        side = -gamma
        for c in range(3, ENTRIES):
            down += dyn.jac[c] ** 2 * dyn.inverse[c]
            side += dyn.jac[c] * dyn.inverse[c] * force[c]
        lam = side / down
    for c in range(3, ENTRIES):
        force[c] -= lam * dyn.jac[c]
        a[c] = dyn.inverse[c] * force[c]
    return lam


@apart
def accelerate(dyn, scratch, t, state, a, lam):
    """See formulation.py."""
    q, v, force = state[0], state[1], scratch.force
    for c in range(3, ENTRIES):
        force[c] = dyn.weight[c]
    force[6] = (dyn.inertia[7] - dyn.inertia[8]) * v[7] * v[8]
    force[7] = (dyn.inertia[8] - dyn.inertia[6]) * v[8] * v[6]
    force[8] = (dyn.inertia[6] - dyn.inertia[7]) * v[6] * v[7]
    _find_row(dyn, q)
    gamma = _gamma(dyn, q, v)
    scratch.ws.right[0, 0] = gamma
    lam[0] = _push_by_row(dyn, force, gamma, a)
    scratch.report[0] = 1.0
    return 0.0


@apart
def project(dyn, scratch, t, state, passes):
    """Make e a unit, and put the corner on the plane where it is held."""
    q, v = state[0], state[1]
    size = math.sqrt(q[6] ** 2 + q[7] ** 2 + q[8] ** 2 + q[9] ** 2)
    for c in range(6, 10):
        q[c] /= size
    largest = abs(size - 1.0)
    scratch.report[1] = largest
    scratch.report[2] = 0.0
    if dyn.schur.rows[0, 0] < 0:
        return
    for _ in range(passes):
        _find_row(dyn, q)
        down = 0.0
        rate = 0.0
        for c in range(3, ENTRIES):
            down += dyn.jac[c] ** 2 * dyn.inverse[c]
            rate += dyn.jac[c] * v[c]
        gap = q[5] + _turned(q, dyn.corner[0], dyn.corner[1], dyn.corner[2], 2)
        for c in range(3, ENTRIES):
            v[c] -= dyn.inverse[c] * dyn.jac[c] * rate / down
            dyn.held[c] = -dyn.inverse[c] * dyn.jac[c] * gap / down
        move(q, dyn.held, q)


@internal
def move(q, way, out):
    """Fill out (10,) with q moved by a small way (10,): r + dr, e + e (0, dw) / 2."""
    e0, e1, e2, e3 = q[6], q[7], q[8], q[9]
    x, y, z = 0.5 * way[6], 0.5 * way[7], 0.5 * way[8]
    for c in range(3, 6):
        out[c] = q[c] + way[c]
    out[6] = e0 - e1 * x - e2 * y - e3 * z
    out[7] = e1 + e0 * x + e2 * z - e3 * y
    out[8] = e2 + e0 * y + e3 * x - e1 * z
    out[9] = e3 + e0 * z + e1 * y - e2 * x


@internal
def _product(q, x, y, z, out):
    """e (0, x, y, z) / 2 into out[6:10]."""
    e0, e1, e2, e3 = q[6], q[7], q[8], q[9]
    out[6] = -0.5 * (e1 * x + e2 * y + e3 * z)
    out[7] = 0.5 * (e0 * x + e2 * z - e3 * y)
    out[8] = 0.5 * (e0 * y + e3 * x - e1 * z)
    out[9] = 0.5 * (e0 * z + e1 * y - e2 * x)


@internal
def rates(dyn, q, v, out):
    """See formulation.py."""
    x, y, z = v[6], v[7], v[8]
    for c in range(3, 6):
        out[c] = v[c]
    _product(q, x, y, z, out)


@internal
def bends(dyn, state, dy, out):
    """See formulation.py: e'' = e (0, w') / 2 + e' (0, w) / 2."""
    v, a = state[1], dy[1]
    for c in range(3, 6):
        out[c] = a[c]
    _product(dy[0], v[6], v[7], v[8], dyn.held)
    _product(state[0], a[6], a[7], a[8], out)
    for c in range(6, 10):
        out[c] += dyn.held[c]


@internal
def speeds(dyn, q, rate):
    """See formulation.py: (0, w) = 2 e* e' / |e|^2."""
    e0, e1, e2, e3 = q[6], q[7], q[8], q[9]
    f0, f1, f2, f3 = rate[6], rate[7], rate[8], rate[9]
    size = 0.5 * (e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3)
    rate[6] = (e0 * f1 - e1 * f0 - e2 * f3 + e3 * f2) / size
    rate[7] = (e0 * f2 - e2 * f0 - e3 * f1 + e1 * f3) / size
    rate[8] = (e0 * f3 - e3 * f0 - e1 * f2 + e2 * f1) / size
    rate[9] = 0.0


@internal
def shift(dyn, q, c, way, out):
    """See formulation.py."""
    for i in range(3, ENTRIES):
        dyn.held[i] = 0.0
    dyn.held[c] = way
    move(q, dyn.held, out)
    return way


@apart
def measure(dyn, scratch, t, q):
    """See formulation.py."""
    _find_row(dyn, q)
    scratch.ws.phi[0] = q[5] + _turned(q, dyn.corner[0], dyn.corner[1], dyn.corner[2], 2)


@internal
def along(dyn, scratch, row, u):
    """See formulation.py."""
    out = 0.0
    for c in range(3, ENTRIES):
        out += dyn.jac[c] * u[c]
    return out


@internal
def push(dyn, scratch, row, size, force):
    """See formulation.py."""
    for c in range(3, ENTRIES):
        force[c] += size * dyn.jac[c]


@apart
def respond(dyn, scratch, force, moving, a, lam):
    """See formulation.py."""
    lam[0] = _push_by_row(dyn, force, moving * scratch.ws.right[0, 0], a)


@inlined
def without_contacts(dyn, contacts):
    """See formulation.py: it is as quick with its one row."""
    return dyn


add_formulation(
    RigidBody,
    accelerate=accelerate,
    project=project,
    rates=rates,
    bends=bends,
    speeds=speeds,
    shift=shift,
    measure=measure,
    measure_gaps=measure,
    along=along,
    push=push,
    respond=respond,
    without_contacts=without_contacts,
)


SpatialEvents = namedtuple("SpatialEvents", Events._fields)
"""Events of the user whose functions get points of the body."""


@internal
def _read_points(events, first, count, q, v):
    """See events/users.py: places r + A s, then velocities r' + A (w x s)."""
    inputs = events.inputs
    for i in range(count):
        s = events.arm[first + i]
        a, b, c = v[6], v[7], v[8]
        for axis in range(3):
            inputs[3 * i + axis] = q[3 + axis] + _turned(q, s[0], s[1], s[2], axis)
            inputs[3 * (count + i) + axis] = v[3 + axis] + _turned(
                q, b * s[2] - c * s[1], c * s[0] - a * s[2], a * s[1] - b * s[0], axis
            )


@internal
def _move_points(events, first, count, q, v):
    """See events/users.py: points get velocities, and the body keeps its rotation."""
    for i in range(count):
        for axis in range(3):
            v[3 + axis] += events.outputs[3 * i + axis] - events.inputs[3 * (count + i) + axis]


read_frames.add(SpatialEvents, _read_points)
move_frames.add(SpatialEvents, _move_points)


def watched(point: np.ndarray, value: int, ends: bool = False, action: int = 0) -> Any:
    """Return an event of the user with a point (3,) of the body; value and action: addresses of functions."""
    looks = 16 + MOST_VALUES
    return SpatialEvents(
        table=np.array([[value, 0, 1, 0, int(ends), action, 0, 1]], np.int64),
        number=np.zeros((1, 4)),
        gone=np.full(1, np.inf),
        release=np.zeros((0, 7), np.int64),
        body=np.zeros(1, np.int64),
        arm=np.array([point], float),
        inputs=np.zeros(6),
        outputs=np.zeros(3),
        near=np.array([1e-11, -1e-11, 1e-11, -1e-11]),
        away=1e-11 * np.resize([1.0, -1.0, -1.0], (4, ENTRIES)),
        span=np.array([10.0]),
        pose=np.zeros((2, ENTRIES)),
        bend=np.zeros(ENTRIES),
        parts=np.zeros(looks),
        values=np.zeros(looks),
        more=np.zeros((2, looks)),
        there=np.zeros((2, looks)),
        rough=np.zeros((2, looks), np.int64),
        skipped=np.zeros(1, np.int64),
    )


class Flight:
    """A body of 2 kg in free flight above a plane, or striking it, by one of the solver's integrators."""

    def __init__(self, method: Integrator, inertia: np.ndarray, corner: np.ndarray, restitution: float = 1.0) -> None:
        """inertia (3,) kg m2, corner (3,) m."""
        m = Mechanism("corner above a plane")
        ball = m.body("body", mass=2.0, inertia=1.0)
        m.rigid_contact("plane", m.ground.at(0, 0), ball.origin, restitution=restitution)
        m.start_near(body=(0, 1, 0))
        self.ready = prepare_dynamics(m, 0.0, 10.0, contacts=True)
        plane = self.ready.dynamics
        of_body = np.concatenate([np.zeros(3), np.full(3, 2.0), inertia, np.zeros(1)])
        inverse = np.zeros(ENTRIES)
        inverse[3:9] = 1.0 / of_body[3:9]
        weight = np.zeros(ENTRIES)
        weight[5] = -2.0 * 9.81
        self.dyn = RigidBody(
            np.array(corner, float), np.zeros(ENTRIES), np.zeros(ENTRIES), of_body, inverse, weight, np.ones(ENTRIES),
            plane.schur, plane.sliding, plane.loads, np.zeros(2),
        )  # fmt: skip
        self.method = method
        self.scratch: Any = scratch_for(self.dyn, self.ready.packed.ws, 0, method.stages, method.matrices)  # pyright: ignore[reportArgumentType]

    def settings(self, tolerance: float, step: float) -> Settings:
        """Settings for a tolerance, and a step (s) of methods with a fixed one."""
        every = np.full((2, ENTRIES), tolerance)
        return Settings(every, tolerance, every.copy(), 0.2, 1e-14, step, np.zeros(0))

    def fly(self, q: np.ndarray, v: np.ndarray, times: np.ndarray, tolerance: float = 1e-11, step: float = 1e-3):
        """Return outputs without contact from q (7,) and v (6,) at the first of the times (T,) (s)."""
        state = start_state(entries(q, v), 1, float(times[0]))
        self.dyn.schur.rows[...] = -1
        out = output_for(times, ENTRIES, 1)
        status = self.method.advance(
            self.dyn, self.scratch, state, out, self.settings(tolerance, step), float(times[-1]), 10**7
        )
        assert status == 0
        return out

    def contacts(self, state: State) -> Contacts:
        """Return the contact of the corner with the plane, and nothing else to meet."""
        return contacts_of(self.ready, state, [], 0.2, self.method, log=True)

    def bounce(self, q: np.ndarray, v: np.ndarray, end: float) -> tuple[list[float], list[np.ndarray], np.ndarray]:
        """Return times (s) of impacts until ``end`` (s), states (2, 10) right after them, and at the end."""
        state = start_state(entries(q, v), 1, 0.0)
        settings, contacts = self.settings(1e-11, 1e-3), self.contacts(state)
        contacts.clock[PAUSES] = AFTER
        nowhere, times, states = output_for(NO_TIMES, ENTRIES, 1), [], []
        while True:
            status = run_events(
                self.dyn, self.scratch, state, settings, contacts, nowhere, end, 10**6, NO_TIMES, NO_TIMES
            )
            if status != JUMPED:
                assert status == 0, status
                return times, states, state.y.copy()
            if state.clock[TIME] > 0.0:
                times.append(float(state.clock[TIME]))
                states.append(state.y.copy())


def entries(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(2, 10) of q (7,) and v (6,)."""
    y = np.zeros((2, ENTRIES))
    y[0, 3:], y[1, 3:9] = q, v
    return y
