"""Functions that an author writes for a stage: whether they take what the stage gives them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from shared.stage.errors import UserError


def refuse_arguments(file: str, function: Callable[..., Any], *given: Any) -> None:
    """Raise UserError for a function of ``file`` that cannot be called so, as far as its signature says."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return
    try:
        signature.bind(*given)
    except TypeError as error:
        name = getattr(function, "__name__", "it")
        count = f"{len(given)} argument{'s' * (len(given) > 1)}"
        raise UserError(f"{file}: {name}({', '.join(signature.parameters)}) is called with {count}: {error}") from None
