"""A model as it was, to put back what a number has changed of it."""

from __future__ import annotations

from collections.abc import Mapping
from operator import is_
from typing import Any

from mbsd.model.mechanism import Model, connections


class SavedModel:
    """Tables, bodies and gravity of a model as they are now."""

    def __init__(self, m: Model) -> None:
        self.m = m
        tables: tuple[Any, ...] = (*connections(m), m.events, m.traces, m.starts, m.velocities)
        self._tables = [(table, dict(table)) for table in tables]
        self.bodies = [(body, dict(body.__dict__)) for body in m.bodies.values()]
        """Each body and its values."""
        self.gravity = m.gravity
        self.traces = dict(m.traces)

    def before(self, table: Mapping[str, Any]) -> Mapping[str, Any]:
        """What one of the tables of the model held; nothing of another model."""
        return next((before for own, before in self._tables if own is table), {})

    def restore(self) -> None:
        """Put everything back."""
        for table, before in self._tables:
            if len(table) != len(before) or not all(map(is_, table.values(), before.values())):
                table.clear()
                table.update(before)
        for body, own in self.bodies:
            if body.__dict__ != own:
                body.__dict__.clear()
                body.__dict__.update(own)
        self.m.gravity = self.gravity
