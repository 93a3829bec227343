"""Cache of hashes and lookups, for a look at many stages that writes nothing."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_known: ContextVar[dict[Hashable, str] | None] = ContextVar("known", default=None)


@contextmanager
def remembered() -> Iterator[None]:
    """Hash every file once and look up every version once in this block."""
    token = _known.set({})
    try:
        yield
    finally:
        _known.reset(token)


def recalled(asked: Hashable, find: Callable[[], str]) -> str:
    """Return the result of ``find``; in a block of :func:`remembered` it runs once for ``asked``."""
    known = _known.get()
    if known is None:
        return find()
    if asked not in known:
        known[asked] = find()
    return known[asked]
