"""Names of things and of attributes that do not exist: the error says what there is, and what was probably meant."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable
from typing import Any

import pytest

import mbsd
from mbsd import Mechanism, ModelError, Solution, constant_rate


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


@pytest.mark.parametrize(
    ("look_up", "message"),
    [
        (lambda sol: sol.mechanism.pin, "Mechanism has no attribute 'pin', did you mean 'revolute'?"),
        (lambda sol: sol.mechanism.revolut, "Mechanism has no attribute 'revolut', did you mean 'revolute'?"),
        (lambda sol: sol.body("crank").angle, "FrameView has no attribute 'angle', did you mean 'theta'?"),
        (lambda sol: sol.joint("A").angle, "JointView has no attribute 'angle'; it has: x, y, fx, fy, torque"),
        (lambda sol: sol.bodies, "Solution has no attribute 'bodies', did you mean 'body'?"),
        (lambda sol: mbsd.Mecanism, "module 'mbsd' has no attribute 'Mecanism', did you mean 'Mechanism'?"),
    ],
)
def test_an_unknown_attribute_suggests_the_one_that_was_meant(
    solution: Solution[Mechanism], look_up: Callable[[Any], object], message: str
) -> None:
    with pytest.raises(AttributeError, match=re.escape(message)):
        look_up(solution)


def test_every_suggested_attribute_exists(solution: Solution[Mechanism]) -> None:
    for thing in (solution, solution.mechanism, solution.body("crank")):
        for word, meant in type(thing).other_words.items():
            assert not hasattr(thing, word)
            assert hasattr(thing, meant) or not isinstance(thing, Mechanism | Solution), (word, meant)


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
