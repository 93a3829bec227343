"""Names of things and of attributes that do not exist: the error says what there is, and what was probably meant."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import mbsd
from mbsd import Mechanism, ModelError, Solution, constant_rate
from mbsd.derivatives.numbers.terms import rows_of


@pytest.fixture(scope="module")
def solution() -> Solution[Mechanism]:
    m = Mechanism("lever")
    crank = m.bar("crank", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.spring("pull", m.ground.at(2, 0), crank.end, stiffness=10.0)
    m.drive_angle("motor", crank, constant_rate(1.0))
    return m.sweep(steps=4)


@pytest.mark.parametrize(
    ("look_up", "message"),
    [
        (lambda sol: sol.forces["pul"], "there is no force 'pul', did you mean 'pull'? There is: pull"),
        (lambda sol: sol.mechanism.bodies["crnk"], "there is no body 'crnk', did you mean 'crank'? There is: ground"),
        (lambda sol: sol.mechanism.joints["B"], "there is no joint 'B'; there is: A"),
        (lambda sol: sol.mechanism.traces["P"], "there is no traced point 'P'; there is: none"),
    ],
)
def test_an_unknown_key_lists_the_known_ones(
    solution: Solution[Mechanism], look_up: Callable[[Any], object], message: str
) -> None:
    with pytest.raises(ModelError, match=re.escape(message)) as caught:
        look_up(solution)
    assert isinstance(caught.value, KeyError)


def undriven() -> Mechanism:
    """A pendulum."""
    m = Mechanism("pendulum")
    m.revolute("A", m.ground.at(0, 0), m.bar("rod", 1.0, mass=1.0).start)
    m.start_near(rod=-90)
    return m


@pytest.mark.parametrize(
    ("look_up", "message"),
    [
        (lambda sol: sol.mechanism.pin, "Mechanism has no attribute 'pin', did you mean 'revolute'?"),
        (lambda sol: sol.mechanism.revolut, "Mechanism has no attribute 'revolut', did you mean 'revolute'?"),
        (lambda sol: sol.body("crank").angle, "FrameView has no attribute 'angle', did you mean 'theta'?"),
        (lambda sol: sol.joint("A").angle, "JointView has no attribute 'angle'; it has: x, y, fx, fy, torque"),
        (lambda sol: sol.bodies, "Solution has no attribute 'bodies', did you mean 'body'?"),
        (lambda sol: sol.mechanism.bodies["crank"].lenght, "Body has no attribute 'lenght', did you mean 'length'?"),
        (lambda sol: sol.mechanism.bodies["crank"].center, "Body has no attribute 'center', did you mean 'com'?"),
        (lambda sol: sol.mechanism.ground.at(0, 0).anlge, "Marker has no attribute 'anlge', did you mean 'angle'?"),
        (lambda sol: sol.mechanism.joints["A"].parms, "Joint has no attribute 'parms', did you mean 'params'?"),
        (lambda sol: sol.stats.step, "Stats has no attribute 'step', did you mean 'steps'?"),
        (lambda sol: sol.mobility.dofs, "Mobility has no attribute 'dofs', did you mean 'dof'?"),
        (lambda sol: undriven().linearise().frequency, "Linearisation has no attribute 'frequency', did you mean"),
        (lambda sol: undriven().equilibrium().soltion, "Equilibrium has no attribute 'soltion', did you mean"),
        (lambda sol: mbsd.Mecanism, "module 'mbsd' has no attribute 'Mecanism', did you mean 'Mechanism'?"),
    ],
)
def test_an_unknown_attribute_suggests_the_one_that_was_meant(
    solution: Solution[Mechanism], look_up: Callable[[Any], object], message: str
) -> None:
    with pytest.raises(AttributeError, match=re.escape(message)):
        look_up(solution)


def test_a_misspelt_argument_is_suggested_beside_options(solution: Solution[Mechanism]) -> None:
    with pytest.raises(ModelError, match=r"there is no option 'durration', did you mean 'duration'\?"):
        solution.mechanism.simulate(durration=3.0)


def test_one_of_a_thing_is_written_without_an_s() -> None:
    m = Mechanism("small")
    m.body("ball", mass=1.0, inertia=1.0)
    assert repr(m) == "<Mechanism small: 1 body, no joints, no drivers>"
    assert "<Solution small: 1 time, t = " in repr(rows_of(m.simulate(0.1, steps=2), np.array([0])))
    m.revolute("A", m.ground.origin, m.bodies["ball"].origin)
    assert repr(m) == "<Mechanism small: 1 body, 1 joint, no drivers>"


def test_unknown_attributes_are_told_after_pickling(solution: Solution[Mechanism]) -> None:
    with pytest.raises(AttributeError) as caught:
        _ = solution.stats.step
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_every_suggested_attribute_exists(solution: Solution[Mechanism]) -> None:
    for thing in (solution, solution.mechanism, solution.body("crank"), solution.mechanism.ground):
        for word, meant in type(thing).other_words.items():
            assert not hasattr(thing, word)
            assert hasattr(thing, meant) or not isinstance(thing, Mechanism | Solution | mbsd.Body), (word, meant)


def test_copies_and_pickles_know_their_names(solution: Solution[Mechanism]) -> None:
    m = solution.mechanism
    for other in (copy.deepcopy(m), pickle.loads(pickle.dumps(m)), pickle.loads(pickle.dumps(solution)).mechanism):
        assert list(other.bodies) == ["ground", "crank"]
        with pytest.raises(ModelError, match="there is no body 'rod'"):
            other.bodies["rod"]
        with pytest.raises(AttributeError, match="did you mean 'revolute'"):
            other.hinge  # noqa: B018


def test_dir_lists_every_public_name() -> None:
    assert set(mbsd.__all__) <= set(dir(mbsd))
    assert not {name for name in dir(mbsd) if not name.startswith("_")} - set(mbsd.__all__)
