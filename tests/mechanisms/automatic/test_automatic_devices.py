"""What lets links pass that bars on pedestals do not: pivots sunk into their link, cranks of two webs."""

from __future__ import annotations

from functools import cache

import numpy as np

from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.items import Item, Reach
from mechanisms.stages.automatic.layout.layers import Problem, find_layers
from mechanisms.stages.automatic.layout.motion import TURN, poses_of, times_of
from mechanisms.stages.automatic.layout.planar import disc
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.solve.solving import CLOSE, swept_closely
from tests.mechanisms.automatic.layouts import meets
from tests.mechanisms.automatic.test_parts_of_random import KINDS, SEED
from tools.hunt.case import drawn
from tools.hunt_parts import case
from tools.hunt_parts.outcome import BUILT
from tools.models.four_bars import model

SUNK, WEBS = 46, 73


@cache
def made(number: int) -> Automatic:
    """Of one of the hundred random mechanisms."""
    _, subject, _ = drawn(SEED + number, KINDS[number % len(KINDS)])
    return Automatic(subject.m, case.moved(subject, steps=120))


def test_a_block_passes_over_a_pivot_that_is_sunk_into_its_guide() -> None:
    automatic = made(SUNK)
    (pivot,) = (
        pin
        for pin in automatic.layout.features
        if isinstance(pin, Pin) and pin.is_flush(automatic.decided, automatic.layout)
    )
    (guide,) = pivot.movers
    assert not meets(automatic)
    solids = automatic.plan().solids
    top = automatic.heights.top(guide)
    (shaft,) = (solid for solid in solids["ground"] if solid.name == f"pin_{pivot.name}".replace(" ", "_"))
    assert top - 0.5 < shaft.shape.val().BoundingBox().zmax < top
    assert not any(solid.name.startswith(f"circlip_{pivot.name}") for solid in solids["ground"])


def test_a_crank_of_two_webs_carries_a_rod_on_either_side() -> None:
    automatic = made(WEBS)
    assert not meets(automatic)
    ((web, body),) = automatic.layout.webs.items()
    (joining,) = (pin for pin in automatic.layout.features if isinstance(pin, Pin) and pin.webs)
    between = [automatic.levels[b] for b in joining.movers if b not in (web, body)]
    low, high = sorted((automatic.levels[web], automatic.levels[body]))
    assert low < min(between) <= max(between) < high
    for other in (pin for pin in automatic.layout.features if isinstance(pin, Pin) and pin is not joining):
        assert not {web, body} <= set(other.places), "no other pin is on both"
    (pin,) = (
        solid
        for solids in automatic.plan().solids.values()
        for solid in solids
        if solid.name == f"pin_{joining.name}".replace(" ", "_")
    )
    box, ends = pin.shape.val().BoundingBox(), sorted((web, body), key=automatic.levels.__getitem__)
    assert automatic.heights.bottom(ends[0]) < box.zmin
    assert box.zmax < automatic.heights.top(ends[1])


def test_a_sunk_pivot_is_built_and_proven() -> None:
    outcome = case.run(SEED + SUNK, KINDS[SUNK % len(KINDS)]).outcomes[-1]
    assert outcome.state == BUILT, outcome


def test_a_crank_of_two_webs_is_sound() -> None:
    automatic = made(WEBS)
    (body,) = automatic.layout.webs.values()
    crank = {body: automatic.solids(engraved_too=False)[body]}
    assert [solid.name for solid in crank[body]].count(body) == 1
    assert f"{body}_2" in [solid.name for solid in crank[body]]
    assert not case.overlapping(case.meshed(crank))  # pyright: ignore[reportArgumentType]


def test_a_body_between_two_others() -> None:
    names = ("a", "b", "c")
    items = [Item(name, name, disc(0.0, 0.0, 1.0), Reach((name,))) for name in names]
    pairs = [(i, j) for j in range(3) for i in range(j)]
    for low, high, middle in (("a", "b", "c"), ("b", "c", "a"), ("a", "c", "b")):
        layers = find_layers(Problem(names, items, pairs, between=[(low, high, (middle,))]))
        assert layers is not None
        assert layers[middle] == 1
    assert find_layers(Problem(names, items, pairs, {"a": 0}, between=[("b", "c", ("a",))])) is None


def test_poses_are_close_where_a_link_flies_past_its_dead_point() -> None:
    _, subject, _ = drawn(SEED + 36, KINDS[36 % len(KINDS)])
    solution = subject.m.sweep(subject.turn, 360)
    turned = np.abs(np.diff(solution.body("guide").theta)).max()
    assert turned > 4 * TURN, "else there is nothing to see"
    poses, times = poses_of(solution, 1.0), times_of(solution)
    assert len(poses["guide"]) == len(times)
    assert np.abs(np.diff(poses["guide"][:, 2])).max() < turned / 8
    assert (np.diff(times) > 0).all()


def test_sweeps_are_told_closely() -> None:
    _, subject, _ = drawn(SEED + 46, KINDS[46 % len(KINDS)])
    times = np.linspace(0.0, subject.turn or 1.0, 31)
    close = swept_closely(subject.m, times)
    assert set(times) < set(close.t)
    middles = (close.t[:-1] + close.t[1:]) / 2
    both = subject.m.sweep(times=np.unique(np.concatenate([close.t, middles])))
    h, at = np.diff(close.t)[:, None, None], np.arange(len(middles))
    q, v, a = close.q, close.v, close.a
    between = (q[at] + q[at + 1]) / 2 + 5 / 32 * h * (v[at] - v[at + 1]) + h * h / 64 * (a[at] + a[at + 1])
    size = close.packed.size
    off = np.abs(between - both.q[1::2]) * np.array([1.0, 1.0, size])
    assert off.max() <= CLOSE * size
    usual = np.linspace(0.0, 2 * np.pi, 361)
    assert np.array_equal(swept_closely(model((0.1, 0.04, 0.12, 0.1)), usual).t, usual)
