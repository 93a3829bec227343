"""Bodies that no joint shapes: balls and discs whose size tells their mass; weights at the ends of bars."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from mbsd import Mechanism
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.pins.free_bodies import FreeBody
from mechanisms.stages.parts.meshes import mass_of
from shared.contract.materials import MATERIALS


def free(made: Automatic) -> dict[str, FreeBody]:
    return {feature.body: feature for feature in made.layout.features if isinstance(feature, FreeBody)}


def thrown(masses: dict[str, float], apart: float = 0.3, scale: float = 1.0) -> Automatic:
    """Bodies side by side that fly up, and one more that no mechanism is without: their scale."""
    m = Mechanism("thrown", gravity=(0.0, -9.81))
    for k, (name, mass) in enumerate(masses.items()):
        m.body(name, mass, inertia=1e-4)
        m.start_near(**{name: (scale * apart * k, 0, 0)})
        m.start_moving(**{name: (0, 1.0, 0)})
    return Automatic(m, m.simulate(0.2, 40))


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
def test_sizes_tell_masses_apart(scale: float) -> None:
    bodies = free(thrown({"light": 0.3, "heavy": 2.4}, scale=scale))
    assert all(body.is_ball for body in bodies.values())
    assert bodies["heavy"].radius == pytest.approx(2 * bodies["light"].radius)


def test_a_ball_that_may_weighs_what_is_given() -> None:
    made = thrown({"one": 0.1, "other": 0.08}, apart=0.2)
    assert 14 < made.layout.sizes.of_metres((3 * 0.1 / (4 * math.pi * 2700)) ** (1 / 3)) < 20
    for body, mass in (("one", 0.1), ("other", 0.08)):
        solid = made.solids(engraved_too=False)[body][0]
        weight = mass_of(solid.shape.solids().vals()[0], MATERIALS[solid.material].density)
        assert weight.mass == pytest.approx(mass, rel=1e-3)
        assert weight.com == pytest.approx((0.0, 0.0), abs=1e-6)


def test_balls_that_pass_close_are_smaller() -> None:
    made = thrown({"a": 1.0, "b": 1.0, "c": 1.0, "d": 1.0}, apart=0.02)
    bodies = free(made)
    for a, b in combinations(bodies.values(), 2):
        ways = [made.layout.seen(body.body, (body.x, body.y), "ground") for body in (a, b)]
        assert a.radius + b.radius < np.linalg.norm(ways[0] - ways[1], axis=1).min()
    assert set(made.levels.values()) == {0}


def test_what_springs_hold_is_a_disc_with_their_studs() -> None:
    m = Mechanism("hung", gravity=(0.0, -9.81))
    disc = m.body("disc", 0.3, inertia=1e-4)
    m.spring("left", m.ground.at(-0.1, 0.1), disc.at(-0.01, 0), 100.0, free_length=0.08)
    m.spring("right", m.ground.at(0.1, 0.1), disc.at(0.01, 0), 100.0, free_length=0.08)
    m.start_near(disc=(0, 0, 0))
    made = Automatic(m, m.simulate(0.5))
    body = free(made)["disc"]
    assert not body.is_ball
    pieces = made.solids(engraved_too=False)["disc"]
    assert [piece.name for piece in pieces] == ["disc", "stud_left_2", "stud_right_2"]
    box = pieces[0].shape.val().BoundingBox()
    assert box.ymax - box.ymin == pytest.approx(2 * body.radius * made.sizes.scale, rel=0.02)


def test_a_bob_has_its_weight_where_it_is_traced_too() -> None:
    m = Mechanism("bob", gravity=(0.0, -9.81))
    rod = m.bar("rod", 0.3, 0.5, com=(0.3, 0), inertia=0.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.trace("tip", rod.end)
    m.start_near(rod=-60)
    names = [piece.name for piece in Automatic(m, m.simulate(0.2)).solids(engraved_too=False)["rod"]]
    assert "weight_rod" in names
    assert not [name for name in names if name.startswith(("stylus", "point"))]
