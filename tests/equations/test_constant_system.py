"""System is constant: closing the start makes another one, and what events change is beside it."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest
from numba import TypingError

from mbsd import Mechanism, constant_rate
from mbsd.arrays.packing import pack
from mbsd.dynamics.events.driver import EventSteps
from mbsd.dynamics.integrators.dop853.loop import DOP853
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import TIME
from mbsd.equations.system import LAST, System
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.pose.phases import take_decided

ROUND = np.linspace(0.0, 2 * math.pi, 65)[:-1]


def wheels() -> Mechanism:
    m = Mechanism("wheels", gravity=None)
    arm, first, second = m.bar("arm", 0.3, mass=1.0), m.body("first", 1.0, inertia=0.1), m.body("second", inertia=0.1)
    m.revolute("A", m.ground.origin, arm.start)
    m.revolute("B", m.ground.origin, first.origin)
    m.revolute("C", arm.end, second.origin)
    m.gear_pair("teeth", first.origin, second.origin, 0.1, 0.2)
    m.drive_angle("motor", arm, constant_rate(1.0))
    m.drive_angle("brake", first, constant_rate(0.0))
    return m


def welded(contact: bool = False) -> Mechanism:
    """A pendulum of two welded bars, one of which starts a whole turn on; the second bar bounces on a floor."""
    m = Mechanism("welded")
    upper, lower = m.bar("upper", 1.0, mass=1.0), m.bar("lower", 0.5, mass=1.0)
    m.revolute("A", m.ground.origin, upper.start)
    m.weld("W", upper.end, lower.start)
    m.start_near(upper=10.0, lower=370.0)
    if contact:
        m.rigid_contact("floor", m.ground.at(0.0, -1.2), lower.end, radius=0.05, restitution=0.5)
    return m


def bead() -> Mechanism:
    m = Mechanism("bead")
    body = m.body("one", 1.0, inertia=1e-3)
    track = np.stack([np.sin(ROUND), 0.5 * np.sin(2 * ROUND)], axis=1)
    m.point_on_curve("track", m.ground.origin, body.origin, track.tolist(), closed=True)
    m.start_near(one=(*track[10], 0.0))
    return m


def bytes_of(system: System) -> dict[str, bytes]:
    return {name: array.tobytes() for name, array in system._asdict().items()}


@pytest.mark.parametrize(
    ("build", "decided"), [(wheels, {"numbers", "special"}), (welded, {"angle_offset"}), (bead, set())]
)
def test_closing_the_start_makes_another_system(build, decided: set[str]) -> None:
    m = build()
    packed = pack(m)
    first = packed.system
    before = bytes_of(first)
    assemble(m, packed, 0.0)
    after = bytes_of(packed.system)
    assert {name for name in before if after[name] != before[name]} == decided
    assert bytes_of(first) == before
    again = pack(m)
    take_decided(again, packed)
    assert bytes_of(again.system) == after


def test_nothing_can_write_into_a_system() -> None:
    sol = wheels().sweep(1.0, steps=4)
    systems = [pack(wheels()).system, pack(welded()).system, sol.packed.system]
    systems += [sol.packed.system.changed(mass=np.ones(4)), copy.deepcopy(sol).packed.system]
    systems.append(pickle.loads(pickle.dumps(sol.packed.system)))
    assert bytes_of(systems[-1]) == bytes_of(sol.packed.system)
    for system in systems:
        assert not any(array.flags.writeable for array in system)
    with pytest.raises(ValueError, match="read-only"):
        systems[0].numbers[0] = 1.0


def test_a_kernel_that_writes_into_a_system_does_not_compile() -> None:
    from mbsd.compiling.jit import kernel

    @kernel
    def spoil(system):
        system.mass[0] = 1.0

    with pytest.raises((TypingError, ValueError), match=r"(?i)read-?only"):  # without the compiler Python refuses it
        spoil(pack(welded()).system)


def test_a_run_along_a_curve_that_crosses_itself_changes_its_record_alone() -> None:
    """A snapshot is all that going on needs."""

    def begun() -> EventSteps:
        ready = prepare_dynamics(bead(), 0.0, 2.0)
        state, out = ready.begun(np.array([0.0, 2.0]))
        return EventSteps(ready, Run(ready, DOP853, 1e-8, 1e-3, 2.0, {}), state, out, [])

    met = begun()
    relative, constants = met.packed.ws.relative, bytes_of(met.packed.system)
    met.begin()
    met.to(1.0)
    kept, before = met.snapshot(), float(relative[0, LAST])
    met.to(2.0)
    assert bytes_of(met.packed.system) == constants
    assert relative[0, LAST] != before

    again = begun()
    again.state.y[...], again.state.clock[TIME] = kept.y, kept.time
    again.resume(kept, kept.work)
    again.to(2.0)
    np.testing.assert_allclose(again.state.y, met.state.y, atol=1e-6)


def test_whole_turns_at_the_start_are_kept_with_contacts() -> None:
    """The bars swing down to the floor as one, wherever the turns of their angles begin."""
    sol, plain = welded(contact=True).simulate(1.0, steps=50), welded().simulate(0.3, steps=15)
    assert {event.what for event in sol.events} >= {"impact"}
    np.testing.assert_allclose(sol.q[..., 2][:, 2] - sol.q[..., 2][:, 1], 2 * math.pi, atol=1e-9)
    np.testing.assert_allclose(sol.q[:16], plain.q, atol=1e-6)
