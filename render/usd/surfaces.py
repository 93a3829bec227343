"""Materials of the GLB as UsdPreviewSurface."""

from __future__ import annotations

from typing import Any

from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade

from render.glb.materials import CLEARCOAT
from render.usd.names import Names

Colour = tuple[float, float, float]


class Surfaces:
    """The materials of a stage, below one scope."""

    def __init__(self, stage: Usd.Stage, scope: str, materials: list[dict[str, Any]]) -> None:
        UsdGeom.Scope.Define(stage, scope)
        names = Names(scope)
        self._made = [(_material(stage, names.path(made["name"]), made), _colour(made)) for made in materials]

    def of(self, number: int) -> tuple[UsdShade.Material, Colour]:
        """A material by its number, and its colour (linear)."""
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
