"""The scene as a USD stage: its clock, meshes, materials and moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Kind, Sdf, Tf, Usd, UsdGeom, UsdShade, Vt

from render.film.film import Film
from render.glb.build import scene_of
from render.glb.cut import front_of, pieces_of
from render.glb.document import CLEARCOAT, Animation, Document, Track

# Names of prims: identifiers, each once below the same prim.


class Names:
    """The names below one prim."""

    def __init__(self, parent: str) -> None:
        """``parent`` is its path; ``/`` is above all."""
        self._parent = parent.rstrip("/")
        self._taken: set[str] = set()

    def path(self, name: str) -> str:
        """Return the path of a new prim for something that is called so: ``rod 1`` becomes ``rod_1``."""
        wish = valid = Tf.MakeValidIdentifier(name)
        number = 1
        while valid in self._taken:
            number += 1
            valid = f"{wish}_{number}"
        self._taken.add(valid)
        return f"{self._parent}/{valid}"


# Time codes of a motion: real time, counted from its first moment.

RATE = 24.0
"""Time codes a second, at least: what programs take that do not ask."""
FEWEST = 48
"""Time codes over a motion, at least, so that a short one plays in as many pictures."""


class Clock:
    """Counts the times of data.json in codes."""

    def __init__(self, time: NDArray[np.float64]) -> None:
        """``time`` (T,) in s."""
        length = float(time[-1] - time[0])
        self.rate = max(RATE, float(math.ceil(FEWEST / length)))
        self.codes: list[float] = ((time - time[0]) * self.rate).tolist()
        """(T,): the code of each time."""
        self.last = self.codes[-1]


# Operations of a prim: translate, rotateZ or orient (in space), and scale at time codes.

ADD = {"translation": "AddTranslateOp", "angle": "AddRotateZOp", "rotation": "AddOrientOp", "scale": "AddScaleOp"}
"""In the order of the prim's list: the last acts first."""


def place(thing: UsdGeom.Xformable, path: str, still: Any) -> None:
    """Put a prim where it stays; ``path`` is that of a track."""
    _op(thing, path).Set(Gf.Vec3d(*still))


def move(thing: UsdGeom.Xformable, track: Track, codes: Sequence[float]) -> None:
    """Give a prim the values of a track at codes (T,), and its first where there is no time."""
    op, values = _op(thing, track.path), _plain(track)
    op.Set(values[0])
    for code, value in zip(codes, values, strict=True):
        op.Set(value, code)


def _op(thing: UsdGeom.Xformable, path: str) -> UsdGeom.XformOp:
    return getattr(thing, ADD[path])(UsdGeom.XformOp.PrecisionDouble)


def _plain(track: Track) -> list[Any]:
    """Return values as USD takes them."""
    if track.path == "angle":
        return [math.degrees(angle) for angle in track.values]
    if track.path == "rotation":
        return [Gf.Quatd(w, x, y, z) for x, y, z, w in track.values.tolist()]
    return [Gf.Vec3d(*value) for value in track.values.tolist()]


# Materials of the GLB as UsdPreviewSurface.

Colour = tuple[float, float, float]


class Surfaces:
    """The materials of a stage, below one scope."""

    def __init__(self, stage: Usd.Stage, scope: str, materials: list[dict[str, Any]]) -> None:
        UsdGeom.Scope.Define(stage, scope)
        names = Names(scope)
        self._made = [(_material(stage, names.path(made["name"]), made), _colour(made)) for made in materials]

    def material(self, number: int) -> tuple[UsdShade.Material, Colour]:
        """Return a material by its number, and its colour (linear)."""
        return self._made[number]


def _colour(made: dict[str, Any]) -> Colour:
    red, green, blue, _ = made["pbrMetallicRoughness"]["baseColorFactor"]
    return red, green, blue


def _material(stage: Usd.Stage, path: str, made: dict[str, Any]) -> UsdShade.Material:
    paint, coat = made["pbrMetallicRoughness"], made.get("extensions", {}).get(CLEARCOAT)
    material = UsdShade.Material.Define(stage, path)
    shader = UsdShade.Shader.Define(stage, f"{path}/surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*_colour(made)))
    numbers = {"metallic": paint["metallicFactor"], "roughness": paint["roughnessFactor"]}
    if paint["baseColorFactor"][3] < 1.0:
        numbers["opacity"] = paint["baseColorFactor"][3]
    if coat:
        numbers |= {"clearcoat": coat["clearcoatFactor"], "clearcoatRoughness": coat["clearcoatRoughnessFactor"]}
    for name, value in numbers.items():
        shader.CreateInput(name, Sdf.ValueTypeNames.Float).Set(value)
    material.CreateSurfaceOutput().ConnectToSource(shader.CreateOutput("surface", Sdf.ValueTypeNames.Token))
    return material


# Surfaces of the GLB as meshes of a stage.

SHAPED = 240
"""Times at which points of what is wound are given, at most."""
Floats = NDArray[np.float32]


class Meshes:
    """Adds meshes to a stage."""

    def __init__(self, stage: Usd.Stage, document: Document, surfaces: Surfaces) -> None:
        self._stage, self._document, self._surfaces = stage, document, surfaces

    def add(self, path: str, primitive: dict[str, Any]) -> UsdGeom.Mesh:
        """Return a part of a mesh of the document, with its material."""
        corners = self._document.values(primitive["indices"]).astype(np.int32)
        mesh = UsdGeom.Mesh.Define(self._stage, path)
        mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(corners))
        mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(corners) // 3, 3, np.int32)))
        _shape(mesh, Usd.TimeCode.Default(), *self._arrays(primitive["attributes"]))
        mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        material, colour = self._surfaces.material(primitive["material"])
        mesh.CreateDisplayColorAttr([Gf.Vec3f(*colour)])
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
        return mesh

    def wind(self, mesh: UsdGeom.Mesh, primitive: dict[str, Any], weights: np.ndarray, codes: Sequence[float]) -> None:
        """Blend a mesh from its shapes by weights (T, n) at time codes (T,), of which SHAPED are kept."""
        base = self._arrays(primitive["attributes"])
        more = [np.stack(arrays) for arrays in zip(*map(self._arrays, primitive["targets"]), strict=True)]
        for k in np.unique(np.linspace(0, len(codes) - 1, SHAPED).round().astype(int)):
            blended = [still + np.tensordot(weights[k], moved, 1) for still, moved in zip(base, more, strict=True)]
            if k == 0:
                _shape(mesh, Usd.TimeCode.Default(), *blended)
            _shape(mesh, codes[k], *blended)

    def _arrays(self, attributes: dict[str, int]) -> list[np.ndarray]:
        """Return points and normals (n, 3)."""
        return [self._document.values(attributes[key]) for key in ("POSITION", "NORMAL")]


def _shape(mesh: UsdGeom.Mesh, when: Any, points: Floats, normals: Floats) -> None:
    arrays = [Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(array, np.float32)) for array in (points, normals)]
    mesh.CreatePointsAttr().Set(arrays[0], when)
    mesh.CreateNormalsAttr().Set(arrays[1], when)
    mesh.CreateExtentAttr().Set(UsdGeom.PointBased.ComputeExtent(arrays[0]), when)


# The scene of the GLB as a USD stage, in metres, y up, its motion as time samples.
#
#     /four_bar                  Xform, turned once so that what points up in the scene is y
#     /four_bar/crank            Xform: translate (m), rotateZ (degrees), scale at the times of data.json
#     /four_bar/crank/pin_A      Mesh with its material; its display name is its name in parts.json
#     /four_bar/materials/...    Material, UsdPreviewSurface
#
# Between samples readers go in a straight line, in the angle as well. Torsion springs have points at some times.
# Source: Pixar, OpenUSD API documentation, UsdGeom (Xformable, Mesh) and UsdPreviewSurface specification.


def stage_of(film: Film) -> Usd.Stage:
    """Return the stage, in memory."""
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
        for path in ADD:
            if path in tracks:
                move(thing, tracks[path], self._codes(tracks[path]))
            elif path != "rotation" and path in self._nodes[number]:
                place(thing, path, self._nodes[number][path])
        if "weights" in tracks:
            self._meshes.wind(thing, primitives[0], tracks["weights"].values, self._codes(tracks["weights"]))

    def _codes(self, track: Track) -> list[float]:
        return [self._clock.codes[row] for row in self._animation.rows(track.values)]
