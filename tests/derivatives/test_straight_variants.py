"""Mechanisms whose arrays go on straight are those that are packed with the other number."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mbsd
from benchmarks.derivatives import linkage
from mbsd.derivatives import simulations
from mbsd.derivatives.numbers.near_numbers import variants_beside
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variants
from mbsd.equations.loads import Loads
from mbsd.numbers.names import Number
from mbsd.numbers.placed import PLACES

ARRAYS = ("mass", "inertia", "gravity", *PLACES)
LOADS = ("place", "number", "given", "user_com", "friction_number")
NUMBERS = [
    "a.mass", "a.length", "b.length", "b.inertia", "b.com.y", "D.x", "B.j.y", "a.A.angle", "s.stiffness", "s.i.x",
    "s.free_length", "P.x", "gravity.x", "a.moving.omega", "a.start.angle",
]  # fmt: skip
"""Of masses, lengths, places, forces, a traced point, gravity and the start."""


def _places(joints: Any) -> list[Any]:
    return [(marker.body.name, marker.x, marker.y, marker.angle) for each in joints for marker in (each.i, each.j)]


def test_they_are_those_that_are_packed(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[Number, Variants, Variants]] = []

    def beside(variation: Any, numbers: Any, known: Any) -> list[Variants]:
        made = variants_beside(variation, numbers, known)
        for number, straight, near in zip(numbers, made, known, strict=True):
            assert near is not None, number.name
            seen.append((number, straight, variation.of(number, SECOND, TINY, starts=False)))
        return made

    monkeypatch.setattr(simulations, "variants_beside", beside)
    m = linkage()
    m.trace("P", m.bodies["b"].at(0.05, 0.02))
    m.torsion_spring("t", m.bodies["a"], m.bodies["b"], stiffness=0.3)
    m.sensitivities(["A.fx", "potential"], NUMBERS, 0.05, 4)
    assert [number.name for number, _, _ in seen] == NUMBERS
    for number, straight, packed in seen:
        for mine, other in zip(straight.variants, packed.variants, strict=True):
            mine_packed, other_packed = mine.terms.packed, other.terms.packed
            on_ground = mine_packed.system.marker_body == 0
            for name in ARRAYS:
                _close(getattr(mine_packed.system, name), getattr(other_packed.system, name), number)
            for name in ("arm", "position", "axis"):  # of markers on ground
                _close(getattr(mine_packed.ws, name)[on_ground], getattr(other_packed.ws, name)[on_ground], number)
            _close(mine_packed.com, other_packed.com, number)
            _close(mine.terms.inertia, other.terms.inertia, number)
            _close(mine.terms.weight, other.terms.weight, number)
            assert isinstance(mine.terms.loads, Loads)
            for name in LOADS:
                _close(getattr(mine.terms.loads, name), getattr(other.terms.loads, name), number)
            assert _places(mine_packed.joints) == _places(other_packed.joints)
            assert _places(mine_packed.forces) == _places(other_packed.forces)
            assert [force.params for force in mine_packed.forces] == [force.params for force in other_packed.forces]
            assert {key: (p.x, p.y) for key, p in mine.traces.items()} == {
                key: (p.x, p.y) for key, p in other.traces.items()
            }
            flags = "same_places", "same_masses", "same_loads"
            assert [getattr(mine, flag) for flag in flags] == [getattr(other, flag) for flag in flags], number.name


def _close(a: np.ndarray, b: np.ndarray, number: Number) -> None:
    scale = max(1e-9, float(np.abs(b).max(initial=0.0)))
    np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-9 * scale, err_msg=number.name)


def test_slopes_of_reactions_are_those_of_whole_simulations() -> None:
    m, h = linkage(), 1e-5
    m.torsion_spring("t", m.bodies["a"], m.bodies["b"], stiffness=0.3)
    asked = ["A.fx", "C.fy", "B.x", "potential"]
    numbers = {"a.length": ("a", "length"), "s.stiffness": ("s", "stiffness"), "b.mass": ("b", "mass")}
    slopes = m.sensitivities(asked, list(numbers), 0.2, 8, tolerance=1e-11)
    for name, (thing, key) in numbers.items():
        value = getattr(m.bodies[thing], key) if thing in m.bodies else m.forces[thing].params[key]
        sides = []
        for side in (1.0, -1.0):
            m.change(thing, **{key: value * (1.0 + side * h)})
            sol = m.simulate(0.2, steps=8, tolerance=1e-13)
            joints = sol.joint("A").fx, sol.joint("C").fy, sol.joint("B").x
            sides.append(dict(zip(asked, (*joints, sol.energy.potential), strict=True)))
        m.change(thing, **{key: value})
        for label in asked:
            truth = (sides[0][label] - sides[1][label]) / (2 * h * value)
            scale = np.abs(truth).max()
            np.testing.assert_allclose(slopes.of(label, name), truth, rtol=0.0, atol=2e-6 * scale, err_msg=name)


@pytest.mark.parametrize("name", ["joint A.fx", "potential"])
def test_a_joint_has_the_name_of_a_body(name: str) -> None:
    """Names that are clear need no motion to be known; the others are looked for in mine_packed."""
    m = mbsd.Mechanism("twin")
    rod = m.bar("A", 0.3, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(A=20)
    slopes = m.sensitivities([name], ["A.mass"], 0.1, 3)
    assert np.abs(slopes[name]).max() > 0.1
    with pytest.raises(mbsd.ModelError, match=r"no quantity 'A\.fx'"):
        m.sensitivities(["A.fx"], ["A.mass"], 0.1, 3)
