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
        self._before = {id(table): (table, before) for table, before in self._tables}
        self.bodies = [(body, dict(body.__dict__)) for body in m.bodies.values()]
        """Each body and its values."""
        self.gravity = m.gravity
        self.traces = dict(m.traces)

    def before(self, table: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return what one of the tables of the model held; nothing of another model."""
        own = self._before.get(id(table))
        return own[1] if own is not None and own[0] is table else {}

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
        if self.m.gravity is not self.gravity:
            self.m.gravity = self.gravity
