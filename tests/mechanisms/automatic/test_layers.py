"""The order of layers: rules of the layout, and the search."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.body_shapes import body_shape
from mechanisms.stages.automatic.layout.items import TOP, Item, PinReach, PivotReach, Reach, span, spans_meet
from mechanisms.stages.automatic.layout.layers import Problem, blocking, choices_of, find_layers
from mechanisms.stages.automatic.layout.plan import KINDS
from mechanisms.stages.automatic.layout.planar import Rounded, around, convex_hull, core_gaps, disc, least_gap, placed
from mechanisms.stages.automatic.layout.sizes import sizes, standard
from mechanisms.stages.automatic.pins.bridges import Bridge
from mechanisms.stages.automatic.pins.pins import Pin
from shared.shapes.link import Eye
from shared.stage.errors import UserError
from tests.shared.shape_checks import checked
from tools.models.linkages import crank_shaper, drag_link, four_bar, hands, jansen_leg, lift, slider_crank, watt

# Automatic parts before they are built: sizes, gaps in the plane, the order of layers. No CAD.


def _samples(core: np.ndarray, count: int = 60) -> np.ndarray:
    """Points on all sides of a core."""
    if len(core) == 1:
        return core
    u = np.linspace(0, 1, count)[:, None]
    return np.concatenate([(1 - u) * a + u * b for a, b in zip(core, np.roll(core, -1, axis=0), strict=True)])


def test_gaps_of_polygons_agree_with_many_points_on_their_sides() -> None:
    rng = np.random.default_rng(5)
    for _ in range(200):
        a = convex_hull(rng.normal(size=(rng.integers(1, 7), 2)))
        b = convex_hull(rng.normal(size=(rng.integers(1, 7), 2))) + rng.uniform(-4, 4, 2)
        gap = float(core_gaps(a[None], b[None])[0])
        sampled = np.linalg.norm(_samples(a)[:, None] - _samples(b)[None], axis=2).min()
        if gap > 0:
            assert gap <= sampled + 1e-9
            assert sampled < gap + 0.15
        else:  # they overlap: sides cross, or one holds a corner of the other
            inside = [p for p in _samples(b) if len(a) > 2 and len(convex_hull(np.vstack([a, p]))) == len(a)]
            inside += [p for p in _samples(a) if len(b) > 2 and len(convex_hull(np.vstack([b, p]))) == len(b)]
            assert inside or sampled < 0.15


@given(st.floats(0.5, 50.0), st.floats(0.5, 50.0), st.floats(0.5, 50.0), st.booleans())
def test_bars_one_behind_the_other_on_a_line_do_not_meet(apart: float, first: float, second: float, away: bool) -> None:
    """The world turned, rounding puts their ends on either side of the line."""
    turns = np.linspace(-np.pi, np.pi, 300)
    still = np.zeros_like(turns)
    poses_a, poses_b = (np.column_stack([still, still, turns + turn]) for turn in (0.0, np.pi if away else 0.0))
    ends = (-apart, -apart - second) if away else (2 * apart + first, 2 * apart + first + second)
    a = placed(np.array([[apart, 0.0], [apart + first, 0.0]]), poses_a)
    b = placed(np.array([[-end if away else end, 0.0] for end in ends]), poses_b)
    assert np.allclose(core_gaps(a, b), 2 * apart if away else apart, rtol=1e-9)


def test_the_least_gap_is_found_over_the_motion() -> None:
    """A disc on an arm passes a fixed one at the angle where the arm points at it."""
    angle = np.linspace(0, 2 * np.pi, 721)
    turning = np.column_stack([np.zeros_like(angle), np.zeros_like(angle), angle])
    still = np.zeros_like(turning)
    arm, post = Rounded(np.array([[10.0, 0.0]]), 1.0), Rounded(np.array([[0.0, 14.0]]), 2.0)
    gap, at = least_gap(arm, post, (turning, still), 0.9)
    assert gap == pytest.approx(1.0)
    assert angle[at] == pytest.approx(np.pi / 2)


def test_sizes_follow_the_mechanism() -> None:
    assert standard(7.9) == 6
    assert standard(0.1) == 0.5
    assert standard(430.0) == 400
    clockwork, desk, excavator = (sizes(*s)[0] for s in ((0.004, 0.020), (0.04, 0.17), (0.6, 3.0)))
    assert [s.pin for s in (clockwork, desk, excavator)] == [1.0, 8.0, 120.0]
    for s in (clockwork, desk, excavator):
        running = s.pivot.fit.running * s.scale
        assert 0.15 < running < 0.7, "a fit that a workshop can make"
        assert s.screw <= 4.0 * s.scale, "a screw that fits into a pedestal's flange, or none"
        assert s.pivot.bushing > s.pivot.pin + s.pivot.fit.running + 1.0, "a bushing has a wall"


def _planned(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep())


def _clear(made: Automatic) -> None:
    """No two items of different bodies at one height meet: seen anew, by points on their sides at every third pose."""
    layout, levels = made.layout, made.decided

    def clouds(item: Item) -> np.ndarray:
        points, pose = _samples(item.shape.core, 40), layout.poses[item.body][::3]
        c, s = np.cos(pose[:, 2:]), np.sin(pose[:, 2:])
        x = pose[:, :1] + c * points[:, 0] - s * points[:, 1]
        return np.stack([x, pose[:, 1:2] + s * points[:, 0] + c * points[:, 1]], axis=2)

    for first, second in combinations(layout.items, 2):
        designed = first.body == second.body or first.body in second.spares or second.body in first.spares
        designed = designed or first.what in second.meshes or second.what in first.meshes
        if designed or not spans_meet(span(first.reach, levels), span(second.reach, levels)):
            continue
        a, b = clouds(first), clouds(second)
        apart = min(float(np.linalg.norm(p[:, None] - q[None], axis=2).min()) for p, q in zip(a, b, strict=True))
        assert apart > first.shape.radius + second.shape.radius, f"{first.what} meets {second.what}"


KNOWN = {"watt": (watt, 2), "jansen": (jansen_leg, 5), "slider": (slider_crank, 2), "shaper": (crank_shaper, 3)}


@pytest.mark.parametrize(("build", "layers"), KNOWN.values(), ids=KNOWN.keys())
def test_known_linkages_get_few_layers(build: object, layers: int) -> None:
    made = _planned(build())
    assert max(made.levels.values()) + 1 == layers
    _clear(made)


def test_heights_leave_room_for_what_is_between_the_layers() -> None:
    made = _planned(jansen_leg())
    pivot = made.sizes.pivot
    for low, high in zip(made.heights.bottoms, made.heights.bottoms[1:], strict=False):
        assert high - low - made.sizes.thickness >= pivot.washer_room + pivot.fit.axial + pivot.flange_room - 1e-9


def test_a_pin_hangs_where_a_rail_is_above_it() -> None:
    """The shaper's block slides under its lever: its pin can have no head, and is kept below the crank."""
    made = _planned(crank_shaper())
    assert made.levels["crank"] < made.levels["block"] < made.levels["lever"]
    assert made.decided["pin P"] == 1
    assert made.decided["pin Q"] == 0


def test_a_layer_that_is_asked_for_is_given() -> None:
    made = _planned(four_bar(0.12, 0.04, 0.12, 0.09))
    made.layer("rocker", 2)
    assert made.levels["rocker"] == 2
    _clear(made)


def test_bodies_that_cannot_pass_each_other_are_named() -> None:
    """One hand can turn on the base and one under a bridge; a third has no place between these."""
    with pytest.raises(UserError) as refused:
        _ = _planned(hands()).levels
    text = str(refused.value)
    assert "no order of layers lets hand0, hand1 and hand2 pass each other with pins of 5 mm" in text
    assert text.count(" on ground meets hand") == 4


@pytest.mark.parametrize("build", [drag_link, lambda: hands(2)], ids=["drag link", "two hands"])
def test_a_pivot_that_is_swept_from_all_sides_hangs_from_a_bridge(build: object) -> None:
    """Each of the two sweeps over the other's pivot: one stands on the base, below, and one hangs from above."""
    made = _planned(build())
    _clear(made)
    assert made.sizes.pin == made.wishes()[0].pin
    (bridge,) = made.layout.select(Bridge)
    (hanging,) = bridge.pins
    assert made.decided[hanging.choice] == 1
    assert sum(made.decided[f"pin {name}"] for name in made.m.joints) == 1
    posts = [Item("a post", "ground", disc(*end, 10.0), Reach((), base=True, top=True)) for end in bridge.ends]
    for item in made.layout.items:
        if item.body != "ground":
            assert min(made.layout.gap(item, post)[0] for post in posts) > 4.0, item.what
    (x0, y0), (x1, y1), (x, y) = *bridge.ends, hanging.places["ground"]
    assert abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) < 1e-6 * math.hypot(x1 - x0, y1 - y0)


def test_the_pivot_that_is_driven_stands() -> None:
    made = _planned(drag_link())
    assert (made.decided["pin A"], made.decided["pin D"]) == (0, 1)


def test_pins_are_thinner_where_thick_ones_leave_no_order() -> None:
    """A lift of two crosses, and one of three."""
    for crosses, wish, pin, layers in ((2, 12.0, 12.0, 3), (3, 20.0, 12.0, 3)):
        made = _planned(lift(crosses))
        assert (made.wishes()[0].pin, made.sizes.pin) == (wish, pin)
        assert max(made.levels.values()) + 1 == layers
        assert not any(isinstance(feature, Bridge) for feature in made.layout.features)


def test_a_kind_without_parts_is_refused_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(KINDS, "distance")
    m = Mechanism("rodded")
    a, b = m.bar("a", 0.05), m.bar("b", 0.05)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", m.ground.at(0.2, 0), b.start)
    m.distance("rod", a.end, b.end, length=0.2)
    m.start_near(a=90, b=90)
    m.drive_angle("motor", a, lambda t: math.pi / 2 + 0.1 * t)
    with pytest.raises(UserError, match="joint 'rod' is a distance, which has no automatic parts yet"):
        _ = Automatic(m, m.sweep(1.0)).levels


def test_the_outline_holds_all_eyes() -> None:
    shape = around([(0, 0), (10, 0), (10, 10), (3, 2)], 2.0)
    assert len(shape.core) == 3
    assert math.isclose(shape.reach[1], math.hypot(5, 5) + 2.0)


def test_pins_that_end_on_both_sides_of_an_empty_layer_do_not_meet_in_it() -> None:
    """The slider passes close under the crank's axis, whose pin hangs from a bridge: both pins reach into layer 2."""
    m = Mechanism("close")
    crank, rod, slider = m.bar("crank", 0.271), m.bar("rod", 0.296), m.body("slider")
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0.005), slider.origin)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.start_near(crank=0, rod=5, slider=0)
    made = Automatic(m, m.sweep())
    layout = made.layout
    pins = {feature.name: feature for feature in layout.select(Pin)}
    upper, lower = pins["A"], pins["C"]
    levels = {**made.decided, "crank": 3, "rod": 1, "slider": 0, upper.choice: 1, lower.choice: 0}
    room = {need.gap: need.height for pin in (upper, lower) for need in pin.needs(levels, layout)}
    assert room[1] >= made.sizes.end_room
    assert room[2] >= made.sizes.clip_room
    levels["crank"] = 5  # with two empty layers between them they are far enough from each other
    assert 1 not in {need.gap for need in lower.needs(levels, layout)}


@pytest.mark.parametrize(
    "eyes",
    [
        [(5.0, 0.0, 13.0), (177.417, 20.293, 9.0), (225.338, 25.101, 9.0)],
        [(0.0, 0.0, 13.0), (474.018, 0.0, 13.0), (477.943, 26.412, 12.5)],
        [(0.0, 0.0, 13.0), (203.371, 0.0, 12.5), (156.945, -140.65, 9.0), (172.253, -95.405, 9.0)],
    ],
)
@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_plates_round_eyes_that_others_nearly_hold_are_sound(eyes: list[tuple[float, ...]], turn: float) -> None:
    """An eye within the hull of the others' circles is no corner of it; flat triangles have no waists."""
    c, s = math.cos(turn), math.sin(turn)
    placed = [(c * x - s * y, s * x + c * y, Eye(r, 8.0)) for x, y, r in eyes]
    shape, holes = body_shape(placed, 7.0)
    checked(shape, holes)
    assert holes == len(eyes)


# The search for an order of layers, on items without shapes: against all orders, and with many bodies.


def test_a_long_chain_lies_in_three_layers() -> None:
    """Each of a hundred links meets the next two at most: not every one lies on a layer of its own."""
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
