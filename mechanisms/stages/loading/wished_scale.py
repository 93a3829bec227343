"""The scale at which the parts of a mechanism are being made, for automatic parts that a parts.py asks for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from shared.stage.scale import Scale

_WISHED: ContextVar[Scale | None] = ContextVar("scale", default=None)


@contextmanager
def scaling(scale: Scale | None) -> Iterator[None]:
    """Have parts that are made in this block fit a model of this scale; None for the machine itself."""
    token = _WISHED.set(scale)
    try:
        yield
    finally:
        _WISHED.reset(token)


def wished_scale() -> Scale | None:
    """The scale of the parts that are being made; None where they are those of the machine itself."""
    return _WISHED.get()
