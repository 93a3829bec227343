"""The files of a small four-bar for the picture tests: closed-form motion, box-shaped links, a ball on every pin."""

from __future__ import annotations

from typing import Any

from shared.contract import BodyParts, Mass, Mount, Parts, Piece, Provenance, write_motion, write_parts
from shared.contract.shot import Shot, write_shot
from shared.contract.skeleton import write_skeleton
from shared.stage.files import file_hash
from shared.stage.paths import Out
from tests.models.motions import four_bar_motion, plain_skeleton

LENGTHS = {"crank": 0.040, "coupler": 0.120, "rocker": 0.090}
GROUND = 0.120
LAYERS = {"crank": 0.018, "coupler": 0.028, "rocker": 0.018}
BALL_HEIGHT = 0.008
"""Of a pin's ball over the middle of its link (m)."""
MATERIALS = {"crank": "aluminium_orange", "coupler": "aluminium", "rocker": "aluminium_blue"}


def solids() -> dict[str, dict[str, tuple[Any, str]]]:
    """Body -> piece -> (mesh in mm, material)."""
    from trimesh import creation
    from trimesh.transformations import translation_matrix

    def box(length: float, width: float, z: float, height: float) -> Any:
        mesh = creation.box((length + width, width, height))
        return mesh.apply_transform(translation_matrix((length / 2, 0, z)))

    def ball(x: float, z: float) -> Any:
        return creation.icosphere(subdivisions=2, radius=3.0).apply_transform(translation_matrix((x, 0, z)))

    made: dict[str, dict[str, tuple[Any, str]]] = {
        "ground": {"base": (box(GROUND * 1000, 60, 5, 10), "aluminium_black")}
    }
    for body, length in LENGTHS.items():
        z, top = LAYERS[body] * 1000, (LAYERS[body] + BALL_HEIGHT) * 1000
        made[body] = {
            body: (box(length * 1000, 16, z, 8), MATERIALS[body]),
            "start": (ball(0, top), "brass"),
            "end": (ball(length * 1000, top), "brass"),
        }
    return made


def write(shot: Shot | None = None, name: str = "four_bar", mount: Mount | None = None) -> Out:
    """data.json, skeleton.json, parts.json with its STL files, and shot.json below the folder of results."""
    out = Out(name)
    motion = four_bar_motion()
    motion.mechanism = name
    write_motion(out.motion, motion)
    write_skeleton(out.skeleton, plain_skeleton(motion))
    mass = Mass(mass=0.1, com=(0.0, 0.0), inertia=1e-5, volume=1e-5)
    bodies: dict[str, BodyParts] = {}
    out.parts_folder.mkdir(parents=True, exist_ok=True)
    for body, meshes in solids().items():
        pieces: dict[str, Piece] = {}
        for piece, (mesh, material) in meshes.items():
            path = out.parts_folder / f"{body}-{piece}.stl"
            mesh.export(path)
            low, high = mesh.bounds[:, 2] / 1000
            pieces[piece] = Piece(
                material=material,
                stl=path.name,
                step=path.with_suffix(".step").name,
                mass=mass,
                z_range=(float(low), float(high)),
                triangles=len(mesh.faces),
                stl_sha256=file_hash(path),
            )
        bodies[body] = BodyParts(pieces=pieces, mass=mass, z=LAYERS.get(body, 0.0))
    provenance = Provenance(inputs="0" * 64, versions={})
    parts = Parts(mechanism=name, provenance=provenance, mount=mount or Mount(), bodies=bodies)
    write_parts(out.parts, parts)
    write_shot(out.shot, shot or Shot())
    return out
