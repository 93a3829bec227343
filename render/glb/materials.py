"""Surfaces as glTF's metallic-roughness materials: the finishes of the film, as far as a viewer knows them."""

from __future__ import annotations

from typing import Any

from render.film.scene import SurfaceSpec
from render.glb.document import Document

CLEARCOAT = "KHR_materials_clearcoat"
METALLIC = {"anodised": 1.0, "brushed": 1.0, "polished": 1.0, "satin": 0.35, "cast": 0.25}
TONE = {"anodised": 0.8, "brushed": 0.68}
"""Factor on the colour."""
CLEAR = 0.3
"""Opacity of a pane."""


class Paints:
    """The materials of a document, each once."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._known: dict[SurfaceSpec, int] = {}

    def of(self, surface: SurfaceSpec) -> int:
        """The number of a surface's material."""
        if surface not in self._known:
            made = material(surface, f"{surface.finish} {len(self._known)}")
            self._known[surface] = self._document.add("materials", made)
        return self._known[surface]


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
    if surface.finish == "glass":
        out["alphaMode"] = "BLEND"
        out["pbrMetallicRoughness"]["baseColorFactor"][3] = CLEAR
    if surface.finish == "anodised":
        out["extensions"] = {CLEARCOAT: {"clearcoatFactor": 0.18, "clearcoatRoughnessFactor": 0.16}}
    return out
