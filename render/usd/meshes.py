"""Surfaces of the GLB as meshes of a stage."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom, UsdShade, Vt

from render.glb.document import Document
from render.usd.surfaces import Surfaces

SHAPED = 240
"""Times at which points of what is wound are given, at most."""
Floats = NDArray[np.float32]


class Meshes:
    """Adds meshes to a stage."""

    def __init__(self, stage: Usd.Stage, document: Document, surfaces: Surfaces) -> None:
        self._stage, self._document, self._surfaces = stage, document, surfaces

    def add(self, path: str, primitive: dict[str, Any]) -> UsdGeom.Mesh:
        """A part of a mesh of the document, with its material."""
        corners = self._document.values(primitive["indices"]).astype(np.int32)
        mesh = UsdGeom.Mesh.Define(self._stage, path)
        mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(corners))
        mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(corners) // 3, 3, np.int32)))
        _shape(mesh, Usd.TimeCode.Default(), *self._arrays(primitive["attributes"]))
        mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        material, colour = self._surfaces.of(primitive["material"])
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
        """Points and normals (n, 3)."""
        return [self._document.values(attributes[key]) for key in ("POSITION", "NORMAL")]


def _shape(mesh: UsdGeom.Mesh, when: Any, points: Floats, normals: Floats) -> None:
    arrays = [Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(array, np.float32)) for array in (points, normals)]
    mesh.CreatePointsAttr().Set(arrays[0], when)
    mesh.CreateNormalsAttr().Set(arrays[1], when)
    mesh.CreateExtentAttr().Set(UsdGeom.PointBased.ComputeExtent(arrays[0]), when)
