"""data.json holds the numbers of the solution itself: forces, contacts, events, work, shapes."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, curve
from mbsd.results.solution import Solution
from mechanisms.stages.solve.motion_file import shape_of, to_motion
from shared import contract
from shared.stage import jsonfile
from shared.stage.errors import UserError


def _loaded() -> Solution:
    """A pendulum with a spring, pin friction and drag, pushed by a function of the user, in a turning frame."""
    m = Mechanism("arm", gravity=(0.0, -9.81))
    arm = m.bar("arm", 0.3, mass=0.4)
    pin = m.revolute("A", m.ground.at(0, 0), arm.start)
    m.spring("spring", m.ground.at(0.2, 0.2), arm.end, stiffness=40.0, damping=0.3, free_length=0.15)
    m.torsion_spring("twist", m.ground, arm, stiffness=0.2)
    m.friction("rub", pin, 0.2, radius=0.01)
    m.drag("air", arm.end, 0.05)
    m.user_force("push", lambda t, q, v: [0.1 * math.sin(t), 0.0, 0.0], arm)
    m.rotating_frame("turning", 0.1)
    m.start_near(arm=-40)
    m.start_moving(arm=2.0)
    return m.simulate(0.4, steps=40)


def _striking() -> Solution:
    """A disc that falls on a floor, rebounds, slides and comes to rest, and a weight on a rope."""
    m = Mechanism("disc", gravity=(0.0, -9.81))
    disc, weight = m.body("disc", mass=0.2, inertia=1e-4), m.body("weight", mass=0.1, inertia=1e-5)
    m.rigid_contact("floor", m.ground.origin, disc.origin, radius=0.05, restitution=0.4, friction=0.2)
    m.rope("cord", m.ground.at(1, 1), weight.origin, 0.5)
    m.start_near(disc=(0.0, 0.2, 0.0), weight=(1.0, 0.7, 0.0))
    m.start_moving(disc=(5.0, 0.0, 0.0), weight=(0.0, 0.0, 0.0))
    return m.simulate(1.2, steps=120, event_rows=True)


@pytest.fixture(scope="module")
def loaded() -> Solution:
    return _loaded()


@pytest.fixture(scope="module")
def striking() -> Solution:
    return _striking()


def test_forces_are_those_of_the_solution(loaded: Solution, tmp_path: Path) -> None:
    motion = to_motion(loaded, None, "key", {}, {"arm": "mechanism"})
    contract.write_motion(tmp_path / "data.json", motion)
    motion = contract.read_motion(tmp_path / "data.json")
    assert motion.schema_version == 3
    assert motion.analysis == "simulation"
    assert list(motion.forces) == ["spring", "twist", "rub", "air", "push", "turning"]
    for name, force in motion.forces.items():
        view = loaded.force(name)
        assert force.kind == view.kind
        assert [action.body for action in force.actions] == list(view.bodies)
        for action in force.actions:
            theirs = view.on(action.body)
            for field in ("x", "y", "fx", "fy", "torque"):
                np.testing.assert_array_equal(getattr(action, field), getattr(theirs, field))
        for field in ("value", "rate", "effort"):
            mine, theirs = getattr(force, field), getattr(view, field)
            assert (mine is None) == (theirs is None)
            if mine is not None:
                np.testing.assert_array_equal(mine, theirs)
        np.testing.assert_array_equal(force.power, view.power)
        np.testing.assert_array_equal(force.potential, view.potential)
    spring = motion.forces["spring"]
    assert spring.measures == "length"
    assert spring.shape is not None
    assert spring.shape.length == 0.15
    assert max(spring.potential) > 0.01
    np.testing.assert_array_equal(motion.forces["rub"].normal, loaded.friction("rub").normal)
    assert motion.forces["push"].shape is None
    assert motion.forces["turning"].shape is None
    assert loaded.work is not None
    np.testing.assert_array_equal(motion.energy.work, loaded.work)
    assert np.ptp(motion.energy.audit) < 1e-6
    assert motion.bodies["arm"].mass_from == "mechanism"


def test_a_spring_drawn_from_the_file_has_the_length_it_measures(loaded: Solution) -> None:
    """From the file alone: markers placed by the poses of their bodies are the points of action."""
    motion = to_motion(loaded, None, "key", {}, {"arm": "mechanism"})
    spring = motion.forces["spring"]
    assert spring.shape is not None
    ends = []
    for body, (x, y, _angle) in zip(spring.shape.bodies, spring.shape.markers, strict=True):
        if body == "ground":
            ends.append(np.tile([x, y], (len(motion.time), 1)))
            continue
        frame = motion.bodies[body]
        c, s = np.cos(frame.theta), np.sin(frame.theta)
        ends.append(np.stack([np.array(frame.x) + c * x - s * y, np.array(frame.y) + s * x + c * y], axis=1))
    np.testing.assert_allclose(np.hypot(*(ends[1] - ends[0]).T), spring.value, atol=1e-12)
    for action, end in zip(spring.actions, ends, strict=True):
        np.testing.assert_allclose(np.stack([action.x, action.y], axis=1), end, atol=1e-12)


def test_contacts_and_events_are_those_of_the_solution(striking: Solution, tmp_path: Path) -> None:
    motion = to_motion(striking, None, "key", {}, dict.fromkeys(("disc", "weight"), "mechanism"))
    contract.write_motion(tmp_path / "data.json", motion)
    motion = contract.read_motion(tmp_path / "data.json")
    assert set(motion.contacts) == {"floor", "cord"}
    for name, contact in motion.contacts.items():
        view = striking.contact(name)
        for field in ("gap", "rate", "normal", "friction"):
            np.testing.assert_array_equal(getattr(contact, field), getattr(view, field))
        closed = np.array(contact.state) != "open"
        assert closed.any()
        assert not closed.all()
        assert np.abs(np.array(contact.gap)[closed]).max() < 1e-8
        assert not np.array(contact.normal)[~closed].any()
    floor, cord = motion.contacts["floor"], motion.contacts["cord"]
    assert {"open", "slides", "sticks"} == set(floor.state)
    assert set(cord.state) == {"open", "closed"}
    assert floor.shape.radius_second == 0.05
    assert cord.shape.length == 0.5
    np.testing.assert_allclose(floor.fy, floor.normal, atol=1e-9)  # a level floor
    assert floor.fy[-1] == pytest.approx(0.2 * 9.81, rel=1e-6)
    assert cord.fy[-1] == pytest.approx(0.1 * 9.81, rel=1e-6)
    assert [(e.time, e.name, e.what, e.energy, e.impulse) for e in motion.events] == [
        (e.time, e.name, e.what, e.energy, e.impulse) for e in striking.events
    ]


def test_both_sides_of_an_impact_are_there_at_one_instant(striking: Solution) -> None:
    motion = to_motion(striking, None, "key", {}, dict.fromkeys(("disc", "weight"), "mechanism"))
    first = next(event for event in motion.events if event.name == "floor" and event.what == "impact")
    rows = [k for k, time in enumerate(motion.time) if time == first.time]
    before, after = rows[0], rows[-1]
    assert len(rows) >= 2
    disc = motion.bodies["disc"]
    assert disc.vy[after] == pytest.approx(-0.4 * disc.vy[before], rel=1e-9)
    assert disc.y[after] == pytest.approx(disc.y[before], abs=1e-12)
    assert motion.energy.kinetic[after] - motion.energy.kinetic[before] == pytest.approx(first.energy, rel=1e-9)
    mass_times_jump = 0.2 * (disc.vy[after] - disc.vy[before])
    assert first.impulse == pytest.approx(mass_times_jump, rel=1e-9)


def test_wheels_curves_and_cams_have_their_shapes() -> None:
    m = Mechanism("train")
    a, b = m.body("a"), m.body("b")
    gears = m.gear_pair("gears", a.origin, b.origin, teeth=(60, 20), module=0.002, internal=True)
    belt = m.belt("belt", a.origin, b.origin, radius_i=0.03, radius_j=0.01, crossed=True)
    geneva = m.geneva("indexing", a.origin, b.origin, slots=6, radius=0.05)
    points = [(math.cos(angle), 0.5 * math.sin(angle)) for angle in np.linspace(0, 2 * math.pi, 13)[:-1]]
    track = m.point_on_curve("track", m.ground.origin, a.at(0.1, 0.0), points, closed=True)
    hill = m.contact(
        "hill", m.ground.origin, b.origin, 1e4, radius=0.02, profile=curve([0.0, 1.0, 2.0], [0.0, 0.3, 0.1])
    )
    assert (shape_of(gears).radius_first, shape_of(gears).radius_second) == pytest.approx((0.06, 0.02))
    assert shape_of(gears).teeth == [60, 20]
    assert shape_of(gears).ring
    assert shape_of(belt).crossed
    assert (shape_of(belt).radius_first, shape_of(belt).radius_second) == (0.03, 0.01)
    assert (shape_of(geneva).slots, shape_of(geneva).pin_radius, shape_of(geneva).radius_second) == (6, 0.05, None)
    outline = np.array(shape_of(track).outline)
    assert shape_of(track).outline_closed
    assert np.abs((outline[:, 0]) ** 2 + (2 * outline[:, 1]) ** 2 - 1).max() < 1e-2
    for point in points:
        assert np.hypot(*(outline - point).T).min() < 0.02
    way = np.array(shape_of(hill).outline)
    assert shape_of(hill).radius_second == 0.02
    assert way[0] == pytest.approx([0.0, 0.0])
    assert way[-1] == pytest.approx([2.0, 0.1])
    assert way[120] == pytest.approx([1.0, 0.3])


def test_bearings_and_gears_with_play_have_their_shapes() -> None:
    m = Mechanism("play")
    a, b = m.body("a", mass=1.0, inertia=1e-3), m.body("b", mass=1.0, inertia=1e-3)
    m.clearance_joint("A", m.ground.at(0, 0), a.origin, 0.5e-3, 0.01, stiffness=1e9)
    m.gear_mesh("mesh", a.origin, b.origin, 1e7, teeth=(40, 20), module=3e-3)
    bearing, mesh = (shape_of(m.forces[name]) for name in ("A", "mesh"))
    assert (bearing.radius_first, bearing.radius_second, bearing.ring) == (0.01, pytest.approx(0.0095), True)
    assert (mesh.radius_first, mesh.radius_second) == (pytest.approx(0.06), pytest.approx(0.03))
    assert (mesh.teeth, mesh.ring) == ([40, 20], False)


def test_a_sweep_has_no_contacts_and_no_work() -> None:
    m = Mechanism("arm")
    arm = m.bar("arm", 0.3, mass=0.4)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(6.0))
    m.torsion_spring("twist", m.ground, arm, stiffness=0.2)
    solution = m.sweep(steps=24)
    motion = to_motion(solution, None, "key", {}, {"arm": "mechanism"})
    assert motion.analysis == "sweep"
    assert (motion.contacts, motion.energy.work, motion.events) == ({}, None, [])
    assert motion.drivers["motor"].bodies == ("ground", "arm")
    np.testing.assert_array_equal(motion.forces["twist"].effort, solution.force("twist").effort)


Edit = Callable[[dict[str, Any]], object]
REFUSED: dict[str, tuple[Edit, str]] = {
    "ragged force": (lambda d: d["forces"]["spring"]["power"].pop(), r"forces\.spring\.power has 40 values, time"),
    "ragged action": (
        lambda d: d["forces"]["spring"]["actions"][1]["fx"].pop(),
        r"forces\.spring\.actions\[1\]\.fx has 40 values",
    ),
    "unknown body": (
        lambda d: d["forces"]["spring"]["actions"][1].update(body="leg"),
        r"forces\.spring\.actions\[1\]\.body names 'leg', which is no body",
    ),
    "unknown body of a shape": (
        lambda d: d["joints"]["A"]["shape"].update(bodies=["ground", "leg"]),
        r"joints\.A\.shape\.bodies names 'leg'",
    ),
    "unfit name": (lambda d: d["forces"].update({"a/b": d["forces"]["spring"]}), r"forces has the name 'a/b'"),
    "measures what there is not": (
        lambda d: d["forces"]["spring"].update(measures="volume"),
        r"at forces\.spring\.measures",
    ),
    "event after the end": (
        lambda d: d["events"].append({"time": 9.0, "name": "e", "what": "event", "energy": 0.0}),
        r"events\[0\] 'e' is at 9 s",
    ),
    "forces in version 1": (lambda d: d.update(schema_version=1), r"conventions\."),
}


@pytest.mark.parametrize(("edit", "words"), REFUSED.values(), ids=REFUSED)
def test_inconsistent_files_are_refused(loaded: Solution, tmp_path: Path, edit: Edit, words: str) -> None:
    document = json.loads(jsonfile.encode(to_motion(loaded, None, "key", {}, {"arm": "mechanism"})))
    edited = copy.deepcopy(document)
    edit(edited)
    path = tmp_path / "data.json"
    path.write_text(json.dumps(edited))
    with pytest.raises(UserError, match=words):
        contract.read_motion(path)


def test_files_of_version_1_are_read(tmp_path: Path) -> None:
    from tools.models.motions import four_bar_motion

    document = json.loads(jsonfile.encode(four_bar_motion(steps=12)))
    document |= {"schema_version": 1, "conventions": contract.CONVENTIONS_OF[1]}
    for field in ("forces", "contacts", "start_changes", "analysis"):
        del document[field]
    for joint in document["joints"].values():
        del joint["shape"]
    for body in document["bodies"].values():
        del body["mass_from"]
    path = tmp_path / "data.json"
    path.write_text(json.dumps(document))
    motion = contract.read_motion(path)
    assert motion.schema_version == 1
    assert motion.forces == {}
    assert motion.joints["B"].bodies == ("crank", "coupler")
    document["forces"] = {"push": {}}
    path.write_text(json.dumps(document))
    with pytest.raises(UserError, match=r"forces\.push"):
        contract.read_motion(path)


def _examples() -> dict[str, Mechanism]:
    """A small simulation with an example of each kind of force and contact, by name."""
    from mbsd.model.force import FORCE_KINDS
    from mbsd.model.joint import CONTACT_KINDS

    examples = {}
    for kind in (*FORCE_KINDS.values(), *CONTACT_KINDS.values()):
        if kind.name in ("friction", "capstan", "rigid_contact"):
            continue  # their examples do not fit here
        m = Mechanism("example")
        i = m.bar("a", 0.4, mass=1.0)
        j = m.bar("b", 0.3, mass=0.5)
        m.revolute("A", m.ground.at(0, 0), i.start)
        m.revolute("B", m.ground.at(1.0, 0), j.start)
        assert kind.example is not None
        kind.example(m, i.at(0.3, 0.05, 0.2), j.at(0.1, -0.02, 0.4))
        m.start_near(a=20, b=70)
        examples[kind.name] = m
    return examples


EXAMPLES = _examples()


@pytest.mark.parametrize("kind", EXAMPLES)
def test_every_kind_of_force_and_contact_reaches_the_file(kind: str, tmp_path: Path) -> None:
    solution = EXAMPLES[kind].simulate(0.01, steps=4, event_rows=True)
    sources = dict.fromkeys(set(EXAMPLES[kind].bodies) - {"ground"}, "mechanism")
    motion = to_motion(solution, None, "key", {}, sources)  # pyright: ignore[reportArgumentType]
    contract.write_motion(tmp_path / "data.json", motion)
    again = contract.read_motion(tmp_path / "data.json")
    assert again == motion
    kinds = {name: element.kind for name, element in (again.forces | again.contacts).items()}
    assert kind in kinds.values()
