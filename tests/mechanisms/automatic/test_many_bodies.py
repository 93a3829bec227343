"""The search for an order of layers of machines with many bodies: it ends, soon, and says what it found."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from mechanisms.stages.automatic import decision
from mechanisms.stages.automatic.automatic import automatic
from mechanisms.stages.automatic.layout import layers
from mechanisms.stages.automatic.layout.layers import Clauses, Purse, Undecided
from mechanisms.stages.automatic.pins.bridges import Swept
from shared.stage.errors import UserError
from tests.mechanisms.automatic.layouts import meets
from tools.models.linkages import walker

LEGS = 8


def test_eight_legs_beside_each_other_have_an_order() -> None:
    m = walker(LEGS, apart=0.2)
    assert len(m.bodies) == 1 + 7 * LEGS
    made = automatic(m, solution=m.sweep(1.0, 120))
    assert meets(made) == []
    assert max(made.levels.values()) == 4


def test_what_has_no_order_is_not_searched_with_every_number_of_layers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four legs on one shaft: whether there is any order is asked once for each size and device, and all else never."""
    asked: list[int] = []
    within = layers._within
    monkeypatch.setattr(
        layers, "_within", lambda problem, count, *rest: asked.append(count) or within(problem, count, *rest)
    )
    m = walker(4)
    with pytest.raises(UserError, match=r"no order of layers lets .* pass each other"):
        automatic(m, solution=m.sweep(1.0, 120)).levels  # noqa: B018
    assert asked == []


def test_gaps_of_layouts_that_differ_in_a_web_are_computed_once() -> None:
    m = walker(2)
    made = automatic(m, solution=m.sweep(1.0, 120))
    layout = made._layout(made.wishes()[-1], decision.Springs())
    layout.conflicts  # noqa: B018
    known = len(layout.known_gaps)
    assert known > 0
    flushed = layout.with_far_posts()
    flushed.conflicts  # noqa: B018
    assert flushed.known_gaps is layout.known_gaps
    assert len(layout.known_gaps) == known


def test_a_purse_that_is_empty_leaves_a_question_undecided() -> None:
    """Nine things do not fit into eight places, which a solver finds out by trying."""
    clauses = Clauses({}, [], 1)
    places = [[clauses.new() for _ in range(8)] for _ in range(9)]
    for own in places:
        clauses.add(*own)
    for column in zip(*places, strict=True):
        for a, b in combinations(column, 2):
            clauses.add(-a, -b)
    purse = Purse(200)
    with pytest.raises(Undecided):
        purse.solved(clauses)
    assert purse.left <= 0
    assert not Purse().solved(clauses)


def test_a_search_that_was_given_up_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def given_up(*_: object) -> None:
        raise Undecided

    monkeypatch.setattr(decision, "find_layers", given_up)
    m = walker(2, apart=0.2)
    with pytest.raises(UserError, match=r"14 bodies and \d+ places where something meets was given up .*made\.layer"):
        automatic(m, solution=m.sweep(1.0, 60)).levels  # noqa: B018


def test_of_swept_discs_the_one_that_a_ray_leaves_last_is_kept() -> None:
    """Against all of them, in random directions from random places."""
    rng = np.random.default_rng(5)
    discs = np.column_stack([rng.normal(0, 200, (4000, 2)), rng.choice([5.0, 14.2, 20.0], 4000)])
    swept = Swept(discs, few=0)
    for angle in rng.uniform(0, 7, 60):
        at, way = rng.normal(0, 150, 2), np.array([np.cos(angle), np.sin(angle)])
        some = swept.outermost(at, way)
        assert _last(some, at, way) == pytest.approx(_last(discs, at, way), abs=1e-9)
        assert len(some) < len(discs) / 10


def _last(discs: np.ndarray, at: np.ndarray, way: np.ndarray) -> float:
    seen = discs[:, :2] - at
    along, aside = seen @ way, seen @ np.array([-way[1], way[0]])
    inside = np.abs(aside) < discs[:, 2]
    return float((along + np.sqrt(np.maximum(discs[:, 2] ** 2 - aside**2, 0.0)))[inside].max(initial=0.0))
