"""The scene of the GLB as a USD stage, in metres, y up, its motion as time samples.

    /four_bar                  Xform, turned once so that what points up in the scene is y
    /four_bar/crank            Xform: translate (m), rotateZ (degrees), scale at the times of data.json
    /four_bar/crank/pin_A      Mesh with its material; its display name is its name in parts.json
    /four_bar/materials/...    Material, UsdPreviewSurface

Between samples readers go in a straight line, in the angle as well. Torsion springs have points at some times.
Source: Pixar, OpenUSD API documentation, UsdGeom (Xformable, Mesh) and UsdPreviewSurface specification.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from pxr import Gf, Kind, Usd, UsdGeom

from render.film.film import Film
from render.glb.animation import Animation, Track
from render.glb.build import scene_of
from render.glb.cut import front_of, pieces_of
from render.glb.document import Document
from render.usd import moves
from render.usd.clock import Clock
from render.usd.meshes import Meshes
from render.usd.names import Names
from render.usd.surfaces import Surfaces


def stage_of(film: Film) -> Usd.Stage:
    """The stage, in memory."""
    document, animation = scene_of(film, pieces_of(film), front_of(film))
    clock = Clock(np.asarray(film.motion.time))
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.LinearUnits.meters)
    stage.SetTimeCodesPerSecond(clock.rate)
    stage.SetFramesPerSecond(clock.rate)
    stage.SetStartTimeCode(0.0)
    stage.SetEndTimeCode(clock.last)
    stage.SetMetadata("documentation", f"mbsd: {film.motion.mechanism}, {film.motion.analysis}; SI units")
    _Writer(stage, document, animation, clock).write()
    return stage


class _Writer:
    def __init__(self, stage: Usd.Stage, document: Document, animation: Animation, clock: Clock) -> None:
        self._stage, self._document, self._animation, self._clock = stage, document, animation, clock
        self._nodes: list[dict[str, Any]] = document.json["nodes"]
        self._tracks: dict[int, list[Track]] = {}
        for track in animation.tracks:
            self._tracks.setdefault(track.node, []).append(track)

    def write(self) -> None:
        """Add the whole tree below its root, which is the default prim."""
        [top] = self._document.json["scenes"][0]["nodes"]
        names = Names("/")
        root = UsdGeom.Xform.Define(self._stage, names.path(self._nodes[top]["name"]))
        self._stage.SetDefaultPrim(root.GetPrim())
        Usd.ModelAPI(root.GetPrim()).SetKind(Kind.Tokens.component)
        root.GetPrim().SetDisplayName(self._nodes[top]["name"])
        x, y, z, w = self._nodes[top]["rotation"]
        root.AddTransformOp().Set(Gf.Matrix4d().SetRotate(Gf.Quatd(w, x, y, z)))
        below = Names(str(root.GetPath()))
        surfaces = Surfaces(self._stage, below.path("materials"), self._document.json["materials"])
        self._meshes = Meshes(self._stage, self._document, surfaces)
        for child in self._nodes[top]["children"]:
            self._node(child, self._nodes[child]["name"], below)

    def _node(self, number: int, name: str, names: Names) -> None:
        node = self._nodes[number]
        primitives = self._document.json["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []
        path = names.path(name)
        if len(primitives) == 1:
            thing = self._meshes.add(path, primitives[0])
        else:
            thing = UsdGeom.Xform.Define(self._stage, path)
            below = Names(path)
            for k, primitive in enumerate(primitives):
                self._meshes.add(below.path(f"part_{k + 1}"), primitive)
            for child in node.get("children", []):
                self._node(child, self._nodes[child]["name"].removeprefix(f"{name}/"), below)
        thing.GetPrim().SetDisplayName(name)
        self._move(thing, number, primitives)

    def _move(self, thing: UsdGeom.Xformable, number: int, primitives: list[dict[str, Any]]) -> None:
        tracks = {track.path: track for track in self._tracks.get(number, [])}
        for path in moves.ADD:
            if path in tracks:
                moves.move(thing, tracks[path], self._codes(tracks[path]))
            elif path in self._nodes[number]:
                moves.place(thing, path, self._nodes[number][path])
        if "weights" in tracks:
            self._meshes.wind(thing, primitives[0], tracks["weights"].values, self._codes(tracks["weights"]))

    def _codes(self, track: Track) -> list[float]:
        return [self._clock.codes[row] for row in self._animation.rows(track.values)]
