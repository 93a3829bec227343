"""Surfaces as glTF's metallic-roughness materials: the finishes of the film, as far as a viewer knows them."""

from __future__ import annotations

from typing import Any

from render.scene import SurfaceSpec

CLEARCOAT = "KHR_materials_clearcoat"
METALLIC = {"anodised": 1.0, "brushed": 1.0, "polished": 1.0, "satin": 0.35, "plastic": 0.0, "rubber": 0.0}
TONE = {"anodised": 0.8, "brushed": 0.68}
"""Of the colour."""


def material(surface: SurfaceSpec, name: str) -> dict[str, Any]:
    """The material of a surface; colours are linear in both."""
    tone = TONE.get(surface.finish, 1.0)
    out: dict[str, Any] = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*(round(tone * part, 6) for part in surface.colour), 1.0],
            "metallicFactor": METALLIC.get(surface.finish, 0.0),
            "roughnessFactor": surface.roughness,
        },
    }
    if surface.finish == "anodised":
        out["extensions"] = {CLEARCOAT: {"clearcoatFactor": 0.18, "clearcoatRoughnessFactor": 0.16}}
    return out
