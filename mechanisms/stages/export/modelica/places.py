"""Bodies and the frames on them: Body at the centre of mass, FixedTranslation to each place, Fixed on ground."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mechanisms.stages.export.modelica.document import Document
from mechanisms.stages.export.modelica.expressions import number, vector
from mechanisms.stages.export.tree import GROUND

SMALL = 1e-12
"""m: two places nearer than this are one; a FixedTranslation has to have a length."""


class Places:
    """The frames of a model, made when they are asked for."""

    def __init__(self, document: Document, bodies: Mapping[str, Any]) -> None:
        self._document, self._bodies = document, bodies
        self.name = {body: document.names.new(body) for body in bodies}
        """Name of the component of each body."""
        self._origins: dict[str, str] = {}
        self._frames: dict[tuple[str, float, float], str] = {}

    def at(self, marker: Any, user: str) -> str:
        """The frame at a marker, in the body's axes; it may be called after its ``user``."""
        body, x, y = marker.body.name, float(marker.x), float(marker.y)
        near = (key for key in self._frames if key[0] == body and max(abs(key[1] - x), abs(key[2] - y)) < SMALL)
        key = next(near, (body, x, y))
        if key not in self._frames:
            self._frames[key] = self._made(body, x, y, user)
        return self._frames[key]

    def _made(self, body: str, x: float, y: float, user: str) -> str:
        if body == GROUND:
            name = self._document.names.new(GROUND, user)
            made = self._document.add("Parts.Fixed", name, {"r": vector(x, y)}, f"place of '{user}'")
            return f"{made}.frame"
        origin = self._origin(body)
        return origin if max(abs(x), abs(y)) < SMALL else self._moved(origin, body, x, y, user)

    def _origin(self, body: str) -> str:
        """The frame that the author drew the body in."""
        if body not in self._origins:
            own, com = f"{self.name[body]}.frame_a", self._bodies[body].com
            if max(map(abs, com)) >= SMALL:
                name = self._document.names.new(body, "com")
                words = f"centre of mass of '{body}'"
                self._document.add("Parts.FixedTranslation", name, {"r": vector(*com)}, words)
                self._document.connect(f"{name}.frame_b", own)
                own = f"{name}.frame_a"
            self._origins[body] = own
        return self._origins[body]

    def _moved(self, origin: str, body: str, x: float, y: float, user: str) -> str:
        name = self._document.names.new(body, user)
        self._document.add("Parts.FixedTranslation", name, {"r": vector(x, y)}, f"place of '{user}' on '{body}'")
        self._document.connect(origin, f"{name}.frame_a")
        return f"{name}.frame_b"

    def add_body(self, body: str, start: Mapping[str, str]) -> None:
        """Declare a body with its mass; ``start`` are modifiers of its r, v, phi and w."""
        thing = self._bodies[body]
        mass = {"m": number(thing.mass), "I": number(thing.inertia)}
        self._document.add("Parts.Body", self.name[body], {**mass, **start}, f"body '{body}'")
