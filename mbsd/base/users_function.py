"""Functions and laws of the user, called so that errors are reported with their name and the time."""

from __future__ import annotations

import contextlib
import functools
import inspect
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd.base.errors import MechanismError, ModelError, ModelWarning
from mbsd.base.names import shown


def value_at(function: Callable[[float], Any], t: float, what: str) -> float:
    """``function(t)`` as a finite float; ``what`` names it in errors.

    Raises ModelError with the time (s): what the function raised is its cause, what it returned is in its text.
    """
    try:
        value = function(t)
    except Exception as error:
        raise ModelError(f"{what} fails at t = {t:g} s: {described(error)}") from error
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise ModelError(f"{what} gives {shown(value)} at t = {t:g} s; it must be a number")
    try:
        value = float(value)
    except OverflowError:
        value = float("inf")
    if not abs(value) <= 1.7e308:
        raise ModelError(f"{what} gives {value} at t = {t:g} s; it must be finite")
    return value


class law_of:
    """Context that puts ``what``, a mechanism, driver or force, before the text of a law's error."""

    def __init__(self, what: str) -> None:
        self.what = what

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> None:
        if isinstance(error, ModelError):
            raise type(error)(f"{self.what}: {error}") from error.__cause__ or error
        if isinstance(error, Exception) and not isinstance(error, MechanismError):
            raise ModelError(f"{self.what}: its law fails: {described(error)}") from error


def tell_missed(what: str, law: object) -> None:
    """Warn of parts of a law that its fit did not resolve; ``what`` names mechanism and driver or force."""
    missed = getattr(law, "missed", None)
    if missed:
        warnings.warn(f"{what}: {missed}", ModelWarning, stacklevel=5)


def refuse_other_arguments(what: str, function: Callable[..., Any], given: str) -> None:
    """Raise ModelError if ``function`` cannot be called with one argument, by its signature."""
    try:
        inspect.signature(function).bind(None)
    except ValueError:  # compiled functions may not say what they take
        return
    except TypeError as error:
        raise ModelError(f"{what} must be a function of {given}, a single argument: {error}") from None


def named_parameters(function: Callable[..., Any]) -> dict[str, inspect.Parameter] | None:
    """Parameters by name; None where its signature does not say them, or it takes any name."""
    try:
        parameters = dict(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        return None
    return None if any(p.kind is p.VAR_KEYWORD for p in parameters.values()) else parameters


def described(error: BaseException) -> str:
    """Type and text of what a function raised, on one line."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


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
