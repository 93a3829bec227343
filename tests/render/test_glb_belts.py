"""Belts and chains in the GLB: at every time their marks and links are where the film has them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.solve.motion_file import to_motion
from render.film.poses import Moment, Poses
from render.film.tubes.belts import Belt, belts
from render.glb.document import Animation, Document, Paints
from render.glb.tubes import add_belt
from shared.contract import Held
from tests.render.film.test_belts import drive, filmed
from tests.render.glb_file import GlbFile

NEAR = 1e-5
"""m, over the whole motion."""


def written(belt: Belt, poses: Poses) -> GlbFile:
    """A file with nothing but the belt, its axes those of data.json."""
    document = Document()
    animation = Animation(document, poses.motion)
    nodes = add_belt(document, animation, Paints(document), poses, belt)
    document.add("nodes", {"name": "root", "children": nodes})
    document.add("scenes", {"nodes": [len(nodes)]})
    document.json["scene"] = 0
    document.add("animations", animation.content())
    return GlbFile(document.content())


@pytest.mark.parametrize("crossed", [False, True])
def test_marks_run_on_their_loop(crossed: bool) -> None:
    belt, poses = filmed(drive(crossed))
    read = written(belt, poses)
    assert len({node["mesh"] for name, node in read.nodes.items() if "mark" in name}) == 1
    for k in (0, 7, 48):
        time = poses.time[k]
        loop, *marks = (np.array(path) for path in belt.paths(poses, Moment(time, 0)))
        matrices = read.matrices(time - poses.time[0])
        for number, mark in enumerate(marks, start=1):
            matrix = matrices[f"belt mark {number}"]
            assert matrix[:3, 3] == pytest.approx(mark[2], abs=NEAR)
            way = (mark[4] - mark[0])[:2]
            assert matrix[:2, 0] == pytest.approx(way / np.hypot(*way), abs=1e-5)
        assert off_the_middle(read, loop, matrices) == pytest.approx(belt.radius, rel=0.05)


def off_the_middle(read: GlbFile, loop: np.ndarray, matrices: dict[str, np.ndarray]) -> np.ndarray:
    """How far some points of the loop's surface are from the points of its middle line (m)."""
    [primitive] = read.json["meshes"][read.nodes["belt"]["mesh"]]["primitives"]
    points = read.array(primitive["attributes"]["POSITION"])[::37]
    placed = points @ matrices["belt"][:3, :3].T + matrices["belt"][:3, 3]
    return np.linalg.norm(placed[:, None] - loop, axis=2).min(axis=1)


@pytest.mark.parametrize(("teeth", "meshes"), [((16, 32), 2), ((15, 30), 2)])
def test_links_of_a_chain_reach_from_roller_to_roller(teeth: tuple[int, int], meshes: int) -> None:
    belt, poses = filmed(drive(teeth=teeth))
    read = written(belt, poses)
    assert len({node["mesh"] for name, node in read.nodes.items() if "link" in name}) == (1 if belt.alike else meshes)
    for k in (0, 11, 30):
        time = poses.time[k]
        rollers = np.array(belt.paths(poses, Moment(time, 0))[: belt.count])
        middles = rollers.mean(axis=1)
        matrices = read.matrices(time - poses.time[0])
        links = np.array([matrices[f"belt link {number}"] for number in range(1, belt.count + 1)])
        assert np.abs(links[:, :3, 3] - middles).max() < NEAR
        ahead = np.roll(middles, -1, axis=0) - middles
        length = np.linalg.norm(ahead, axis=1)
        assert np.abs(links[:, :3, 0] - ahead / length[:, None]).max() < 1e-5
        assert np.ptp(length) < 0.02 * length.mean()  # one mesh serves on strands and on pulleys


def test_a_belt_on_a_carrier_goes_round_with_it() -> None:
    """A pulley of ground, and one on an arm that turns twice in the motion."""
    m = Mechanism("carried")
    arm, planet = m.body("arm"), m.body("b")
    m.revolute("A", m.ground.at(0.01, 0.02), arm.origin)
    m.revolute("B", arm.at(0.12, 0), planet.origin)
    m.belt("belt", m.ground.at(0.01, 0.02), planet.origin, 0.02, 0.04)
    m.drive_angle("motor", arm, constant_rate(2 * math.pi, 0.3))
    m.start_near(arm=17, b=40)
    motion = to_motion(m.sweep(2.0, steps=361), None, "", {}, dict.fromkeys(("arm", "b"), "mechanism"))
    [belt] = belts(motion, {"belt": Held(z=0.01, radius=0.001)})
    poses = Poses(motion)
    read = written(belt, poses)
    for time in (0.0, 0.61, 1.3, 2.0):
        loop, *marks = (np.array(path) for path in belt.paths(poses, Moment(time, 0)))
        matrices = read.matrices(time)
        assert off_the_middle(read, loop, matrices) == pytest.approx(belt.radius, rel=0.05)
        for number, mark in enumerate(marks, start=1):
            assert matrices[f"belt mark {number}"][:3, 3] == pytest.approx(mark[2], abs=5 * NEAR)
