"""What events change is in one record: a copy of it is a point to go on from, and nothing beside it changes."""

from __future__ import annotations

import numpy as np

from mbsd import Mechanism
from mbsd.dynamics.events.steps import EventSteps
from mbsd.dynamics.integrators.dop853.loop import DOP853
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import TIME, copied


def bouncer() -> Mechanism:
    """A disc that bounces, slides and rolls on a floor, beside a pendulum whose pin sticks."""
    m = Mechanism("bouncer")
    ball = m.body("ball", 1.0, inertia=0.01)
    m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.1, restitution=0.5, friction=0.3)
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(3.0, 1.0), rod.start)
    m.friction("rub", "A", 0.6, radius=0.1, sticks=True)
    m.event("half", lambda t, moment: moment.t - 0.3)
    m.start_near(ball=(0.0, 0.4, 0.0), rod=-60)
    m.start_moving(ball=(1.0, 0.0, 0.0))
    return m


def begun(times: np.ndarray) -> tuple[EventSteps, list[bytes]]:
    ready = prepare_dynamics(bouncer(), 0.0, float(times[-1]), contacts=True)
    state, out = ready.begun(times)
    run = Run(ready, DOP853, 1e-8, 1e-3, float(times[-1]), {})
    met = EventSteps(ready, run, state, out, list(bouncer().events.values()))
    met.begin()
    return met, _constants(met)


def _constants(met: EventSteps) -> list[bytes]:
    """Arrays of the mechanism that are no part of the record: they must not change."""
    dynamics, packed = met.dynamics, met.packed
    arrays = [*packed.system, dynamics.inertia, dynamics.inverse, dynamics.metric, dynamics.weight, *dynamics.laws]
    arrays += [
        dynamics.loads.friction,
        dynamics.loads.friction_number[:, :-1],
        dynamics.loads.number,
        dynamics.loads.term,
    ]
    return [np.asarray(array).tobytes() for array in arrays]


def test_a_copy_of_what_is_held_and_the_state_lead_to_the_same_end() -> None:
    times = np.linspace(0.0, 2.0, 21)
    met, constants = begun(times)
    met.to(0.6)
    state, held = copied(met.state), met.now.copy()
    met.to(2.0)
    happened = [(happening.name, happening.what) for happening in met.happenings]
    assert {"impact", "sticks"} <= {what for _, what in happened}
    assert ("half", "event") in happened
    assert _constants(met) == constants

    again, _ = begun(times)
    again.to(0.6)
    for target, source in zip(again.state, state, strict=True):
        target[...] = source
    again.now.restore(held)
    again.to(2.0)
    assert again.state.clock[TIME] == 2.0
    np.testing.assert_array_equal(again.state.y, met.state.y)
    assert vars(again.now).keys() == vars(met.now).keys()
    for name, value in vars(met.now).items():
        np.testing.assert_array_equal(getattr(again.now, name), value, err_msg=name)


def test_a_copy_does_not_follow_and_a_record_restored_is_read_by_the_kernels() -> None:
    met, _ = begun(np.array([0.0, 1.0]))
    before = met.now.copy()
    met.now.rows[met.now.rows >= 0] = -1
    met.now.contacts[0], met.now.events["half"] = "closed", 7.0
    met.now.released.add(3)
    assert before.contacts == ["open"]
    met.now.restore(before)
    np.testing.assert_array_equal(met.dynamics.schur.rows, before.rows)
    assert met.switches.contacts[0].state == "open"
    assert met.now.released == set()
    met.now.released.add(5)
    assert before.released == set()
