"""Names are shown as they are written: matplotlib takes what stands between two dollar signs for a formula."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

F = TypeVar("F", bound=Callable[..., Any])


def literal(draw: F) -> F:
    """``draw``, whose texts are no formulas; without matplotlib it says itself what is missing."""

    @functools.wraps(draw)
    def inner(*given: Any, **named: Any) -> Any:
        try:
            import matplotlib as mpl
        except ImportError:
            return draw(*given, **named)
        with mpl.rc_context({"text.parse_math": False}):
            return draw(*given, **named)

    return cast(F, inner)
