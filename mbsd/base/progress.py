"""Functions of the user that are called while something runs: checked before, and what they raise reaches the user."""

from __future__ import annotations

import contextlib
import functools
import inspect
from collections.abc import Callable
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown

FROM_USER = "mbsd_from_user"
"""Attribute of what such a function raised: it is no error of a computation."""


def users_progress(what: str, function: Any, wanted: str, count: int = 1) -> Callable[..., None] | None:
    """``function``, which gets ``count`` arguments, as it is to be called; None stays None.

    ``what`` names mechanism and argument, ``wanted`` says which arguments. Raises ModelError for what is no
    function, or one that takes another number of arguments, as far as its signature says.
    """
    if function is None:
        return None
    if not callable(function):
        raise ModelError(f"{what} is {shown(function)}; it must be a function of {wanted}")
    try:
        inspect.signature(function).bind(*[None] * count)
    except ValueError:  # compiled functions may not say what they take
        pass
    except TypeError as error:
        raise ModelError(f"{what} must be a function of {wanted}: {error}") from None

    @functools.wraps(function, updated=())
    def called(*given: Any) -> None:
        try:
            function(*given)
        except Exception as error:
            with contextlib.suppress(AttributeError):
                setattr(error, FROM_USER, True)
            raise

    return called


def from_user(error: BaseException) -> bool:
    """Return True if a function of :func:`users_progress` raised it."""
    return getattr(error, FROM_USER, False)
