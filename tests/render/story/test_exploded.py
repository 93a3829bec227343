"""How a machine comes apart, from parts.json alone."""

from __future__ import annotations

from render.film.pieces import MOST, STEP, exploded
from shared.contract import read_parts
from tools.fixtures import film_fixture


def test_layers_come_apart_in_the_order_of_their_middles(out_root) -> None:
    parts = read_parts(film_fixture.write().parts)
    lifts = exploded(parts, 0.2)
    assert len(lifts) == sum(len(body.pieces) for body in parts.bodies.values())
    middle = {lift.name: sum(parts.bodies[lift.body].pieces[lift.piece].z_range) / 2 for lift in lifts}
    assert [middle[lift.name] for lift in lifts] == sorted(middle.values())
    order = {lift.name: lift.order for lift in lifts}
    assert order["ground/base"] == 0
    assert order["crank/crank"] == order["rocker/rocker"] < order["crank/start"] < order["coupler/coupler"]
    distances = [lift.distance for lift in lifts]
    assert distances == [0.2 * STEP * lift.order for lift in lifts]
    assert max(distances) <= 0.2 * MOST
    assert {lift.axis for lift in lifts} == {(0.0, 0.0, 1.0)}


def test_no_pieces_come_apart_nowhere(out_root) -> None:
    parts = read_parts(film_fixture.write().parts)
    for body in parts.bodies.values():
        body.pieces.clear()
    assert exploded(parts, 0.2) == []
