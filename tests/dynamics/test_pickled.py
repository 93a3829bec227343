"""Solutions and mechanisms through pickle, into another process, and as deep copies: the same views, bit by bit."""

from __future__ import annotations

import copy
import math
import multiprocessing
import pickle
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.model.event import angle_reaches, distance_reaches
from mbsd.results.solution import Solution
from mbsd.testing import force_kinds, joint_kinds


def crank() -> Mechanism:
    m = Mechanism("crank")
    rod = m.bar("rod", 0.3, 1.0)
    slider = m.body("slider", 0.5, inertia=1e-3)
    wheel = m.bar("wheel", 0.1, 1.0)
    m.revolute("A", m.ground.origin, wheel.start)
    m.revolute("B", wheel.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.origin, slider.origin)
    m.trace("P", rod.at(0.1, 0.05))
    m.start_near(wheel=40, rod=-10)
    return m


def driven() -> Solution:
    m = crank()
    m.drive_angle("motor", m.bodies["wheel"], lambda t: 6.0 * t + 0.7)
    m.spring_law("spring", m.ground.at(0.0, 0.5), m.bodies["rod"].end, lambda length, rate: -30.0 * length - rate)
    return m.sweep(1.0, steps=8)


def bouncing() -> Solution:
    """Contacts, events that close over bodies and markers, functions of the user, a curve."""
    m = Mechanism("bouncing")
    ball = m.body("ball", 1.0, inertia=1e-3)
    bead = m.body("bead", 0.2, inertia=1e-4)
    m.point_on_curve("wire", m.ground.at(0, 2), bead.origin, [(-1, 0.5), (-0.4, 0.1), (0.1, 0), (0.6, 0.2), (1, 0.7)])
    m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.05, restitution=0.5, friction=0.2)
    m.user_force("wind", lambda t, q, v: (0.3 * math.sin(t), 0.0, -0.01 * v[2]), ball)
    seen: list[float] = []
    m.event("near", distance_reaches(m.ground.origin, ball.origin, 0.15), action=lambda moment: seen.append(1.0))
    m.event("high", lambda t, moment: moment.body(ball.name).y - 0.2)
    m.start_near(ball=(0, 0.3, 0), bead=(0.5, 2.15, 0))
    return m.simulate(0.6, steps=12)


def rough() -> Solution:
    """A joint that sticks, and an event on the way."""
    m = crank()
    m.friction("brake", "guide", 0.3, sticks=True)
    m.event("turned", angle_reaches(m.bodies["wheel"], 0.3))
    return m.simulate(0.3, steps=6)


def held() -> Solution:
    """A constraint of the user, which is called by an address."""
    m = Mechanism("rail")
    body = m.body("body", 1.0, inertia=0.1)
    m.constraint("ellipse", m.ground.origin, body.origin, lambda x, y, a: x * x + y * y / 4.0 - 1.0)
    m.start_near(body=(1.0, 0.1, 0.0))
    return m.simulate(0.2, steps=3)


SOLUTIONS = [driven, bouncing, rough, held]


def views(sol: Solution) -> dict[str, Any]:
    """All that a solution tells."""
    out: dict[str, Any] = {key: column.tobytes() for key, column in sol.columns().items()}
    out |= {"margin": sol.singularity_margin.tobytes(), "events": sol.events, "mobility": sol.mobility}
    for name, view in sol.forces.items():
        out |= {f"{name}: {key}": value.tobytes() for key, value in vars(view).items() if isinstance(value, np.ndarray)}
    out |= {name: sol.contact(name).normal.tobytes() for name in sol.mechanism.contacts}
    out |= {name: sol.friction(name).force.tobytes() for name, f in sol.mechanism.forces.items() if f.kind.of_reactions}
    if sol.work is not None:
        out["between"] = sol.at([0.05, 0.11]).q.tobytes()
    return out


def views_of_pickled(content: bytes) -> dict[str, Any]:
    """Called in another process."""
    return views(pickle.loads(content))


@pytest.fixture(scope="module")
def solved() -> dict[str, Solution]:
    return {make.__name__: make() for make in SOLUTIONS}


def test_in_another_process(solved: dict[str, Solution]) -> None:
    """Machine addresses of equations and functions are other ones there."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.map(views_of_pickled, [pickle.dumps(sol) for sol in solved.values()])
    for sol, seen in zip(solved.values(), there, strict=True):
        assert seen == views(sol)


@pytest.mark.parametrize("name", [make.__name__ for make in SOLUTIONS])
@pytest.mark.parametrize(
    "through",
    [copy.deepcopy, copy.copy, lambda sol: pickle.loads(pickle.dumps(sol))],
    ids=["deepcopy", "copy", "pickle"],
)
def test_here(solved: dict[str, Solution], name: str, through: Callable[[Solution], Solution]) -> None:
    other = through(solved[name])
    assert views(other) == views(solved[name])
    assert other.mechanism.joints.keys() == solved[name].mechanism.joints.keys()


def test_a_mechanism_is_solved_as_before_and_is_one_whole(solved: dict[str, Solution]) -> None:
    """Bodies that functions close over are those of the mechanism."""
    m: Mechanism = pickle.loads(pickle.dumps(solved["bouncing"].mechanism))
    assert m.ground.mechanism is m
    assert m.contacts["floor"].j.body is m.bodies["ball"]
    cells: Any = getattr(m.events["high"].value, "__closure__", ())
    markers: Any = getattr(m.events["near"].value, "frames", ())
    bodies = [*(cell.cell_contents for cell in cells), *(marker.body for marker in markers)]
    assert [body.name for body in bodies] == ["ball", "ground", "ball"]
    assert all(body is m.bodies[body.name] for body in bodies)
    assert views(m.simulate(0.6, steps=12)) == views(solved["bouncing"])


def test_after_a_change_the_motion_between_is_refused_and_not_another_one() -> None:
    m = crank()
    sol = m.simulate(0.1, steps=2)
    m.change("rod", mass=5.0)
    other = pickle.loads(pickle.dumps(sol))
    with pytest.raises(ModelError, match="crank: the mechanism was changed after this simulation"):
        other.at(0.05)
    assert np.isfinite(sol.at(0.05).q).all()


def test_what_cannot_be_pickled_is_named() -> None:
    lock = threading.Lock()
    m = crank()
    m.event("held", lambda t, moment: t - 1.0 - (lock is None))
    with pytest.raises(ModelError, match=r"event 'held' holds the Python function .*, which pickle cannot hold.*def"):
        pickle.dumps(m)
    assert copy.deepcopy(m).events["held"].value is m.events["held"].value


def test_every_kind_comes_back_as_itself() -> None:
    for kind in [*joint_kinds(), *force_kinds()]:
        m = Mechanism("example")
        first, second = m.body("first", 1.0, inertia=1.0), m.body("second", 1.0, inertia=1.0)
        assert kind.example is not None
        kind.example(m, first.at(0.1, 0.2, 0.3), second.at(-0.4, 0.5, -0.6))
        for other in (pickle.loads(pickle.dumps(m)), copy.deepcopy(m)):
            for table in ("joints", "drivers", "forces"):
                for name, entry in getattr(m, table).items():
                    assert getattr(other, table)[name].kind is entry.kind
                    assert getattr(other, table)[name].i.body is other.bodies[entry.i.body.name]


def test_other_results() -> None:
    m = crank()
    m.spring("spring", m.ground.at(0.2, 0.5), m.bodies["slider"].origin, 50.0, damping=1.0)
    rest = m.equilibrium()
    near = m.linearise(at=rest)
    for result in (rest, near):
        for other in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
            assert repr(other) == repr(result)
    m.drive_angle("motor", m.bodies["wheel"], constant_rate(2.0))
    sol = m.sweep(1.0, steps=4)
    moved = m.inverse_dynamics(sol, ["motor"])
    assert np.array_equal(pickle.loads(pickle.dumps(moved)).efforts["motor"], moved.efforts["motor"])
    designs = pickle.loads(pickle.dumps(m.batch(lengths={"rod": [0.3, 0.31]}, duration=1.0, steps=4)))
    assert designs.points["P"].shape == (2, 5, 2)
