"""Blocks along one line: on one rail where they never meet, on rails one above the other where they pass."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, RAIL, Slide
from tests.mechanisms.automatic.layouts import meets
from tests.shared.shape_checks import checked


def masses(count: int = 2, apart: float = 0.2, turn: float = 0.0, backwards: bool = False) -> Mechanism:
    """Coupled oscillators on a track; of each second one the rail's marker may point the other way."""
    m = Mechanism("masses", gravity=None)
    c, s = math.cos(turn), math.sin(turn)
    before = m.ground.at(0, 0, turn)
    for k in range(count):
        block = m.body(f"mass_{k}", mass=1.0, inertia=1e-3)
        flip = math.pi if backwards and k % 2 else 0.0
        m.prismatic(f"rail_{k}", m.ground.at(0, 0, turn + flip), block.at(0, 0, flip))
        m.spring(f"spring_{k}", before, block.origin, stiffness=100.0, free_length=apart, damping=0.2)
        before = block.origin
        at = apart * (k + 1) + (0.2 * apart if k == 0 else 0.0)
        m.start_near(**{f"mass_{k}": (c * at, s * at, math.degrees(turn))})
    return m


def carts(second: float, phase: float, limits: tuple[float, float] | None = None) -> Mechanism:
    """Two carts that drivers move along one line."""
    m = Mechanism("carts")
    for name, centre, begin in (("first", -second, 0.0), ("second", second, phase)):
        cart = m.body(name)
        m.prismatic(f"rail_{name}", m.ground.origin, cart.origin, limits=limits if name == "first" else None)
        m.drive_coordinate(f"drive_{name}", m.ground.origin, cart.origin, harmonic(0.1, 2 * math.pi, begin, centre))
    return m


def beads() -> Mechanism:
    """Three beads that follow each other to and fro on a rod that turns."""
    m = Mechanism("beads")
    rod = m.bar("rod", 0.5)
    m.revolute("O", m.ground.origin, rod.at(0.25, 0))
    for k in range(3):
        bead = m.body(f"bead_{k}")
        m.prismatic(f"on_{k}", rod.at(0.25, 0), bead.origin)
        m.drive_coordinate(f"drive_{k}", rod.at(0.25, 0), bead.origin, harmonic(0.1, 12.0, 0.0, 0.12 * (k - 1)))
    m.drive_angle("drive", rod, constant_rate(6.0))
    return m


def slides(made: Automatic) -> list[Slide]:
    return [feature for feature in made.layout.features if isinstance(feature, Slide)]


def rails(made: Automatic) -> list[str]:
    """Names of the rails that are built, which are sound."""
    built = [solid for solids in made.plan().solids.values() for solid in solids if solid.name.startswith("rail_")]
    for solid in built:
        checked(solid.shape, solid.through_holes)
    return [solid.name for solid in built]


@settings(max_examples=10, deadline=None)
@given(st.integers(2, 4), st.floats(0.05, 0.5), st.floats(-3.0, 3.0), st.booleans())
def test_coupled_masses_have_room_and_rails_that_do_not_overlap(
    count: int, apart: float, turn: float, backwards: bool
) -> None:
    m = masses(count, apart, turn, backwards)
    solution = m.simulate(1.0, steps=60)
    made = Automatic(m, solution)
    assert len({made.levels[f"mass_{k}"] for k in range(count)}) == 1
    assert not meets(made)
    by_name = {slide.name: slide for slide in slides(made)}
    own = [slide for slide in by_name.values() if not slide.host]
    assert rails(made) == [f"rail_{slide.name}" for slide in own]
    way = np.array([math.cos(turn), math.sin(turn)])
    spans = {slide.name: sorted(np.array(slide.rail_ends()) @ way) for slide in own}
    for k in range(count):
        low, high = spans[by_name[f"rail_{k}"].host or f"rail_{k}"]
        along = made.layout.seen(f"mass_{k}", (0.0, 0.0), "ground") @ way
        assert low - 1e-6 <= along.min() - HALF_LENGTH
        assert along.max() + HALF_LENGTH <= high + 1e-6
    ends = sorted(spans.values())
    assert all(high + RAIL < low for (_, high), (low, _) in pairwise(ends))


def test_a_rod_that_turns_has_one_rail_for_its_beads() -> None:
    m = beads()
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert not meets(made)
    host, *guests = slides(made)
    assert [guest.name for guest in host.guests] == [guest.name for guest in guests] == ["on_1", "on_2"]
    assert len({made.levels[f"bead_{k}"] for k in range(3)}) == 1
    assert rails(made) == ["rail_on_0"]


def test_carts_that_pass_each_other_run_on_rails_one_above_the_other() -> None:
    m = carts(0.05, math.pi)
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert made.levels["first"] != made.levels["second"]
    assert not meets(made)
    assert rails(made) == ["rail_rail_first", "rail_rail_second"]
    (a, b), (c, d) = (sorted(x for x, _ in slide.rail_ends()) for slide in slides(made))
    assert c < a < b < d, "posts of the higher rail stand beyond the lower one"


def test_carts_that_follow_each_other_share_a_rail_unless_a_stop_is_on_it() -> None:
    """Their ways overlap, but they are never in one place."""
    m = carts(0.06, 0.3)
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert [slide.host for slide in slides(made)] == ["", "rail_first"]
    assert made.levels["first"] == made.levels["second"]
    m = carts(0.06, 0.3, limits=(-0.2, 0.1))
    stopped = Automatic(m, m.sweep(1.0, steps=120))
    assert [slide.host for slide in slides(stopped)] == ["", ""]
    assert stopped.levels["first"] != stopped.levels["second"]
    assert not meets(stopped)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.06, 0.6))
def test_carts_that_never_meet_are_never_one_above_the_other(second: float) -> None:
    m = carts(second, 0.0)
    made = Automatic(m, m.sweep(1.0, steps=20))
    assert made.levels["first"] == made.levels["second"]
    left, right = slides(made)
    if not right.host:
        (_, b), (c, _) = (sorted(x for x, _ in slide.rail_ends()) for slide in (left, right))
        assert b + RAIL < c


@pytest.mark.parametrize("second", [0.3, 1.0])
def test_carts_far_from_each_other_have_rails_of_their_own(second: float) -> None:
    m = carts(second, 0.0)
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert not meets(made)
    assert rails(made) == ["rail_rail_first", "rail_rail_second"]
    (_, b), (c, _) = (sorted(x for x, _ in slide.rail_ends()) for slide in slides(made))
    assert b < c
