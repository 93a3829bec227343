"""Springs, ropes and torsion springs in the GLB: at every time they are where the film has them."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest

from render.blender.scene.tubes import SIDES
from render.film.film import Film
from render.film.poses import Moment
from render.film.scene import TubeSpec
from render.glb.build import glb
from shared.contract import read_motion, read_parts
from shared.contract.shot import Shot
from tests.render.film import test_spirals, test_stretched
from tests.render.glb_file import GlbFile
from tools.fixtures import film_fixture

UPRIGHT = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""From z up to y up."""


def middles(read: GlbFile, node: str, matrices: dict[str, np.ndarray]) -> np.ndarray:
    """Middles (n, 3) of the rings of a tube, world axes of the mechanism (z up)."""
    [primitive] = read.json["meshes"][read.nodes[node]["mesh"]]["primitives"]
    points = read.array(primitive["attributes"]["POSITION"]).astype(float)
    for weight, target in zip(read.weights[node], primitive.get("targets", []), strict=True):
        points = points + weight * read.array(target["POSITION"])
    rings = points[: len(points) - 2 * SIDES].reshape(-1, SIDES, 3).mean(axis=1)
    return (np.column_stack([rings, np.ones(len(rings))]) @ matrices[node].T)[:, :3] @ UPRIGHT


def film_paths(film: Film, time: float) -> list[tuple[TubeSpec, np.ndarray]]:
    at = Moment(time, 0)
    drawn = (*film.stretched, *film.spirals)
    paths = [np.array(path) for spring in drawn for path in spring.paths(film.poses, at)]
    return list(zip([spec for spring in drawn for spec in spring.specs], paths, strict=True))


@pytest.mark.parametrize("stiff", [True, False])
def test_coils_and_cylinders_are_where_the_film_has_them(out_root: Path, stiff: bool):
    film = test_stretched.film(stiff=stiff)
    read = GlbFile(glb(film))
    for k in (0, 77, 180, 359):
        time = film.motion.time[k]
        matrices = read.matrices(time)
        for spec, path in film_paths(film, time):
            assert middles(read, spec.name, matrices) == pytest.approx(path, abs=2e-6), spec.name


def test_a_rope_is_links_along_its_path(out_root: Path):
    film = test_stretched.film(rope=0.6)
    read = GlbFile(glb(film))
    links = sorted((name for name in read.nodes if name.startswith("rope ") and name.split()[1].isdigit()), key=len)
    assert len(links) == 24
    for k in (0, 120, 300):
        matrices = read.matrices(film.motion.time[k])
        path = {spec.name: path for spec, path in film_paths(film, film.motion.time[k])}["rope"]
        ends = np.concatenate([middles(read, f"rope {n + 1}", matrices) for n in range(24)])
        assert ends[0] == pytest.approx(path[0], abs=2e-6)
        assert ends[-1] == pytest.approx(path[-1], abs=2e-6)
        assert ends[1:-1:2] == pytest.approx(ends[2::2], abs=2e-6)  # each begins where the one before ends
        away = np.linalg.norm(ends[:, None] - path[None], axis=2).min(axis=1)
        assert away.max() < 2e-6


def test_a_torsion_spring_winds_as_in_the_film(out_root: Path):
    out = film_fixture.write()
    motion = test_spirals.with_spring(read_motion(out.motion))
    film = Film(motion, read_parts(out.parts), Shot(), out.parts_folder)
    [spring] = film.spirals
    read = GlbFile(glb(film))
    for k in (0, 111, 250):
        matrices = read.matrices(motion.time[k])
        for spec, path in film_paths(film, motion.time[k]):
            blended = 0.02 * spring.rim if spec.name == "spring" else 2e-6
            assert middles(read, spec.name, matrices) == pytest.approx(path, abs=blended), spec.name
        assert sum(read.weights["spring"]) <= 1 + 1e-6


def test_a_spring_that_nothing_moves_and_a_long_simulation(out_root: Path):
    film = test_stretched.film(rope=0.6)
    motion = film.motion
    count = 4000
    bodies = {}
    for name, body in motion.bodies.items():
        still = {field: [getattr(body, field)[0]] * count for field in ("x", "y", "theta")}
        still |= {field: [0.0] * count for field in ("vx", "vy", "omega", "ax", "ay", "alpha")}
        bodies[name] = msgspec.structs.replace(body, **still)
    forces = {name: msgspec.structs.replace(force, value=[0.1] * count) for name, force in motion.forces.items()}
    still = msgspec.structs.replace(
        motion, period=None, time=np.linspace(0, 9, count).tolist(), bodies=bodies, forces=forces, points={}
    )
    seen = Film(still, film.parts, Shot(trails=()), film.folder)
    read = GlbFile(glb(seen))
    clocks = {read.array(sampler["input"]).size for sampler in read.json["animations"][0]["samplers"]}
    assert clocks == {count, 1440}
    matrices = read.matrices(5.0)
    assert middles(read, "spring", matrices)[0, :2] == pytest.approx(test_stretched.MARKERS[0][:2], abs=1e-6)
