"""Values of arguments that were left out, derived by the function that adds an entry.

An argument that is None by default is found from the others: static friction from friction, the inertia of a bar from
its mass and length. What comes of it stands in the params like a number that was given, but it is none: it is found
anew when another argument changes, and no file holds it.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any, TypeVar

from mbsd.base.arguments import checked

F = TypeVar("F", bound=Callable[..., Any])


def adding(function: F) -> F:
    """``function(m, name, ...)``, which adds a joint, driver, force or contact, with its arguments checked.

    What it enters knows which of its params are ``derived``.
    """
    made = checked(function)
    signature = inspect.signature(function)
    optional = {p.name for p in signature.parameters.values() if p.default is None}
    if not optional:
        return made

    @functools.wraps(made)
    def inner(*given: Any, **named: Any) -> Any:
        added = made(*given, **named)
        bound = signature.bind(*given, **named).arguments
        left_out = {key for key in optional if bound.get(key) is None}
        m, name = bound["m"], bound["name"]
        for table in (m.joints, m.drivers, m.forces, m.contacts):
            if name in table:
                entry = table[name]
                derived = frozenset(key for key in left_out if entry.params.get(key) is not None)
                object.__setattr__(entry, "derived", derived)
        return added

    return inner  # pyright: ignore[reportReturnType]
