"""Cache of built solids, since screws, washers and bushings of the same numbers occur many times."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, wraps

import cadquery as cq


def built_once[**P](builder: Callable[P, cq.Workplane]) -> Callable[P, cq.Workplane]:
    """Return a builder that builds once for the same arguments; each call gives its own Workplane."""

    @cache
    def solid(*args: P.args, **kwargs: P.kwargs) -> cq.Shape:
        return builder(*args, **kwargs).val()  # pyright: ignore[reportReturnType]  (a builder's value is a shape)

    @wraps(builder)
    def build_once(*args: P.args, **kwargs: P.kwargs) -> cq.Workplane:
        return cq.Workplane(obj=solid(*args, **kwargs))

    return build_once
