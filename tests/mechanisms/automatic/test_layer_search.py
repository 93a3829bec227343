"""The search for an order of layers, on items without shapes: against all orders, and with many bodies."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, product

from hypothesis import given, settings
from hypothesis import strategies as st

from mechanisms.stages.automatic.layout.items import TOP, Item, PinReach, PivotReach, Reach, span, spans_meet
from mechanisms.stages.automatic.layout.layers import Problem, blocking, choices_of, find_layers
from mechanisms.stages.automatic.layout.planar import disc


def test_a_long_chain_lies_in_three_layers() -> None:
    """Of a hundred links each meets the next two at most: not every one lies on a layer of its own."""
    count, bodies = 100, [f"link{k}" for k in range(100)]
    plates = [Item(body, body, disc(0, 0, 1), Reach((body,))) for body in bodies]
    pins = [
        Item(f"pin{k}", bodies[k], disc(0, 0, 1), PinReach((bodies[k], bodies[k + 1]), f"pin{k}"))
        for k in range(count - 1)
    ]
    conflicts = [(k, k + 1) for k in range(count - 1)]
    # plates meet the pins beside their own, and pins each other
    conflicts += [(k, count + k + 1) for k in range(count - 2)] + [(k + 2, count + k) for k in range(count - 2)]
    levels = find_layers(Problem(bodies, [*plates, *pins], conflicts))
    assert levels is not None
    assert max(levels[body] for body in bodies) == 2
    items = [*plates, *pins]
    assert not any(spans_meet(span(items[i].reach, levels), span(items[j].reach, levels)) for i, j in conflicts)


@st.composite
def problems(draw: st.DrawFn) -> Problem:
    """Two or three bodies, with plates, pins, ground pivots and rails that meet at random."""
    bodies = [f"b{k}" for k in range(draw(st.integers(2, 3)))]
    items = [Item(body, body, disc(0, 0, 1), Reach((body,))) for body in bodies]
    for k in range(draw(st.integers(0, 4))):
        pair = tuple(draw(st.permutations(bodies))[:2])
        kind, mover = draw(st.sampled_from(["pin", "pivot", "rail", "tall"])), pair[0]
        reach = {
            "pin": PinReach(pair, f"c{k}"),
            "pivot": PivotReach((mover,), f"c{k}"),
            "rail": Reach((mover,), -1, -1, base=True),
            "tall": Reach((mover,), 1, top=True),
        }[kind]
        items.append(Item(f"{kind}{k}", mover if kind == "tall" else "ground", disc(0, 0, 1), reach))
    pairs = [
        (i, j)
        for i, j in combinations(range(len(items)), 2)
        if not set(items[i].reach.bodies) & set(items[j].reach.bodies) or (i < len(bodies) and j < len(bodies))
    ]
    chosen = draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []
    together = [tuple(bodies[:2])] if draw(st.booleans()) and (0, 1) not in chosen else []
    pivots = [item.reach.choice for item in items if isinstance(item.reach, PivotReach)]
    hanging = [choice for choice in pivots if draw(st.booleans())]
    return Problem(bodies, items, chosen, together=together, hanging=frozenset(hanging))


@given(problems())
@settings(deadline=None, max_examples=150)
def test_the_order_is_the_best_of_all(problem: Problem) -> None:
    """Against every layer and every choice: whether there is one, bridges, layers, lengths of pins."""
    choices = choices_of(problem.items)
    best = None
    for count in range(1, 2 * len(problem.bodies) + 1):  # two steps between any two are enough
        for code in product(range(count), repeat=len(problem.bodies)):
            for chosen in product((0, 1), repeat=len(choices)):
                levels = dict(zip([*problem.bodies, *choices], code + chosen, strict=True))
                rank = _rank(problem, levels)
                if rank is not None and (best is None or rank < best):
                    best = rank
        if best is not None and best[0] == 0:
            break
    layers = find_layers(problem)
    assert (layers is None) == (best is None)
    if layers is not None:
        assert _rank(problem, layers) == best


def _rank(problem: Problem, levels: dict[str, int]) -> tuple[int, ...] | None:
    """Bridges, layers, lengths; None if it breaks a rule."""
    items, pivots = problem.items, [k for k in problem.items if isinstance(k.reach, PivotReach)]
    hanging = {pivot.reach.choice for pivot in pivots if levels[pivot.reach.choice] == 1}
    if hanging - problem.hanging:
        return None
    if any(levels[a] != levels[b] for a, b in problem.together):
        return None
    if any(spans_meet(span(items[i].reach, levels), span(items[j].reach, levels)) for i, j in problem.conflicts):
        return None
    top = max(levels[body] for body in problem.bodies)
    length = 0
    for item in items:
        taken = span(item.reach, levels)
        assert taken is not None
        low, high = taken
        if high == TOP and not isinstance(item.reach, PivotReach):
            continue
        length += ((2 * top + 1 if high == TOP else high) - low) // 2
    return len(hanging), top, length


@given(problems())
@settings(deadline=None, max_examples=60)
def test_what_blocks_is_needed(problem: Problem) -> None:
    """Where there is no order, the conflicts that are named leave none, and without any one of them there is one."""
    if find_layers(problem) is not None:
        return
    named = blocking(problem, list(problem.conflicts))
    assert named
    assert find_layers(replace(problem, conflicts=named)) is None
    for conflict in named:
        assert find_layers(replace(problem, conflicts=[other for other in named if other != conflict])) is not None


def test_a_layer_that_is_asked_for_is_given_however_high() -> None:
    plates = [Item(body, body, disc(0, 0, 1), Reach((body,))) for body in ("a", "b")]
    layers = find_layers(Problem(["a", "b"], plates, [(0, 1)], fixed={"a": 7}))
    assert layers == {"a": 7, "b": 0}
