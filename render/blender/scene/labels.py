"""Short texts that float over joints and face the camera."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from typing import Any

from render.blender.scene.materials import flat
from render.film.scene import LabelSpec


def build(scene: Any, label: LabelSpec) -> Any:
    """The text object; its place and rotation are animated."""
    import bpy

    curve = bpy.data.curves.new(f"label {label.text}", "FONT")
    curve.body = label.text
    curve.size = label.size
    curve.align_x = "CENTER"
    curve.align_y = "BOTTOM"
    curve.materials.append(flat(label.colour, f"label {label.text}"))
    thing = bpy.data.objects.new(curve.name, curve)
    thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False
    scene.collection.objects.link(thing)
    return thing
