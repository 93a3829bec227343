"""The parts of a Modelica model: components with their modifiers, and connections."""

from __future__ import annotations

from collections.abc import Mapping

from mechanisms.stages.export.modelica.classes import CLASSES, text_of
from mechanisms.stages.export.modelica.identifiers import Identifiers, quoted


class Document:
    """Collects them; what is given first stands first."""

    def __init__(self, model: str) -> None:
        self.names = Identifiers(model)
        self.lines: list[str] = []
        self.connections: list[str] = []
        self._used: set[str] = set()

    def add(self, kind: str, name: str, modifiers: Mapping[str, str], words: str) -> str:
        """Declare a component of a class of this model, or of PlanarMechanics; returns its name."""
        if kind in CLASSES:
            self._used.add(kind)
        full = kind if kind in CLASSES else f"PlanarMechanics.{kind}"
        given = ", ".join(
            f"{key}{value}" if value.startswith("(") else f"{key}={value}" for key, value in modifiers.items()
        )
        self.lines.append(f"  {full} {name}{f'({given})' if given else ''} {quoted(words)};")
        return name

    def connect(self, first: str, second: str) -> None:
        """Join two frames."""
        self.connections.append(f"  connect({first}, {second});")

    def between(self, kind: str, name: str, ends: tuple[str, str], modifiers: Mapping[str, str], words: str) -> str:
        """A component with two frames, connected to two others."""
        made = self.add(kind, self.names.new(name), modifiers, words)
        self.connect(ends[0], f"{made}.frame_a")
        self.connect(f"{made}.frame_b", ends[1])
        return made

    @property
    def classes(self) -> list[str]:
        """The text of each class that is used."""
        return [text_of(name) for name in CLASSES if name in self._used]
