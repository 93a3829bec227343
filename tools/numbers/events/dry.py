"""Runs with joints that stick and slide by events, alone, sharing a load, and beside contacts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from random import Random

from mbsd import Mechanism, constant_rate, polynomial
from tools.models import rough, sticking
from tools.numbers.events.record import Case
from tools.random_mechanisms import rough as random_rough

KINKS = "friction has kinks where joints stick and slide"
SHARED = "joints that share a load give way together, at kinks of what each carries"
CHAOS = "impacts, kinks and joints that hold each other multiply small differences"


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield from _alone()
    yield from _shared()
    yield from _beside_contacts()
    yield from _random()


def _alone() -> Iterator[Case]:
    yield Case("bell", sticking.bell, 3.03, kink=KINKS, quick=True)
    yield Case("bell in a turned world", lambda: sticking.bell(-20.0, 2.0), 3.03, kink=KINKS)
    yield Case("bell with stops", _fast_bell, 2.03, kink=KINKS)
    for angle, speed in ((0.2, 1.5), (0.5, 1.5)):
        yield Case(f"block on an incline of {angle:g}", partial(incline, angle, speed), 1.03, kink=KINKS)
    for static in (0.25, 0.5):
        yield Case(f"sledge that breaks away at {static:g}", partial(sledge, static), 5.53, kink=KINKS)
    yield Case("block on a belt that sticks", belt, 3.03, kink=KINKS, quick=True)
    yield Case("shaken block", sticking.shaken_block, 4.03, kink=KINKS)
    yield Case("wheel on a spring", wheel_on_a_spring, 7.03, kink=KINKS)
    yield Case("one of two sledges slides", two_sledges, 5.03, kink=KINKS)


def _shared() -> Iterator[Case]:
    yield Case("slider-crank comes to rest", sticking.coasting_slider_crank, 0.63, kink=SHARED, quick=True)
    yield Case("slider-crank breaks away", lambda: sticking.coasting_slider_crank(0.0, 3.0), 0.33, kink=SHARED)
    yield Case("slider-crank turns", lambda: sticking.coasting_slider_crank(40.0), 0.23, kink=SHARED)
    yield Case("two slider-cranks", lambda: sticking.two_slider_cranks(1.0), 0.53, kink=SHARED)
    yield Case("five-bar", sticking.stuck_five_bar, 0.53, kink=SHARED)
    yield Case("five-bar, other order", lambda: sticking.stuck_five_bar(order="DBEAC"), 0.53, kink=SHARED)
    yield Case("five-bar, welded", lambda: sticking.stuck_five_bar(order="ABCE", bend=0.5), 0.43, kink=SHARED)
    yield Case("arm with two dry joints", sticking.arm, 1.53, kink=SHARED)
    yield Case("slider-crank without load", sticking.weightless_slider_crank, 1.53, kink=SHARED)
    yield Case("slow slider-crank that stops", lambda: sticking.coasting_slider_crank(2.0, 0.4), 0.93, kink=SHARED)


def _beside_contacts() -> Iterator[Case]:
    yield Case("lever and ball", sticking.loaded_lever, 0.43, kink=KINKS, quick=True)
    yield Case("carriage in a slanting guide", lambda: carriage(0.4), 0.83, kink=KINKS)
    built = {
        "thrown bars": (rough.thrown_bars, 0.39),
        "struck slider": (rough.struck_slider, 0.73),
        "pushed block": (rough.pushed_block, 0.53),
        "swinging load": (rough.swinging_load, 0.93),
        "leaning ladder": (rough.leaning_ladder, 0.63),
        "block beside a slider-crank": (rough.block_beside_slider_crank, 0.43),
        "dragged arm": (rough.dragged_arm, 0.33),
        "carried five-bar": (rough.carried_five_bar, 0.43),
    }
    for name, (build, duration) in built.items():
        quick = name in ("struck slider", "leaning ladder")
        yield Case(f"{name}, sticks", partial(build, True), duration, kink=CHAOS, quick=quick)
        if name not in ("block beside a slider-crank", "dragged arm", "carried five-bar"):
            yield Case(f"{name}, creeps", partial(build, False), duration, kink=CHAOS)
        else:
            yield Case(f"{name}, static", partial(build, True, 0.45), duration, kink=CHAOS)


def _random() -> Iterator[Case]:
    makers = {
        "five-bar with stops": (random_rough.five_bar_with_stops, 0.33),
        "striker": (random_rough.striker, 0.43),
        "shaken box": (random_rough.shaken_box, 0.43),
        "level chain": (random_rough.level_chain, 0.23),
    }
    for name, (maker, duration) in makers.items():
        for seed in range(3):
            yield Case(f"{name} {seed}", partial(_drawn, maker, seed), duration, kink=CHAOS, even=name == "level chain")


def _drawn(maker, seed: int) -> Mechanism:  # type: ignore[no-untyped-def]
    return maker(Random(seed))[0]


def _fast_bell() -> Mechanism:
    m = sticking.stopped_bell()
    m.start_moving(bar=6.0)
    return m


def incline(angle: float, speed: float) -> Mechanism:
    """A block thrown up an incline, its x axis down the slope."""
    m = Mechanism("incline")
    block = m.body("block", 2.0, inertia=0.1)
    m.prismatic("plane", m.ground.at(0, 0, -angle), block.origin)
    m.friction("rub", "plane", 0.3, sticks=True)
    m.start_near(block=(0.0, 0.0, -math.degrees(angle)))
    m.start_moving(block=(-speed * math.cos(angle), speed * math.sin(angle), 0.0))
    return m


def sledge(static: float) -> Mechanism:
    """A sledge that a growing pull breaks away."""
    m = Mechanism("sledge")
    body = m.body("sledge", 3.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, body.origin)
    m.friction("rub", "rail", 0.25, static=static, preload=5.0, sticks=True)
    m.force("pull", body.origin, polynomial(0.0, 4.0))
    return m


def belt() -> Mechanism:
    """A block on a belt whose friction falls with the speed, held by a spring."""
    m = Mechanism("belt")
    base, block = m.body("belt", 1.0, inertia=1.0), m.body("block", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, base.origin)
    m.drive_coordinate("motor", m.ground.origin, base.origin, constant_rate(0.1))
    m.prismatic("touch", base.origin, block.origin)
    m.friction("rub", "touch", 0.3, static=0.5, stribeck=0.05, sticks=True)
    m.spring("spring", m.ground.at(-3, 0), block.origin, 50.0, free_length=3.0)
    m.start_near(belt=(0, 0, 0), block=(0, 0, 0))
    m.start_moving(block=(0.1, 0, 0))
    return m


def wheel_on_a_spring() -> Mechanism:
    """A wheel that swings on a spring in a dry axle until it stays beside its zero."""
    m = Mechanism("wheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=0.5)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.torsion_spring("spring", m.ground, wheel, 2.0)
    m.friction("rub", "axle", 0.3, radius=0.05, preload=20.0, sticks=True)
    m.start_near(wheel=math.degrees(1.1))
    return m


def two_sledges() -> Mechanism:
    """A sledge on another, of which the weaker one slides."""
    m = Mechanism("two", gravity=None)
    first, second = m.body("first", 1.0, inertia=1.0), m.body("second", 2.0, inertia=1.0)
    m.prismatic("a", m.ground.origin, first.origin)
    m.prismatic("b", first.origin, second.origin)
    m.friction("rub a", "a", 0.5, preload=10.0, sticks=True)
    m.friction("rub b", "b", 0.5, preload=6.0, sticks=True)
    m.force("pull", second.origin, polynomial(0.0, 4.0, 0.0, -0.4))
    m.start_near(first=(0, 0, 0), second=(0, 0, 0))
    return m


def carriage(beta: float) -> Mechanism:
    """A carriage on a dry rail, its foot in a slanting guide on rough ground: each presses the other."""
    m = Mechanism("carriage")
    cart, foot = m.body("cart", 3.0, inertia=1.0), m.body("foot", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 1), cart.origin)
    m.prismatic("guide", cart.at(0, 0, math.pi / 2 - beta), foot.at(0, 1, math.pi / 2 - beta))
    m.rigid_contact("ground", m.ground.origin, foot.origin, friction=0.4)
    m.friction("rub", "rail", 0.3, sticks=True)
    m.start_near(cart=(0, 1, 0), foot=(0, 0, 0))
    m.start_moving(cart=(2.0, 0, 0), foot=(2.0, 0, 0))
    return m
