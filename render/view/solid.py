"""The parts of the page, as the film has them.

solid   looks {dark, light}: see looks.py; reach: away from the camera (m); size, middle (m)
        axes: right, away and up (3, 3) of the picture in the world; floor: its height along up (m)
        camera {azimuth, elevation (rad), lens (mm), position, target (m)}: the film's first
        step (m) and meshes: see meshes.py
        surfaces [{colour (linear), finish, roughness, metal, coat, clear: opacity}]
        pieces [{body, name, mesh, at (m, of its lowest corner in the body), surface, turns, lift (m, of an exploded
        machine, along the normal of its plane)}]; turns is null, or
        {x, y, angle (T,)} of a roller about a point of its body (m, rad)
        section: part that the page shows cut away at first; sawn: whether the shot has other planes than one from the
        front, those of pieces then: cut [(x, y, z, m)] a normal and how far along it each plane is, in the body, or
        where fixed in the world, and gone: whether all of it is always away
        heights {joints, points, bodies: {name: m}}: of what floats over them
        tubes: bytes of a GLB with springs, ropes and belts and their motion, or null; still [(x, y, z, m)]: planes of
        the machine that cut them where the shot's section does
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from render.film.camera import angles
from render.film.exploded import exploded
from render.film.film import Film
from render.film.framing import axes, in_studio, studio
from render.film.pieces import piece_specs
from render.film.poses import Moment
from render.film.scene import PieceSpec, SurfaceSpec
from render.film.section import cuts_of, section_of
from render.glb.build import tubes
from render.glb.materials import CLEAR, METALLIC, TONE
from render.view.loads import arcs_of, arrows_of
from render.view.looks import looks_of
from render.view.meshes import Meshes, shapes
from shared.contract.shot import Section

COAT = {"anodised": 0.18, "plastic": 0.25, "wood": 0.1}
"""Strength of varnish, by finish."""


def with_parts(payload: dict[str, Any], film: Film) -> dict[str, Any]:
    """The payload of the film's motion with its parts, and arrows and trails at their heights."""
    size, heights = film.space.size, film.trails.heights
    trails = [
        record | {"z": heights[trail.point], "radius": trail.radius * size}
        for record, trail in zip(payload["trails"], film.trails.trails, strict=True)
    ]
    return payload | {
        "arrows": arrows_of(film.motion, size, film.heights),
        "arcs": arcs_of(film.motion, size, film.heights),
        "trails": trails,
        "solid": solid(film),
    }


def solid(film: Film) -> dict[str, Any]:
    """See the file."""
    specs = piece_specs(film.parts, msgspec.structs.replace(film.shot, section=0.0), film.folder)
    sawn = sawn_of(film)
    solids = list(shapes([Path(spec.stl) for spec in specs]))
    meshes = Meshes(max(float(np.ptp(positions, axis=0).max()) for positions, _, _ in solids))
    surfaces: dict[SurfaceSpec, int] = {}
    lifts = {(lift.body, lift.piece): lift.distance for lift in exploded(film.parts, film.size)}
    turned = {(roller.body, roller.piece): roller for roller in film.rollers.found}
    pieces = []
    for spec, shape in zip(specs, solids, strict=True):
        mesh, at = meshes.add(shape)
        surface = surfaces.setdefault(spec.surface, len(surfaces))
        turns = _turns(turned.get((spec.body, spec.name)), spec)
        pieces.append(
            {
                "body": spec.body,
                "name": spec.name,
                "mesh": mesh,
                "at": at,
                "surface": surface,
                "turns": turns,
                "lift": lifts.get((spec.body, spec.name), 0.0),
                **sawn.get((spec.body, spec.name), {}),
            }
        )
    return {
        "reach": film.studio.reach[1],
        "looks": looks_of(film.look, film.parts.mount.kind != "desk"),
        "size": film.space.size,
        "middle": [float(value) for value in film.space.middle],
        "axes": studio(film.parts.mount.up).tolist(),
        "floor": float(in_studio(film.space.all, film.parts.mount.up)[:, 2].min()),
        "camera": _camera(film),
        "section": 1.0 if sawn else section_of(film.shot.section).front,
        "sawn": bool(sawn),
        "step": meshes.step,
        "meshes": meshes.list,
        "surfaces": [_surface(surface) for surface in surfaces],
        "pieces": pieces,
        "heights": _heights(film),
        "still": [list(plane) for plane in film.cut],
        "tubes": np.frombuffer(tubes(film), np.uint8) if film.drawn else None,
    }


def sawn_of(film: Film) -> dict[tuple[str, str], dict[str, Any]]:
    """By body and piece, how the shot's section cuts it; nothing where the page's own slider does the same."""
    section = section_of(film.shot.section)
    if section == Section(front=section.front):
        return {}
    cuts = cuts_of(film.parts, section, film.folder, film.motion)
    return {
        key: {"cut": [list(plane) for plane in cut.planes], "fixed": cut.fixed, "gone": cut.gone}
        for key, cut in cuts.items()
    }


def _surface(surface: SurfaceSpec) -> dict[str, Any]:
    tone = TONE.get(surface.finish, 1.0)
    return {
        "colour": [tone * part for part in surface.colour],
        "finish": surface.finish,
        "roughness": surface.roughness,
        "metal": METALLIC.get(surface.finish, 0.0),
        "coat": COAT.get(surface.finish, 0.0),
        "clear": CLEAR if surface.finish == "glass" else 1.0,
    }


def _turns(roller: Any, spec: PieceSpec) -> dict[str, Any] | None:
    if roller is None or spec.turns_about is None:
        return None
    x, y = spec.turns_about
    return {"x": x, "y": y, "angle": np.asarray(roller.turned, np.float64).astype(np.float32)}


def _camera(film: Film) -> dict[str, Any]:
    pose = film.overview
    forward = axes(pose.azimuth, pose.elevation, pose.up)[2]
    azimuth, elevation = angles(film.shot.camera, film.parts.mount)
    position = np.array(pose.position)
    target = position + forward * float((film.space.middle - position) @ forward)
    return {
        "azimuth": azimuth,
        "elevation": elevation,
        "lens": pose.lens,
        "position": position.tolist(),
        "target": target.tolist(),
    }


def _heights(film: Film) -> dict[str, dict[str, float]]:
    start = Moment(float(film.poses.time[0]), 0)
    tops = {
        body: max((piece.z_range[1] for piece in solids.pieces.values()), default=0.0)
        for body, solids in film.parts.bodies.items()
    }
    highest = max(tops.values(), default=0.0)
    return {
        "joints": {name: film.heights.label(name, start)[2] for name in film.motion.joints},
        "points": {name: film.heights.label(name, start)[2] for name in film.motion.points},
        "bodies": {name: tops.get(name, highest) for name in film.motion.bodies},
    }
