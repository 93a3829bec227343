"""Materials in Blender: shader nodes, paints and metals, and the coded image of bodies."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from render.film.scene import Colour, SurfaceSpec
from render.film.section import LIGHT, MATT, Hatch, dark_of, light_of

# Helpers that keep the code of shader graphs readable.


class Graph:
    """Adds nodes to a node tree and wires them: a value that is a socket is linked, anything else is set."""

    def __init__(self, tree: Any) -> None:
        self.tree = tree

    def clear(self) -> Graph:
        """Drop the nodes Blender starts with."""
        self.tree.nodes.clear()
        return self

    def add(self, kind: str, settings: dict[str, Any] | None = None, **inputs: Any) -> Any:
        """Return a node of type ``ShaderNode<kind>``; inputs by name, with underscores for spaces."""
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            self.set(node, name.replace("_", " "), value)
        return node

    def set(self, node: Any, name: str | int, value: Any) -> None:
        """Set one input, or link it."""
        socket = node.inputs[name]
        if hasattr(value, "is_output"):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = (*value, 1.0) if isinstance(value, tuple) and socket.type == "RGBA" else value

    def math(self, operation: str, *values: Any) -> Any:
        """Return the result of a Math node."""
        node = self.tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        for index, value in enumerate(values):
            self.set(node, index, value)
        return node.outputs[0]

    def vector(self, operation: str, *values: Any, **inputs: Any) -> Any:
        """Return the result of a Vector Math node that is a vector."""
        node = self.add("VectorMath", {"operation": operation}, **inputs)
        for index, value in enumerate(values):
            self.set(node, index, value)
        return node.outputs["Vector"]

    def mixed(self, ray: str, others: Any, these: Any) -> Any:
        """Return the shader ``these`` for rays of one sort, e.g. "Is Camera Ray", and ``others`` for all else."""
        mix = self.add("MixShader")
        for index, value in enumerate((self.add("LightPath").outputs[ray], others, these)):
            self.set(mix, index, value)
        return mix.outputs[0]

    def ramp(self, factor: Any, stops: list[tuple[float, tuple[float, float, float]]]) -> Any:
        """Return a colour ramp, smooth between its stops."""
        node = self.tree.nodes.new("ShaderNodeValToRGB")
        node.color_ramp.interpolation = "EASE"
        elements = node.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(0.5)
        for element, (position, colour) in zip(elements, stops, strict=True):
            element.position = position
            element.color = (*colour, 1.0)
        self.set(node, "Fac" if "Fac" in node.inputs else 0, factor)
        return node.outputs["Color"]


# One small function per finish: from a surface in plain data to a Blender material.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


BARE: Colour = (0.62, 0.63, 0.65)
IRON: Colour = (0.36, 0.355, 0.35)
LAYER = 0.0004
"""Height (m) of a printed layer, twice what printers make, so that pixels can show it."""
WORN = ("anodised", "cast")
"""Finishes whose chamfers are rubbed."""
EDGE = "edge"
"""Attribute of faces: 1 on chamfers, where paint and oxide wear off first."""
REFERENCE = 0.12
"""Radius (m) of the machine whose grain is as it is made; larger ones have coarser grain, which pixels can show."""


def material(surface: SurfaceSpec, name: str, radius: float = REFERENCE) -> Any:
    """Return the Blender material of a surface in a picture of a machine of this ``radius`` (m)."""
    made, graph = new_material(name)
    shader = FINISHES[surface.finish](graph, surface, max(1.0, radius / REFERENCE))
    output = graph.add("OutputMaterial", Surface=shader)
    output.target = "CYCLES"
    return made


def flat(colour: tuple[float, float, float], name: str) -> Any:
    """Return a material that is this colour in any light."""
    made, graph = new_material(name)
    graph.add("OutputMaterial", Surface=graph.add("Emission", Color=colour, Strength=1.0).outputs[0])
    made.cycles.emission_sampling = "NONE"
    return made


def hatched(surface: SurfaceSpec, name: str, radius: float, hatch: Hatch, fixed: bool = False) -> Any:
    """Return a cut face with stripes in light and dark of the surface's colour.

    Stripes are of the body's frame; of a ``fixed`` plane they lie as the world does and go along with the body.
    """
    made, graph = new_material(name)
    place = graph.add("TexCoord").outputs["Object"]
    if fixed:
        here, body = graph.add("NewGeometry").outputs["Position"], graph.add("ObjectInfo").outputs["Location"]
        place = graph.vector("SUBTRACT", here, body)
    parts = graph.add("SeparateXYZ", Vector=place).outputs
    along: Any = 0.0
    for axis, weight in zip("XYZ", hatch.way, strict=True):
        if weight:
            along = graph.math("ADD", along, graph.math("MULTIPLY", parts[axis], weight))
    stripe = graph.math("FRACT", graph.math("DIVIDE", along, radius * hatch.period))
    light, dark = light_of(surface.colour), dark_of(surface.colour)
    colour = _mixed(graph, graph.math("GREATER_THAN", stripe, LIGHT), light, dark)
    graph.add("OutputMaterial", Surface=_principled(graph, Base_Color=colour, Roughness=MATT))
    return made


def ink(light: bool) -> Any:
    """Paint in what is engraved."""
    made, graph = new_material("ink")
    colour = (0.60, 0.60, 0.585) if light else (0.012, 0.012, 0.013)
    graph.add("OutputMaterial", Surface=_principled(graph, Base_Color=colour, Roughness=0.6))
    return made


def new_material(name: str) -> tuple[Any, Graph]:
    """Return a material of Blender, and its empty graph."""
    import bpy

    made = bpy.data.materials.new(name)
    made.use_nodes = True
    return made, Graph(made.node_tree).clear()


def _principled(graph: Graph, **inputs: Any) -> Any:
    return graph.add("BsdfPrincipled", **inputs).outputs[0]


def _place(graph: Graph, scale: float | tuple[float, float, float], grain: float) -> Any:
    """Return where a point is in its body, times ``scale`` (1/m)."""
    scales = scale if isinstance(scale, tuple) else (scale,) * 3
    place = graph.add("TexCoord").outputs["Object"]
    return graph.add("Mapping", Vector=place, Scale=tuple(s / grain for s in scales)).outputs[0]


def _noise(graph: Graph, place: Any, detail: float = 2.0, roughness: float = 0.5) -> Any:
    return graph.add("TexNoise", Vector=place, Scale=1.0, Detail=detail, Roughness=roughness).outputs[0]


def _swing(graph: Graph, value: Any, middle: float, swing: float) -> Any:
    """Return a noise of 0..1 as ``middle`` plus and minus half a ``swing``."""
    return graph.math("ADD", middle - swing / 2, graph.math("MULTIPLY", value, swing))


def _cloudy(graph: Graph, roughness: float, swing: float, scale: float, grain: float) -> Any:
    """Return the roughness with a slow, faint unevenness: what keeps a large face from looking computed."""
    return _swing(graph, _noise(graph, _place(graph, scale, grain)), roughness, swing)


def _mixed(graph: Graph, part: Any, first: Any, second: Any) -> Any:
    """Return a mix of two colours."""
    mix = graph.add("Mix", {"data_type": "RGBA"})
    for socket, value in ((0, part), (6, first), (7, second)):
        graph.set(mix, socket, value)
    return mix.outputs[2]


def _toned(graph: Graph, colour: Colour, tone: Any) -> Any:
    scaled = graph.add("VectorMath", {"operation": "SCALE"}, Scale=tone)
    graph.set(scaled, 0, colour)
    return scaled.outputs[0]


def _worn(graph: Graph, most: float, grain: float) -> Any:
    """Return how much of a chamfer is bare, unevenly along it."""
    edge = graph.add("Attribute", {"attribute_name": EDGE}).outputs["Fac"]
    patches = _noise(graph, _place(graph, 90.0, grain))
    return graph.math("MULTIPLY", edge, _swing(graph, patches, most, 0.5 * most))


def _anodised(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return dyed oxide on blasted aluminium: coloured metal under a clear layer, bright on its chamfers."""
    worn = _worn(graph, 0.42, grain)
    colour = _mixed(graph, worn, tuple(0.8 * c for c in surface.colour), BARE)
    return _principled(
        graph,
        Base_Color=colour,
        Metallic=1.0,
        Roughness=_cloudy(graph, surface.roughness + 0.02, 0.06, 60.0, grain),
        Coat_Weight=0.18,
        Coat_Roughness=0.16,
        Coat_IOR=1.5,
    )


def _brushed(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return metal brushed lengthwise: fine streaks in roughness and tone along x of the body.

    Those of a turned piece go round its axis.
    """
    axis = surface.turned
    place = _place(graph, (14.0, 900.0, 40.0), grain) if axis is None else _radius(graph, axis, grain)
    streaks = _noise(graph, place, 3.0, 0.6)
    tangent = graph.add("Tangent", {"direction_type": "RADIAL", "axis": "Y" if axis is None else "Z"}).outputs[0]
    return _principled(
        graph,
        Base_Color=_toned(graph, surface.colour, _swing(graph, streaks, 0.68, 0.20)),
        Metallic=1.0,
        Roughness=_swing(graph, streaks, surface.roughness + 0.02, 0.16),
        Anisotropic=0.6,
        Tangent=tangent,
    )


def _radius(graph: Graph, axis: tuple[float, float], grain: float) -> Any:
    """Return a place that depends on the distance from an axis of the body alone."""
    place = graph.add("SeparateXYZ", Vector=graph.add("TexCoord").outputs["Object"]).outputs
    square = [
        graph.math("POWER", graph.math("SUBTRACT", place[name], value), 2.0)
        for name, value in zip("XY", axis, strict=True)
    ]
    away = graph.math("SQRT", graph.math("ADD", *square))
    return graph.add("CombineXYZ", X=graph.math("MULTIPLY", away, 900.0 / grain)).outputs[0]


def _polished(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return turned and polished metal, never so smooth that a few samples sparkle."""
    return _principled(graph, Base_Color=surface.colour, Metallic=1.0, Roughness=max(surface.roughness, 0.2))


def _satin(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return hard black anodising: dark, with a wide soft sheen."""
    return _principled(
        graph,
        Base_Color=surface.colour,
        Metallic=0.35,
        Roughness=_cloudy(graph, surface.roughness - 0.06, 0.05, 40.0, grain),
        Specular_IOR_Level=0.8,
    )


def _plastic(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return smooth moulded plastic."""
    return _principled(graph, Base_Color=surface.colour, Roughness=surface.roughness)


def _printed(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return layers along z, each a round bead: their crowns are bright, and their tone varies a little."""
    height = graph.add("SeparateXYZ", Vector=_place(graph, 1.0, 1.0)).outputs["Z"]
    layer = graph.math("DIVIDE", height, LAYER * grain)
    crown = graph.math("ABSOLUTE", graph.math("SINE", graph.math("MULTIPLY", layer, math.pi)))
    number = graph.math("FLOOR", layer)
    chance = graph.add("TexWhiteNoise", {"noise_dimensions": "1D"}, W=number).outputs["Value"]
    tone = graph.math("MULTIPLY", _swing(graph, crown, 0.93, 0.14), _swing(graph, chance, 1.0, 0.10))
    normal = graph.add("Bump", Height=crown, Strength=0.5, Distance=LAYER * grain / 2).outputs[0]
    return _principled(
        graph, Base_Color=_toned(graph, surface.colour, tone), Roughness=surface.roughness, Normal=normal
    )


def _rubber(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return matt rubber, with a grey bloom where one looks along it."""
    return _principled(
        graph,
        Base_Color=surface.colour,
        Roughness=_cloudy(graph, surface.roughness, 0.08, 30.0, grain),
        Specular_IOR_Level=0.3,
        Sheen_Weight=0.12,
        Sheen_Roughness=0.4,
    )


def _cast(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return sand casting: a rough skin, bright iron on its worn edges."""
    skin = _noise(graph, _place(graph, 420.0, grain), 3.0, 0.6)
    worn = _worn(graph, 0.75, grain)
    colour = _mixed(graph, worn, _toned(graph, surface.colour, _swing(graph, skin, 1.0, 0.35)), IRON)
    normal = graph.add("Bump", Height=skin, Strength=0.25, Distance=0.0008 * grain).outputs[0]
    return _principled(
        graph,
        Base_Color=colour,
        Metallic=graph.math("ADD", 0.25, graph.math("MULTIPLY", worn, 0.75)),
        Roughness=_swing(graph, skin, surface.roughness, 0.16),
        Normal=normal,
    )


def _wood(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return planed and oiled wood: rings of the year along x of the body, fine pores in them."""
    slow = _noise(graph, _place(graph, (2.5, 22.0, 22.0), grain), 1.0)
    rings = graph.math("PINGPONG", graph.math("MULTIPLY", slow, 11.0), 1.0)
    pores = _noise(graph, _place(graph, (26.0, 900.0, 900.0), grain), 2.0, 0.6)
    tone = graph.math("ADD", _swing(graph, rings, 1.0, 0.42), _swing(graph, pores, 0.0, 0.55))
    return _principled(
        graph,
        Base_Color=_toned(graph, surface.colour, tone),
        Roughness=_swing(graph, pores, surface.roughness, 0.2),
    )


MILKY = 0.4
"""Part of coloured glass that scatters light."""


def _glass(graph: Graph, surface: SurfaceSpec, grain: float) -> Any:
    """Return a pane: it tints what is behind and mirrors at a flat angle; light passes straight through.

    One of a strong colour is a little milky, so that it shows before what is dark.
    """
    mirror = graph.add("BsdfGlossy", Color=(1.0, 1.0, 1.0), Roughness=0.06).outputs[0]
    clear = graph.add("BsdfTransparent", Color=surface.colour).outputs[0]
    milky = MILKY * min(1.0, 2.0 * (max(surface.colour) - min(surface.colour)))
    if milky > 0.2 * MILKY:
        clear = _blended(graph, milky, clear, graph.add("BsdfDiffuse", Color=surface.colour).outputs[0])
    return _blended(graph, graph.add("Fresnel", IOR=1.45).outputs[0], clear, mirror)


def _blended(graph: Graph, part: Any, first: Any, second: Any) -> Any:
    """Return a shader that is the second by a ``part``, else the first."""
    mix = graph.add("MixShader")
    for index, value in enumerate((part, first, second)):
        graph.set(mix, index, value)
    return mix.outputs[0]


FINISHES: dict[str, Callable[[Graph, SurfaceSpec, float], Any]] = {
    "anodised": _anodised,
    "brushed": _brushed,
    "polished": _polished,
    "satin": _satin,
    "plastic": _plastic,
    "printed": _printed,
    "rubber": _rubber,
    "cast": _cast,
    "wood": _wood,
    "glass": _glass,
}


# Materials that tell a drawing what is where: emission whose colour is a code instead of light.
#
# A pixel has number + (1 + normal_x) / 4 in red, (1 + normal_y) / 2 in green, the distance in radii in blue; normals
# are the camera's. Numbers from INKED on are lines of their own: there green is their strength.

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.


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
    """Return the material of solids.

    With a ``strength`` it is that of inked things: the attribute of that name, else 1.
    """
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
