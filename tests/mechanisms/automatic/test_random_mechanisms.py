"""Automatic parts of random mechanisms and of machines with many bodies."""

from __future__ import annotations

import json
from collections import Counter
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from mbsd.base.errors import MechanismError
from mechanisms.stages.automatic import decision
from mechanisms.stages.automatic.automatic import Automatic, automatic
from mechanisms.stages.automatic.layout import layers
from mechanisms.stages.automatic.layout.layers import Clauses, Purse, Undecided
from mechanisms.stages.automatic.pins.bridges import Swept
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import meets
from tools.hunt.case import drawn
from tools.hunt.loop import seeds
from tools.hunt_parts import case
from tools.hunt_parts.__main__ import hunt
from tools.hunt_parts.outcome import BUILT, COLLIDES, ERROR, STUCK, UNSOUND, Kept, reason
from tools.models.four_bars import angles, model
from tools.models.linkages import walker

# The search for an order of layers of machines with many bodies: it ends, soon, and says what it found.


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


# Automatic parts for a hundred random mechanisms: an order of layers in which nothing meets, or a reason.


SEED = 4_000_000
KINDS = (
    "four-bar, any lengths",
    "four-bar, crank turns",
    "slider-crank",
    "six-bar and more",
    "six-bar, crank swings",
    "five-bar, two drivers",
    "inverted slider-crank, quick return",
    "yoke",
    "linkage, cranks swing",
    "model of each group",
)
REASONS = ("no order of layers lets", "has no automatic parts", "bends with a radius")


@pytest.mark.slow
def test_a_hundred_random_mechanisms_get_layers_or_a_reason() -> None:
    came: Counter[str] = Counter()
    for k in range(100):
        _, subject, _ = drawn(SEED + k, KINDS[k % len(KINDS)])
        try:
            solution = case.moved(subject, steps=120)
        except MechanismError:
            came[STUCK] += 1
            continue
        made = Automatic(subject.m, solution)
        try:
            _ = made.heights
        except UserError as error:
            told = next((words for words in REASONS if words in str(error)), f"case {SEED + k}: {error}")
            came[told] += 1
            continue
        assert not meets(made), f"case {SEED + k}"
        came[BUILT] += 1
    assert set(came) <= {BUILT, STUCK, *REASONS}, came
    assert came[BUILT] >= 88, came
    assert came["no order of layers lets"] <= 5, came


def test_every_four_bar_whose_crank_turns_gets_an_order() -> None:
    """Crank-rockers and drag links of any proportions (Grashof: s + l < p + q, the shortest is crank or ground)."""
    rng, counted = np.random.default_rng(3), 0
    while counted < 20:
        lengths = tuple(float(x) for x in rng.uniform(0.03, 0.2, 4))
        ordered = sorted(lengths)
        if ordered[0] + ordered[3] > ordered[1] + ordered[2] - 0.004 or ordered[0] not in lengths[:2]:
            continue
        if not np.isfinite(np.concatenate(angles(lengths, np.linspace(0, 6.3, 50)))).all():
            continue
        m = model(lengths)
        made = Automatic(m, m.sweep(times=np.linspace(0, 2 * np.pi, 121)))
        assert set(made.levels) == {"crank", "coupler", "rocker"}
        assert not meets(made)
        counted += 1


# -- the tool ---------------------------------------------------------------------------------------------------------


def test_a_short_hunt_for_parts_writes_its_report(out_root: Path) -> None:
    assert hunt(3, seed=4, jobs=1, kind="four-bar, crank turns", solids=False) == 0
    report = json.loads((out_root / "hunt_parts.json").read_text())
    assert report["solutions"][BUILT] == report["cases"] == 3


@pytest.mark.slow
def test_a_hunt_goes_on_where_it_was_stopped(out_root: Path) -> None:
    asked = {"seed": 4, "jobs": 1, "kind": "four-bar, crank turns", "solids": False}
    hunt(2, **asked)
    (lines,) = (out_root / "hunt_parts").iterdir()
    before = lines.read_bytes()
    first, second = before.splitlines()
    lines.write_bytes(first.replace(b'"sources": "', b'"sources": "x') + b"\n" + second[:20])
    kept = Kept(lines)
    assert [result.seed for result in kept.read(seeds(4, 3))] == [json.loads(first)["seed"]]
    assert kept.others == 1
    hunt(3, **asked)
    told = [json.loads(line) for line in lines.read_bytes().splitlines()]
    assert [record["seed"] for record in told] == list(seeds(4, 3))
    assert told[0]["sources"].startswith("x"), "it is not looked at again"
    assert json.loads((out_root / "hunt_parts.json").read_text())["solutions"][BUILT] == 3
    hunt(1, **asked, anew=True)
    (line,) = lines.read_bytes().splitlines()
    assert json.loads(line)["sources"] == kept.sources


@pytest.mark.slow
def test_one_is_built_and_proven() -> None:
    outcome = case.run(SEED, "slider-crank").outcomes[-1]
    assert outcome.state == BUILT, outcome
    assert "pieces, nearest" in outcome.detail


def test_what_is_wrong_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that puts every plate on one layer; pieces in one another; a plan that fails."""
    from mechanisms.stages.automatic import decision

    def flat(problem: object, _: object) -> dict[str, int]:
        from mechanisms.stages.automatic.layout.layers import choices_of

        return dict.fromkeys([*problem.bodies, *choices_of(problem.items)], 0)

    monkeypatch.setattr(decision, "find_layers", flat)
    assert case.run(SEED, "slider-crank").outcomes[-1].state in (COLLIDES, UNSOUND)
    monkeypatch.setattr(decision, "find_layers", lambda *_: {})
    assert case.run(SEED, "slider-crank").outcomes[-1].state == ERROR


def test_refusals_are_counted_without_names_and_numbers() -> None:
    text = "four: joint 'loop' is a belt, which has no automatic parts yet (there are: revolute)"
    assert reason(text) == "has no automatic parts: belt"
    assert reason("a: no order of layers lets x and y pass each other with pins of 4 mm") == "no order of layers"
    assert reason("a: gears of 'b' with 12.5 mm") == reason("c: gears of 'd' with 3e-2 mm")
