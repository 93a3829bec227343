"""One small function per finish: from a surface in plain data to a Blender material."""

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.
from __future__ import annotations

from collections.abc import Callable
from typing import Any

from render.blender.scene.nodes import Graph
from render.film.scene import SurfaceSpec


def material(surface: SurfaceSpec, name: str) -> Any:
    """The Blender material of a surface."""
    made, graph = _new(name)
    shader = FINISHES[surface.finish](graph, surface)
    output = graph.add("OutputMaterial", Surface=shader)
    output.target = "CYCLES"
    return made


def flat(colour: tuple[float, float, float], name: str) -> Any:
    """A material that is this colour in any light."""
    made, graph = _new(name)
    graph.add("OutputMaterial", Surface=graph.add("Emission", Color=colour, Strength=1.0).outputs[0])
    made.cycles.emission_sampling = "NONE"
    return made


def _new(name: str) -> tuple[Any, Graph]:
    import bpy

    made = bpy.data.materials.new(name)
    made.use_nodes = True
    return made, Graph(made.node_tree).clear()


def _principled(graph: Graph, **inputs: Any) -> Any:
    return graph.add("BsdfPrincipled", **inputs).outputs[0]


def _cloudy(graph: Graph, roughness: float, swing: float, scale: float) -> Any:
    """Roughness with a slow, faint unevenness: what keeps a large face from looking computed."""
    noise = graph.add(
        "TexNoise", Vector=graph.add("TexCoord").outputs["Object"], Scale=scale, Detail=2.0, Roughness=0.5
    )
    return graph.math("ADD", roughness - swing / 2, graph.math("MULTIPLY", noise.outputs[0], swing))


def _anodised(graph: Graph, surface: SurfaceSpec) -> Any:
    """Dyed oxide on blasted aluminium: a coloured metal under a thin clear layer."""
    return _principled(
        graph,
        Base_Color=tuple(0.8 * c for c in surface.colour),
        Metallic=1.0,
        Roughness=_cloudy(graph, surface.roughness + 0.02, 0.06, 60.0),
        Coat_Weight=0.18,
        Coat_Roughness=0.16,
        Coat_IOR=1.5,
    )


def _brushed(graph: Graph, surface: SurfaceSpec) -> Any:
    """Metal brushed along its length: fine streaks in roughness and tone along x of the body."""
    place = graph.add("TexCoord").outputs["Object"]
    stretched = graph.add("Mapping", Vector=place, Scale=(14.0, 900.0, 40.0)).outputs[0]
    streaks = graph.add("TexNoise", Vector=stretched, Scale=1.0, Detail=3.0, Roughness=0.6).outputs[0]
    rough = graph.math("ADD", surface.roughness - 0.06, graph.math("MULTIPLY", streaks, 0.16))
    tone = graph.math("ADD", 0.58, graph.math("MULTIPLY", streaks, 0.20))
    colour = graph.add("VectorMath", {"operation": "SCALE"}, Scale=tone)
    graph.set(colour, 0, surface.colour)
    tangent = graph.add("Tangent", {"direction_type": "RADIAL", "axis": "Y"}).outputs[0]
    return _principled(
        graph, Base_Color=colour.outputs[0], Metallic=1.0, Roughness=rough, Anisotropic=0.45, Tangent=tangent
    )


def _polished(graph: Graph, surface: SurfaceSpec) -> Any:
    """Turned and polished; never so smooth that a few samples sparkle."""
    return _principled(graph, Base_Color=surface.colour, Metallic=1.0, Roughness=max(surface.roughness, 0.2))


def _satin(graph: Graph, surface: SurfaceSpec) -> Any:
    """Hard black anodising: dark, with a wide soft sheen."""
    return _principled(
        graph,
        Base_Color=surface.colour,
        Metallic=0.35,
        Roughness=_cloudy(graph, surface.roughness - 0.06, 0.05, 40.0),
        Specular_IOR_Level=0.8,
    )


def _plastic(graph: Graph, surface: SurfaceSpec) -> Any:
    return _principled(graph, Base_Color=surface.colour, Roughness=surface.roughness, Subsurface_Weight=0.0)


def _rubber(graph: Graph, surface: SurfaceSpec) -> Any:
    return _principled(graph, Base_Color=surface.colour, Roughness=surface.roughness, Specular_IOR_Level=0.3)


FINISHES: dict[str, Callable[[Graph, SurfaceSpec], Any]] = {
    "anodised": _anodised,
    "brushed": _brushed,
    "polished": _polished,
    "satin": _satin,
    "plastic": _plastic,
    "rubber": _rubber,
}
