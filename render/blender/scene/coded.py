"""Materials that tell a drawing what is where: emission whose colour is a code instead of light.

A pixel has number + (1 + normal_x) / 4 in red, (1 + normal_y) / 2 in green, the distance in radii in blue; normals are
the camera's. Numbers from INKED on are lines of their own: there green is their strength.
"""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from typing import Any

from render.blender.scene.nodes import Graph

INKED = 4096


def number(things: list[Any], inked: list[Any], radius: float) -> None:
    """Give solids and inked things their numbers, and the material that tells them."""
    made, traced = _material(radius, None), _material(radius, "fade")
    plain = _material(radius, "")
    for first, group in ((1, things), (INKED, inked)):
        for index, thing in enumerate(group):
            thing.pass_index = first + index
            fades = first == INKED and thing.type == "MESH" and "fade" in thing.data.attributes
            for slot in range(len(thing.data.materials)):
                thing.data.materials[slot] = made if first == 1 else traced if fades else plain


def _material(radius: float, strength: str | None) -> Any:
    """Material of solids; with a ``strength``, of inked things: the attribute of that name, else 1."""
    import bpy

    made = bpy.data.materials.new("coded")
    made.use_nodes = True
    graph = Graph(made.node_tree).clear()
    seen = graph.add("VectorTransform", {"vector_type": "NORMAL", "convert_from": "WORLD", "convert_to": "CAMERA"})
    graph.set(seen, 0, graph.add("NewGeometry").outputs["Normal"])
    normal = graph.add("SeparateXYZ", Vector=seen.outputs[0])
    quarter = graph.math("MULTIPLY", graph.math("ADD", normal.outputs["X"], 1.0), 0.25)
    red = graph.math("ADD", graph.add("ObjectInfo").outputs["Object Index"], quarter)
    green = graph.math("MULTIPLY", graph.math("ADD", normal.outputs["Y"], 1.0), 0.5)
    if strength is not None:
        green = graph.add("Attribute", {"attribute_name": strength}).outputs["Fac"] if strength else 1.0
    away = graph.math("DIVIDE", graph.add("CameraData").outputs["View Distance"], radius)
    colour = graph.add("CombineXYZ", X=red, Y=green, Z=away).outputs[0]
    graph.add("OutputMaterial", Surface=graph.add("Emission", Color=colour, Strength=1.0).outputs[0])
    made.cycles.emission_sampling = "NONE"
    return made
