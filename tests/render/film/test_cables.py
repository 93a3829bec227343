"""Cables over pulleys: their parts, and the tube that the film lays."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.block_and_tackle import mechanism as tackle
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.cables import Cable as Strands
from mechanisms.stages.automatic.wheels.pulleys import Pulley
from mechanisms.stages.solve.motion_file import to_motion
from render.film.poses import Moment, Poses
from render.film.tubes.cables import Cable, cables
from render.glb.document import Animation, Document, Paints
from render.glb.tubes import Springs
from shared.contract import Held, Motion
from shared.stage.errors import UserError


def filmed(m: Mechanism, motion: Motion) -> list[Cable]:
    return list(cables(motion, 1.0, lambda shape, radius: (0.02, (0.0, 0.0)), {"rope 1": Held(z=0.01, radius=0.002)}))


def motion_of(m: Mechanism, duration: float) -> Motion:
    solution = m.simulate(duration, steps=40) if not m.drivers else m.sweep(duration, steps=40)
    return to_motion(solution, None, "", {}, dict.fromkeys(m.bodies, "mechanism"))


def lengths(cable: Cable, motion: Motion) -> np.ndarray:
    """Return how long the tube is at every output."""
    poses = Poses(motion)
    paths = np.array([cable.paths(poses, Moment(float(t), 0))[0] for t in motion.time])
    assert paths.shape[1] == cable.specs[0].points
    return np.hypot(*np.moveaxis(np.diff(paths[..., :2], axis=1), -1, 0)).sum(axis=1)


def test_the_tube_is_as_long_as_the_cable_in_every_frame() -> None:
    m = tackle.build(tackle.Params())
    motion = motion_of(m, 0.5)
    [cable] = filmed(m, motion)
    assert (cable.z, cable.radius, len(cable.spans)) == (0.01, 0.002, 3)
    long = lengths(cable, motion)
    r = tackle.Params().radius
    assert long == pytest.approx(np.full(41, 2 * 0.6 + 0.25 + 2 * math.pi * r), rel=1e-3)  # arcs are polygons
    assert np.ptp(long) < 1e-9


def test_a_slack_strand_sags_by_what_it_is_longer() -> None:
    m = Mechanism("slack")
    load = m.body("load", mass=1.0, inertia=0.1)
    m.revolute("axle", m.ground.at(0, 0), m.body("wheel", mass=1.0, inertia=0.1).origin)
    m.prismatic("guide", m.ground.at(0.1, 0, -math.pi / 2), load.at(0, 0, -math.pi / 2))
    m.start_near(load=(0.1, -0.5, 0))
    wheel = m.over(m.bodies["wheel"].origin, 0.1)
    m.cable("rope", [m.ground.at(-0.6, -0.3), wheel, load.origin], taut=False, slack=0.05)
    motion = motion_of(m, 0.05)
    [cable] = filmed(m, motion)
    gap = np.array(motion.contacts["rope 2"].gap)
    assert gap[0] == pytest.approx(0.05)
    assert gap[-1] < 0.04
    assert np.ptp(lengths(cable, motion)) < 2e-3


def test_a_drum_is_wound_about_and_a_belt_comes_back() -> None:
    m = Mechanism("belt")
    wheels = [m.body(name) for name in "abc"]
    for wheel, (x, y) in zip(wheels, ((0, 0), (0.4, 0), (0.2, 0.3)), strict=True):
        m.revolute(f"pin {wheel.name}", m.ground.at(x, y), wheel.origin)
    m.cable("rope", [m.over(wheel.origin, 0.05, clockwise=False) for wheel in wheels], closed=True)
    m.drive_angle("motor", wheels[0], constant_rate(1.0))
    motion = motion_of(m, 1.0)
    [belt] = filmed(m, motion)
    around = 0.4 + 2 * math.hypot(0.2, 0.3) + 2 * math.pi * 0.05
    assert belt.closed
    assert lengths(belt, motion) == pytest.approx(np.full(41, around), rel=1e-3)


def test_a_glb_holds_the_whole_cable() -> None:
    m = tackle.build(tackle.Params())
    motion = motion_of(m, 0.5)
    [cable] = filmed(m, motion)
    document = Document()
    springs = Springs(document, Animation(document, motion), Paints(document), motion)
    springs.cable(cable, Poses(motion))
    assert len(springs.nodes) == cable.specs[0].points - 1


def test_pulleys_of_a_cable_lie_in_one_layer_and_hold_it() -> None:
    m = tackle.build(tackle.Params())
    parts = Automatic(m, m.simulate(0.5, steps=20))
    [rope] = parts.layout.select(Strands)
    levels = parts.decided
    assert [pulley.body for pulley in rope.pulleys] == ["block", "pulley"]
    assert len({levels[pulley.layer] for pulley in parts.layout.select(Pulley)}) == 1
    assert levels["load"] != levels[rope.layer] != levels["counterweight"]
    solids = [solid for own in parts.solids(False).values() for solid in own]
    assert sum(any(hold.force == "rope 1" for hold in solid.holds) for solid in solids) == 4  # two rims, two studs


def test_a_span_between_two_points_is_refused_with_what_to_write() -> None:
    m = Mechanism("line")
    load = m.body("load", mass=1.0, inertia=0.1)
    m.cable("rope", [m.ground.origin, load.at(0, 0.1)])
    m.start_near(load=(0, -0.5, 0))
    with pytest.raises(UserError, match=r"cable 'rope' has no wheel; write m\.rope or m\.distance"):
        _ = Automatic(m, m.simulate(0.1, steps=4)).decided
