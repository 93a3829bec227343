"""What was hashed or looked up, remembered for a look at many stages that writes nothing."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_known: ContextVar[dict[Hashable, str] | None] = ContextVar("known", default=None)


@contextmanager
def remembered() -> Iterator[None]:
    """In this block every file is hashed once, and every version is looked up once."""
    token = _known.set({})
    try:
        yield
    finally:
        _known.reset(token)


def recalled(asked: Hashable, find: Callable[[], str]) -> str:
    """What ``find`` gives; in a block of :func:`remembered` it is called once for the same ``asked``."""
    known = _known.get()
    if known is None:
        return find()
    if asked not in known:
        known[asked] = find()
    return known[asked]
