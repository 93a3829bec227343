"""Bolts of welds stay clear of the pins of both bodies: a load welded at a joint, or beside one. No CAD is built."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from mbsd import Mechanism
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.welds import BLOCK, Weld
from shared.stage.errors import UserError
from tests.mechanisms.automatic.layouts import meets
from tools.models.four_bars import model

LENGTHS = (0.1, 0.25, 0.2, 0.22)


def _loaded(*places: float, body: str = "rocker") -> Automatic:
    """A four-bar with loads welded to a bar, at these distances from its first joint (m)."""
    m = model(LENGTHS)
    for k, place in enumerate(places):
        load = m.body(f"load{k}", 5.0, inertia=0.01)
        m.weld(f"fix{k}", m.bodies[body].at(place, 0.0), load.at(0.0, 0.0))
    return _made(m)


def _made(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep(times=np.linspace(0, 2 * np.pi, 121)))


def _gap(weld: Weld, body: str, place: tuple[float, float]) -> float:
    """From a place of a body to the line between both bolts (rmm)."""
    line = np.linspace(*weld.bolts(body), 200)
    return float(np.hypot(*(line - place).T).min())


@pytest.mark.parametrize("body", ["crank", "coupler", "rocker"])
@pytest.mark.parametrize("places", [(0.0,), (0.018,), (0.2,), (0.19, 0.2)])
def test_bolts_of_a_load_at_or_beside_a_joint_clear_its_hardware(body: str, places: tuple[float, ...]) -> None:
    """Such loads were refused for their bores, or their spacers met the flanges of bushings."""
    made = _loaded(*places, body=body)
    assert not meets(made)
    welds = [feature for feature in made.layout.features if isinstance(feature, Weld)]
    pins = [feature for feature in made.layout.features if isinstance(feature, Pin)]
    assert len(welds) == len(places)
    for weld in welds:
        ends = [
            np.array([made.layout.seen(mover, bolt, "ground")[7] for bolt in weld.bolts(mover)])
            for mover in weld.movers
        ]
        np.testing.assert_allclose(ends[0], ends[1], atol=1e-4)
        for mover in weld.movers:
            places_of_pins = [pin.places[mover] for pin in pins if mover in pin.places]
            assert all(_gap(weld, mover, place) > BLOCK + made.sizes.hardware for place in places_of_pins)
    for first, second in pairwise(welds):
        assert min(_gap(first, body, bolt) for bolt in second.bolts(body)) > 2 * BLOCK


def test_a_weld_far_from_all_joints_stays_where_it_is() -> None:
    (weld,) = [feature for feature in _loaded(0.1).layout.features if isinstance(feature, Weld)]
    middle = np.mean(weld.bolts("load0"), axis=0)
    assert math.hypot(*middle) < 1e-9


def test_a_plate_without_room_for_bolts_is_refused() -> None:
    m = model(LENGTHS)
    load = m.body("load", 5.0, inertia=0.01)
    m.weld("fix", m.bodies["rocker"].at(0.0, 0.0), load.origin)
    for k, (x, y) in enumerate(np.ndindex(13, 13)):
        m.revolute(f"P{k}", load.at(0.02 * (x - 6), 0.02 * (y - 6)), m.body(f"k{k}", 0.1, inertia=1e-4).origin)
    made = Automatic(m, _made(model(LENGTHS)).solution, pin=8.0)
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.motion import times_of
    from mechanisms.stages.automatic.pins.pins import gather as pins
    from mechanisms.stages.automatic.pins.welds import gather as welds
    from mechanisms.stages.automatic.pins.welds import with_free_bolts

    layout = Layout(m, made.wishes()[0], {}, times_of(made.solution))
    features = [*pins(m, [j for j in m.joints.values() if j.kind.name == "revolute"], layout)]
    features += welds(m, [m.joints["fix"]], layout)
    with pytest.raises(UserError, match="'load' together find no place"):
        with_free_bolts(features, layout)
