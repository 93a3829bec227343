"""The solid view of a page: meshes, looks, cameras."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from render.film.camera import angles
from render.film.film import Film
from render.film.framing import axes, in_studio, studio
from render.film.pieces import exploded, piece_specs
from render.film.poses import Moment
from render.film.scene import PieceSpec, SurfaceSpec
from render.film.section import cuts_of, section_of
from render.film.solids import read_triangles
from render.glb.build import tubes
from render.glb.document import CLEAR, METALLIC, TONE, smooth
from render.looks import LOOKS, Look, Softbox
from render.view.loads import arcs_of, arrows_of
from shared.contract.shot import Section

# Triangles of the solids, small: pieces of one shape are one mesh, places are whole numbers of a step, differences
# are kept instead of numbers. page/src/view3d/meshes.js reads them.
#
#     positions    (3 n,) uint16: all x, then all y, then all z, each less the one before (modulo 2^16), in steps from
#     low normals      (2 n,) int8: octahedral u of all, then v of all triangles    (3 m,) uint16 or uint32: first
#     corner less that of the triangle before, then second and third corner              less the first, zigzag (0, -1,
#     1, -2 .. as 0, 1, 2, 3 ..)
#
# Octahedral normals: Meyer et al., On Floating-Point Normal Vectors, Eurographics 2010.

STEPS = 65535
Shape = tuple[np.ndarray, np.ndarray, np.ndarray]


class Meshes:
    """Meshes of a page: ``list`` of dicts, ``step`` (m)."""

    def __init__(self, largest: float) -> None:
        """``largest``: extent of the largest piece (m)."""
        self.step = largest / STEPS
        self.list: list[dict[str, Any]] = []
        self._known: dict[str, int] = {}

    def add(self, shape: Shape) -> tuple[int, list[float]]:
        """Return the number of the mesh of a shape, and where its lowest corner is (m).

        The shape is positions, normals and corners.
        """
        positions, normals, corners = shape
        low = positions.min(axis=0)
        whole = np.round((positions - low) / self.step).astype(np.int64)
        triangles = _sorted(corners.astype(np.int64).reshape(-1, 3))
        content = {
            "positions": np.diff(whole, axis=0, prepend=0).T.astype(np.uint16),
            "normals": _octahedral(normals).T,
            "triangles": _differences(triangles, len(whole)),
        }
        key = hashlib.sha256(b"".join(array.tobytes() for array in content.values())).hexdigest()
        if key not in self._known:
            self._known[key] = len(self.list)
            self.list.append({"count": len(whole)} | content)
        return self._known[key], [float(value) for value in low]


def shapes(files: list[Path]) -> Iterator[Shape]:
    """Yield shapes of STL files, in their order; one that is another moved is worked out once."""
    known: dict[bytes, tuple[np.ndarray, Shape]] = {}
    for file in files:
        triangles = read_triangles(file)
        low = triangles.reshape(-1, 3).min(axis=0)
        key = hashlib.sha256(np.round((triangles - low) * 1e7).astype(np.int64).tobytes()).digest()
        if key not in known:
            known[key] = low, smooth(triangles)
        first, (positions, normals, corners) = known[key]
        yield (positions + (low - first)).astype(np.float32), normals, corners


def _sorted(triangles: np.ndarray) -> np.ndarray:
    """Return each with its least corner first, in the order of these; the side they show stays."""
    least = triangles.argmin(axis=1)
    turned = np.take_along_axis(triangles, (least[:, None] + np.arange(3)) % 3, axis=1)
    return turned[np.lexsort(turned.T[::-1])]


def _differences(triangles: np.ndarray, count: int) -> np.ndarray:
    out = triangles.copy()
    out[:, 0] = np.diff(triangles[:, 0], prepend=0)
    out[:, 1:] -= triangles[:, :1]
    zigzag = np.where(out >= 0, 2 * out, -2 * out - 1)
    return zigzag.T.astype(np.uint16 if 2 * count < STEPS else np.uint32)


def _octahedral(normals: np.ndarray) -> np.ndarray:
    """Return (n, 2) int8 of unit vectors (n, 3)."""
    x, y, z = (normals / np.abs(normals).sum(axis=1, keepdims=True)).T
    below = z < 0
    u = np.where(below, (1 - np.abs(y)) * np.where(x >= 0, 1, -1), x)
    v = np.where(below, (1 - np.abs(x)) * np.where(y >= 0, 1, -1), y)
    return np.round(np.stack([u, v], axis=1) * 127).astype(np.int8)


# The look of the film as WebGL takes it.
#
# name, dark (bool), boxes [[place, size, strength, colour]] (what is reflected, places in radii as the camera stands)
# lamp {place, power, colour}: the one with a shadow
# ground {texture, colour, other, roughness, lines}, sky {zenith, horizon, below}, wall {kind, colour, away} or null
# screen {edge, lamp, ambient, reflected, exposure}, drawing {paper, grid, line (sRGB 0..1), tone} or null

BRIGHTEST = 6.5
"""Brightness of a softbox: a reflection that is brighter is white all the same."""
LARGER = 2.4
"""Times its size, at most."""


def looks_of(look: Look, stands: bool) -> dict[str, Any]:
    """Return ``dark`` and ``light``: pages in these colours for a machine that was filmed in ``look``."""
    return {
        theme: as_shown(look if look.other is None or look.dark == (theme == "dark") else LOOKS[look.other], stands)
        for theme in ("dark", "light")
    }


def as_shown(look: Look, stands: bool) -> dict[str, Any]:
    """See the file."""
    light = look.standing if stands else look.lying
    place = light.sun.place if light.sun is not None else light.shadow
    colour = light.sun.colour if light.sun is not None else (1.0, 1.0, 1.0)
    plain = {key: msgspec.to_builtins(getattr(look, key)) for key in ("ground", "sky", "wall", "screen", "drawing")}
    return plain | {
        "name": look.name,
        "dark": look.dark,
        "boxes": [_box(box, look.screen.reflected) for box in light.softboxes],
        "lamp": {"place": list(place), "colour": list(colour)},
    }


def _box(box: Softbox, times: float) -> list[Any]:
    """Return a painted lamp with the radiance of its power and size; a too bright one is larger instead."""
    wide, high = box.size
    radiance = times * box.power / (math.pi * wide * high)
    larger = min(LARGER, math.sqrt(max(1.0, radiance / BRIGHTEST)))
    size = [round(larger * wide, 4), round(larger * high, 4)]
    return [list(box.place), size, round(min(BRIGHTEST, radiance / larger**2), 4), list(box.colour)]


# The parts of the page, as the film has them.
#
# solid   looks {dark, light}: see looks.py; reach: away from the camera (m); size, middle (m)
#         axes: right, away and up (3, 3) of the picture in the world; floor: its height along up (m)
#         camera {azimuth, elevation (rad), lens (mm), position, target (m)}: the film's first
#         step (m) and meshes: see meshes.py
#         surfaces [{colour (linear), finish, roughness, metal, coat, clear: opacity}]
#         pieces [{body, name, mesh, at (m, of its lowest corner in the body), surface, turns, lift (m, of an exploded
#         machine, along the normal of its plane)}]; turns is null, or
#         {x, y, angle (T,)} of a roller about a point of its body (m, rad)
#         section: part that the page shows cut away at first; sawn: whether the shot has other planes than one from the
#         front, those of pieces then: cut [(x, y, z, m)] a normal and how far along it each plane is, in the body, or
#         where fixed in the world, and gone: whether all of it is always away
#         heights {joints, points, bodies: {name: m}}: of what floats over them
#         tubes: bytes of a GLB with springs, ropes and belts and their motion, or null; still [(x, y, z, m)]: planes of
#         the machine that cut them where the shot's section does

COAT = {"anodised": 0.18, "plastic": 0.25, "wood": 0.1}
"""Strength of varnish, by finish."""


def with_parts(payload: dict[str, Any], film: Film) -> dict[str, Any]:
    """Return the payload of the film's motion with its parts, and arrows and trails at their heights."""
    size, heights, motion = film.space.size, film.trails.heights, film.in_space or film.motion
    trails = [
        record | {"z": heights[trail.point], "radius": trail.radius * size}
        for record, trail in zip(payload["trails"], film.trails.trails, strict=True)
    ]
    return payload | {
        "arrows": arrows_of(motion, size, film.heights),
        "arcs": arcs_of(motion, size, film.heights),
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
    apart = exploded(film.parts, film.size) if film.in_space is None else []
    lifts = {(lift.body, lift.piece): lift.distance for lift in apart}
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
        "tubes": np.frombuffer(tubes(film), np.uint8) if film.drawn and film.in_space is None else None,
    }


def sawn_of(film: Film) -> dict[tuple[str, str], dict[str, Any]]:
    """Return by body and piece how the shot's section cuts it.

    There is nothing where the page's own slider does the same.
    """
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
    if film.in_space is not None:
        return {"joints": {}, "points": {}, "bodies": {}}
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
