"""What shines from all around."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from typing import Any

from render.blender.scene.nodes import Graph
from render.looks.look import Sky


def build(scene: Any, sky: Sky, up: tuple[float, float, float]) -> None:
    """The world of a scene: one colour, or a gradient along ``up``."""
    import bpy

    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    graph = Graph(scene.world.node_tree).clear()
    colour: Any = sky.zenith
    if not sky.zenith == sky.horizon == sky.below:
        height = graph.add("VectorMath", {"operation": "DOT_PRODUCT"})
        graph.set(height, 0, graph.add("TexCoord").outputs["Generated"])
        graph.set(height, 1, up)
        part = graph.math("ADD", 0.5, graph.math("MULTIPLY", height.outputs["Value"], 0.5))
        colour = graph.ramp(part, [(0.0, sky.below), (0.485, sky.horizon), (0.503, sky.horizon), (0.62, sky.zenith)])
    scene.world.cycles.sampling_method = "NONE"  # it is everywhere: rays that leave find it
    graph.add("OutputWorld", Surface=graph.add("Background", Color=colour, Strength=1.0).outputs[0])
