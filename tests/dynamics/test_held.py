"""What events change is in one record: a copy of it is a point to go on from, and nothing beside it changes."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.dynamics.events.driver import EventSteps
from mbsd.dynamics.integrators.dop853.loop import DOP853
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import TIME, WORK


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


def test_each_point_to_go_on_from_leads_to_the_same_end() -> None:
    times = np.linspace(0.0, 2.0, 21)
    met, constants = begun(times)
    met.to(2.0)
    happened = [(happening.name, happening.what) for happening in met.happenings]
    assert {"impact", "sticks"} <= {what for _, what in happened}
    assert ("half", "event") in happened
    assert _constants(met) == constants
    assert len(met.snapshots) > 5
    for snapshot in met.snapshots:
        again, _ = begun(times[times >= snapshot.time])
        again.state.y[...], again.state.clock[TIME] = snapshot.y, snapshot.time
        again.resume(snapshot, snapshot.work)
        again.to(2.0)
        np.testing.assert_allclose(again.state.y, met.state.y, atol=1e-12)  # the first step is chosen anew
        assert again.state.clock[WORK] == pytest.approx(met.state.clock[WORK], abs=1e-12)
        later = [happening for happening in met.happenings if happening.time > snapshot.time]
        assert [(each.name, each.what) for each in again.happenings] == [(each.name, each.what) for each in later]


def test_a_snapshot_does_not_follow() -> None:
    met, _ = begun(np.array([0.0, 1.0]))
    snapshot = met.snapshots[-1]
    kept = [part.copy() for part in snapshot.held]
    met.to(1.0)
    for part, before in zip(snapshot.held, kept, strict=True):
        np.testing.assert_array_equal(part, before)
