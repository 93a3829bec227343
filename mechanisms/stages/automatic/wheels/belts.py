"""Belts and chains: pulleys on their bodies, in one layer, and the room of the strands between them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mbsd.model.teeth import with_radii
from mechanisms.stages.automatic.layout.extents import Extent, extent
from mechanisms.stages.automatic.wheels.pulleys import LEAST, Belt, Pulley
from shared.contract.belt_path import BeltPath
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd import Mechanism, Solution
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout


BELTS = "belt"


@extent(BELTS)
def extent_of(joint: Joint, solution: Solution) -> Extent:
    """Both pulleys."""
    sized = with_radii(joint.params)
    both = (joint.i, sized["radius_i"]), (joint.j, sized["radius_j"])
    return Extent(both, tuple((radius, LEAST) for _, radius in both))


def belts(m: Mechanism, layout: Layout) -> list[Belt]:
    """All belts of the mechanism, with their pulleys. Raises UserError where two pulleys overlap."""
    return [belt_of(m, joint, layout) for joint in m.joints.values() if joint.kind.name == BELTS]


def belt_of(m: Mechanism, joint: Joint, layout: Layout) -> Belt:
    """The belt of a joint, with its pulleys. Raises UserError where these overlap."""
    pair = _pulley(joint, 0, layout), _pulley(joint, 1, layout)
    _fit(m, joint, pair, layout)
    for pulley, mate in (pair, pair[::-1]):
        pulley.mates.append(mate)
    return Belt(joint.name, pair, bool(joint.params["crossed"]))


def _pulley(joint: Joint, end: int, layout: Layout) -> Pulley:
    sized, marker = with_radii(joint.params), (joint.i, joint.j)[end]
    (x, y), radius = layout.place(marker), layout.sizes.of_metres(sized[("radius_i", "radius_j")[end]])
    teeth = (joint.params.get("teeth") or (0, 0))[end]
    name = f"{joint.name}_{marker.body.name}"
    made = Pulley(name, marker.body.name, x, y, radius, teeth=teeth, belt=joint.name)
    made.tip = made.lip
    return made


def _fit(m: Mechanism, joint: Joint, pair: tuple[Pulley, Pulley], layout: Layout) -> None:
    """Seats of both sprockets where the chain's rollers are at the start. Raises UserError where pulleys overlap."""
    places = [layout.seen(pulley.body, (pulley.x, pulley.y), "ground")[0] for pulley in pair]
    first, second = pair
    way = places[1] - places[0]
    path = BeltPath(first.radius, second.radius, math.hypot(*way), bool(joint.params["crossed"]))
    if not path.has_room or path.distance < first.lip + second.lip:
        scale = layout.sizes.scale
        radii = " and ".join(f"{pulley.radius * scale:.4g}" for pulley in pair)
        raise UserError(
            f"{m.name}: belt '{joint.name}': its pulleys of {radii} mm overlap, because their centres are "
            f"{path.distance * scale:.4g} mm apart; move a centre or make one smaller, or write "
            f"{shown_file(m.name, 'parts')}"
        )
    if not first.teeth:
        return
    turns = [layout.poses[pulley.body][0][2] for pulley in pair]
    line, pitch = math.atan2(way[1], way[0]), 2 * math.pi * first.radius / first.teeth
    spacing = path.length / max(round(path.length / pitch), 1)
    first.phase = 0.0
    seat = first.radius * (turns[0] - line - path.beta)
    there = seat + spacing * math.ceil((path.parts[0] + path.parts[1] - seat) / spacing)
    second.phase = path.on_second(there) + line - turns[1]
