"""Helpers that keep the code of shader graphs readable."""

from __future__ import annotations

from typing import Any


class Graph:
    """Adds nodes to a node tree and wires them: a value that is a socket is linked, anything else is set."""

    def __init__(self, tree: Any) -> None:
        self.tree = tree

    def clear(self) -> Graph:
        """Drop the nodes Blender starts with."""
        self.tree.nodes.clear()
        return self

    def add(self, kind: str, settings: dict[str, Any] | None = None, **inputs: Any) -> Any:
        """A node of type ``ShaderNode<kind>``; inputs by name, with underscores for spaces."""
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
        """The result of a Math node."""
        node = self.tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        for index, value in enumerate(values):
            self.set(node, index, value)
        return node.outputs[0]

    def vector(self, operation: str, *values: Any, **inputs: Any) -> Any:
        """The result of a Vector Math node that is a vector."""
        node = self.add("VectorMath", {"operation": operation}, **inputs)
        for index, value in enumerate(values):
            self.set(node, index, value)
        return node.outputs["Vector"]

    def mixed(self, ray: str, others: Any, these: Any) -> Any:
        """The shader ``these`` for rays of one sort, e.g. "Is Camera Ray", and ``others`` for all else."""
        mix = self.add("MixShader")
        for index, value in enumerate((self.add("LightPath").outputs[ray], others, these)):
            self.set(mix, index, value)
        return mix.outputs[0]

    def ramp(self, factor: Any, stops: list[tuple[float, tuple[float, float, float]]]) -> Any:
        """A colour ramp, smooth between its stops."""
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
