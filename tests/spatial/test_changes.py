"""Mechanisms in space that are changed, saved, pickled, and simulated many times."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd.base.errors import ModelError
from mbsd.measures import final, largest, samples
from mbsd.spatial import Mechanism, constant_rate, harmonic
from mbsd.spatial.arrays.packing import pack
from mbsd.spatial.model.force import FORCE_KINDS
from mbsd.spatial.model.joint import KINDS
from mbsd.spatial.model.journal import BUILDING
from tests.spatial import machines

KINDS_OF_ALL = {**KINDS, **FORCE_KINDS}


def example(kind: str) -> Mechanism:
    m = Mechanism("example", gravity=(0.1, -9.0, 2.0))
    first = m.body("first", 1.0, com=(0.1, 0, 0), inertia=(0.3, 0.4, 0.5), orientation=(0.9, 0.1, -0.2, 0.3))
    second = m.rod("second", (0.1, 0.2, 0.3), (1.0, 0.4, -0.2), mass=2.0, radius=0.05)
    KINDS_OF_ALL[kind].example(m, first, second)
    m.start_moving({"first": (0.3, 0.2, -0.4)})
    return m


def arrays(m: Mechanism) -> list[np.ndarray]:
    system = pack(m).system
    out = [np.asarray(part) for part in system]
    call = list(system._fields).index("call")
    out[call] = out[call][:, 1:]  # addresses are those of a function object
    return out


def same(a: Mechanism, b: Mechanism) -> bool:
    return all(np.array_equal(x, y) for x, y in zip(arrays(a), arrays(b), strict=True))


def test_every_method_that_builds_is_kept() -> None:
    assert set(KINDS_OF_ALL) <= set(BUILDING)


@pytest.mark.parametrize("kind", KINDS_OF_ALL)
def test_every_kind_is_saved_loaded_pickled_and_copied(kind: str, tmp_path: Path) -> None:
    m = example(kind)
    for other in (pickle.loads(pickle.dumps(m)), copy.deepcopy(m)):
        assert same(m, other)
        assert other.velocities == m.velocities
    if kind == "user_force":
        with pytest.raises(ModelError, match=r"user_force 'example'.function is the Python function"):
            m.save(tmp_path / "m.json")
        return
    m.save(tmp_path / "m.json")
    loaded = Mechanism.load(tmp_path / "m.json")
    assert same(m, loaded)
    assert loaded.gravity == m.gravity
    loaded.save(tmp_path / "again.json")
    assert (tmp_path / "m.json").read_bytes() == (tmp_path / "again.json").read_bytes()


def test_a_changed_mechanism_is_the_one_that_was_built_so() -> None:
    def build(radius: float, stiffness: float, x: float) -> Mechanism:
        m = Mechanism("chain", gravity=(0, 0, -9.81))
        rod = m.rod("rod", (0, 0, 0), (x, 0, 0), mass=1.0, radius=radius)
        hinge = m.revolute("hinge", m.ground, rod, at=(0, 0, 0), axis=(0, 1, 0))
        m.torsion_spring("twist", hinge, stiffness=stiffness)
        m.spring("pull", m.ground.marker((0, 0, 1)), rod.marker((0.3, 0, 0)), stiffness=20.0)
        m.start_moving({"hinge": 1.0})
        m.event("low", lambda t, moment: moment.joint("hinge").turn - 0.2)
        m.trace("tip", rod, at=(1, 0, 0))
        return m

    m, wanted = build(0.02, 3.0, 1.0), build(0.05, 7.0, 1.5)
    rod = m.bodies["rod"]
    m.change("twist", stiffness=7.0)
    m.change(rod, radius=0.05, end=(1.5, 0, 0))
    assert m.bodies["rod"] is rod
    assert same(m, wanted)
    a, b = (built.simulate(duration=0.5, steps=5) for built in (m, wanted))
    assert np.array_equal(a.point("tip").place, b.point("tip").place)
    assert a.events == b.events


def test_a_change_that_cannot_be_changes_nothing() -> None:
    m = machines.slider_crank()
    before = arrays(m)
    with pytest.raises(ModelError, match="mass is -1"):
        m.change("rod", mass=-1.0)
    with pytest.raises(ModelError, match="no argument 'mas', did you mean 'mass'"):
        m.change("rod", mas=1.0)
    with pytest.raises(ModelError, match="no body, joint, driver, force or event 'rodd', did you mean 'rod'"):
        m.change("rodd", mass=1.0)
    with pytest.raises(ModelError, match="first and second are at"):
        m.change("cross", first=(1, 1, 1))
    assert all(np.array_equal(x, y) for x, y in zip(before, arrays(m), strict=True))
    m.change("motor", law=constant_rate(4.0))
    assert m.sweep(steps=4).driver("motor").rate == pytest.approx(np.full(5, 4.0))


def test_what_was_taken_out_stays_out_of_a_change() -> None:
    m = machines.slider_crank()
    m.drivers.clear()
    m.change("rod", mass=2.0)
    assert not m.drivers
    assert m.bodies["rod"].mass == 2.0


def test_solutions_are_pickled_with_their_functions() -> None:
    m = Mechanism("pull", gravity=(0, 0, -9.81))
    body = m.body("body", 1.0, inertia=(0.3, 0.4, 0.5))
    factor = 30.0
    m.user_force("pull", lambda t, q, v: (-factor * q[0], 0.0, -factor * q[2], 0.0, 0.0, 0.0), body)
    m.contact("floor", m.ground, body, 1e4, at=(0, 0, -1), normal=(0, 0, 1), centre=(0, 0, 0), radius=0.1)
    sol = m.simulate(duration=0.3, steps=3)
    other = pickle.loads(pickle.dumps(sol))
    assert np.array_equal(sol.energy.total, other.energy.total)
    assert np.array_equal(sol.force("pull").force, other.force("pull").force)
    again = other.mechanism.simulate(duration=0.3, steps=3)
    assert np.array_equal(again.body("body").place, sol.body("body").place)


def pendulum() -> Mechanism:
    m = Mechanism("pendulum", gravity=(0, 0, -9.81))
    rod = m.rod("rod", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.02)
    m.revolute("hinge", m.ground, rod, at=(0, 0, 0), axis=(0, 1, 0))
    m.torsion_spring("twist", "hinge", stiffness=1.0)
    m.trace("tip", rod, at=(1, 0, 0))
    return m


VARIED: dict[str, Any] = {
    "vary": {"twist": {"stiffness": [0.5, 2.0, 9.0, 3.0]}, "rod": {"mass": [1.0, 2.0, 0.7, 1.5]}},
    "start": {"hinge": [0.0, 20.0, -30.0, 170.0]},
    "moving": {"hinge": [0.0, 1.0, 2.0, -40.0]},
}


@pytest.mark.parametrize("formulation", ["tree", "reference"])
def test_many_simulations_in_the_compiled_loop_are_single_ones(formulation: str) -> None:
    m, asked = pendulum(), {"duration": 0.7, "steps": 7, "formulation": formulation}
    varied = {given: dict(VARIED[given]) for given in VARIED if given != "start" or formulation == "tree"}
    many = m.simulate_many(
        **varied, **asked, threads=2,
        measure={"tip": samples("tip.z", [0.3, 0.7]), "most": largest("hinge.turn"), "rate": final("hinge.turn_rate")},
    )  # fmt: skip
    assert many.way == "all of 4 in the compiled loop"
    assert many.good.all()
    for k in range(4):
        for name, changes in varied["vary"].items():
            m.change(name, **{key: values[k] for key, values in changes.items()})
        m.start_near({name: values[k] for name, values in varied.get("start", {}).items()})
        m.start_moving({"hinge": varied["moving"]["hinge"][k]})
        sol = m.simulate(**asked)
        assert np.allclose(many["tip"][k], sol.point("tip").place[[3, 7], 2], rtol=0, atol=1e-12)
        assert many["most"][k] == pytest.approx(sol.joint("hinge").turn.max(), rel=1e-12)
        assert many["rate"][k] == pytest.approx(sol.joint("hinge").turn_rate[-1], rel=1e-11)


def test_what_no_loop_can_do_is_simulated_one_by_one() -> None:
    m = pendulum()
    named = {"tip": final("tip.z"), "bearing": largest("hinge.fz")}
    both = [
        m.simulate_many(0.7, **VARIED, steps=7, measure=measure)
        for measure in (
            named,
            lambda sol: {"tip": sol.point("tip").z[-1], "bearing": sol.joint("hinge").force[:, 2].max()},
            lambda sol: {"tip": sol.point("tip").place[-1]},
        )
    ]
    assert both[0].way == "4 one by one ('hinge.fz' is that of a single solution)"
    assert both[1].way == "4 one by one (measure is a function of a solution)"
    assert np.array_equal(both[0]["tip"], both[1]["tip"])
    assert np.array_equal(both[0]["bearing"], both[1]["bearing"])
    assert both[2]["tip"].shape == (4, 3)
    longer = m.simulate_many(0.5, vary={"rod": {"end": [(1, 0, 0), (2, 0, 0)]}}, steps=5, measure={"x": final("rod.x")})
    assert longer.way == "2 one by one (places on bodies depend on what varies)"


def test_many_simulations_that_cannot_be_are_refused_or_have_a_reason() -> None:
    m, measure = pendulum(), {"tip": final("tip.z")}
    with pytest.raises(ModelError, match="numbers of values differ"):
        m.simulate_many(1.0, vary={"twist": {"stiffness": [1, 2]}}, start={"hinge": [1, 2, 3]}, measure=measure)
    with pytest.raises(ModelError, match="no argument 'stifness'"):
        m.simulate_many(1.0, vary={"twist": {"stifness": [1, 2]}}, measure=measure)
    with pytest.raises(ModelError, match=r"no quantity 'tip\.zz', did you mean 'tip\.z'"):
        m.simulate_many(1.0, vary={"twist": {"stiffness": [1, 2]}}, measure={"tip": final("tip.zz")})
    some = m.simulate_many(0.1, vary={"rod": {"mass": [1.0, -1.0, 2.0]}}, steps=2, measure=measure)
    assert some.good.tolist() == [True, False, True]
    assert "mass is -1" in str(some.reason[1])
    assert np.isnan(some["tip"][1])


def test_files_that_are_none_are_refused(tmp_path: Path) -> None:
    m = machines.slider_crank()
    m.drive_slide("other", "rail", harmonic(0.1, 1.0))
    file = tmp_path / "m.json"
    m.save(file)
    content = file.read_text()
    for old, new, said in (
        ('"version": 1', '"version": 7', "version 7; this mbsd reads version 1"),
        ("mbsd mechanism in space", "mbsd", "no file of a mechanism in space"),
        ('"method": "prismatic"', '"method": "__init__"', "no method that builds '__init__'"),
        ('"mass": 0.5', '"mass": "much"', r"calls\[1\].*mass"),
        ('"body": "ground"', '"body": "grund"', "grund"),
        ('"at"', '"att"', "no argument 'att'"),
        ('"amplitude"', '"amplitud"', "amplitud"),
    ):
        assert old in content
        file.write_text(content.replace(old, new))
        with pytest.raises(ModelError, match=said):
            Mechanism.load(file)
    file.write_text(content[:-20])
    with pytest.raises(ModelError, match="not a whole JSON file"):
        Mechanism.load(file)
    with pytest.raises(ModelError, match="cannot read"):
        Mechanism.load(tmp_path / "none.json")
