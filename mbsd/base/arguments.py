"""Arguments of public functions: finite numbers, switches, names, functions of the user.

A public function is checked by the annotations of its parameters before it runs: ``float`` takes finite numbers,
``bool`` True or False, ``int`` whole numbers, ``str`` text; ``| None`` allows None. What other annotations mean, the
function checks. Text is never read as a number, nor True as 1. Raises ModelError with the mechanism or function, the
argument and the value. Functions and laws of the user are called so that errors give their name and the time.

An argument that is None by default is found from the others: static friction from friction, the inertia of a bar from
its mass and length. What comes of it stands in the params like a number that was given, but it is none: it is found
anew when another argument changes, and no file holds it.
"""

from __future__ import annotations

import contextlib
import functools
import inspect
import math
import types
import typing
import warnings
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numpy as np

from mbsd.base.errors import MechanismError, ModelError, ModelWarning
from mbsd.base.names import no_such, shown


def value_at(function: Callable[[float], Any], t: float, what: str) -> float:
    """Return ``function(t)`` as a finite float; ``what`` names it in errors.

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
    """Return parameters by name; None where its signature does not say them, or it takes any name."""
    try:
        parameters = dict(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        return None
    return None if any(p.kind is p.VAR_KEYWORD for p in parameters.values()) else parameters


def described(error: BaseException) -> str:
    """Return type and text of what a function raised, on one line."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


FROM_USER = "mbsd_from_user"
"""Attribute of what such a function raised: it is no error of a computation."""


def users_progress(what: str, function: Any, wanted: str, count: int = 1) -> Callable[..., None] | None:
    """Return ``function``, which gets ``count`` arguments, as it is to be called; None stays None.

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


F = TypeVar("F", bound=Callable[..., Any])
C = TypeVar("C", bound=type)

NUMBERS = (int, float, np.floating, np.integer)
LARGEST = 1e100
"""Largest size of any number: squares and products of a few such numbers can still be represented."""
SMALLEST = 1e-100
"""Smallest mass and moment of inertia that is not zero, likewise."""


def finite_number(what: str, value: object) -> float:
    """Return ``value`` as a float; raises ModelError if it is no finite number, or beyond 1e100."""
    if type(value) is float and -LARGEST <= value <= LARGEST:
        return value
    if isinstance(value, bool) or not isinstance(value, NUMBERS):
        raise ModelError(f"{what} is {shown(value)}; it must be a number")
    if value != value or value in (math.inf, -math.inf):
        raise ModelError(f"{what} is {value}; it must be finite")
    if not -LARGEST <= (value if isinstance(value, int) else float(value)) <= LARGEST:
        raise ModelError(f"{what} is {shown(value)}; it must be finite and not beyond {LARGEST:g}")
    return float(value)


def positive_number(what: str, value: object, unit: str = "") -> float:
    """Return ``value`` as a float above 0, in a ``unit`` that the message names; raises ModelError."""
    number = finite_number(what, value)
    if number <= 0.0:
        raise ModelError(f"{what} is {number:g}{unit and ' ' + unit}; it must be positive")
    return number


def not_negative_number(what: str, value: object, unit: str = "") -> float:
    """Return ``value`` as a float of 0 or more, in a ``unit`` that the message names; raises ModelError."""
    number = finite_number(what, value)
    if number < 0.0:
        raise ModelError(f"{what} is {number:g}{unit and ' ' + unit}; it cannot be negative")
    return number


def number_pair(what: str, value: object) -> tuple[float, float]:
    """Return ``value`` as two floats; raises ModelError if it is anything else."""
    first, second = several_numbers(what, value, 2, "it must be two numbers (x, y)")
    return first, second


def several_numbers(what: str, value: object, count: int, wanted: str) -> tuple[float, ...]:
    """Return ``value``, a list of ``count`` numbers, as floats; raises ModelError that names ``wanted``."""
    try:
        if isinstance(value, str | bytes | dict | set | frozenset):
            raise TypeError
        parts = tuple(value)  # pyright: ignore[reportArgumentType]
    except Exception:
        raise ModelError(f"{what} is {shown(value)}; {wanted}") from None
    if len(parts) != count:
        raise ModelError(f"{what} is {shown(value)}; {wanted}")
    return tuple(finite_number(what, part) for part in parts)


def number_array(what: str, value: object, finite: bool = True) -> np.ndarray:
    """Return ``value``, nested lists of numbers or an array, as an array of floats of any shape.

    Raises ModelError naming the place of what is no number, and where ``finite``, of what is not finite.
    """
    try:
        array = np.asarray(value)
    except Exception:
        raise ModelError(f"{what} is {shown(value)}; it must be a list of numbers, all rows equally long") from None
    plain = isinstance(value, list | tuple)
    if plain or array.dtype.kind == "O":
        for at, number in _entries(value if plain else array):
            finite_number(f"{what}{at}", number) if finite else _number(f"{what}{at}", number)
    if array.dtype.kind not in "fiuO":
        raise ModelError(f"{what} is {shown(value)}; it must be numbers")
    try:
        out = array.astype(float)
    except (OverflowError, TypeError, ValueError):
        raise ModelError(f"{what} is {shown(value)}; its numbers must be finite") from None
    if finite and not (np.abs(out) <= LARGEST).all():
        at = np.unravel_index(int(np.argmin(np.abs(out) <= LARGEST)), out.shape)
        finite_number(f"{what}{''.join(f'[{k}]' for k in at)}", float(out[at]))
    return out


def _entries(value: Any, at: str = "", level: int = 0) -> Iterator[tuple[str, Any]]:
    """Yield entries of nested lists and arrays with their positions; finite floats are passed over."""
    if isinstance(value, np.ndarray) and (value.ndim == 0 or value.dtype.kind in "fiu"):
        yield from () if value.ndim else [(at, value.item())]
    elif level < 4 and isinstance(value, list | tuple | np.ndarray):
        for k, entry in enumerate(value):
            if type(entry) is not float or not math.isfinite(entry):
                yield from _entries(entry, f"{at}[{k}]", level + 1)
    elif level < 4 and np.ndim(value):
        yield from _entries(np.asarray(value), at, level + 1)
    else:
        yield at, value


def _number(what: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, NUMBERS):
        raise ModelError(f"{what} is {shown(value)}; it must be a number")


def whole_number(what: str, value: object, least: int = 1) -> int:
    """Return ``value`` as an int; raises ModelError if it is no whole number, or below ``least``."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer) or value < least:
        said = "above zero" if least == 1 else f"from {least} on"
        raise ModelError(f"{what} is {shown(value)}; it must be a whole number {said}")
    return int(value)


def switch(what: str, value: object) -> bool:
    """Return ``value`` as a bool; raises ModelError for anything else than True or False."""
    if not isinstance(value, bool | np.bool_):
        raise ModelError(f"{what} is {shown(value)}; it must be True or False")
    return bool(value)


def text(what: str, value: object) -> str:
    """Return ``value``, which must be a str; raises ModelError."""
    if not isinstance(value, str):
        raise ModelError(f"{what} is {shown(value)}; it must be a text")
    return value


def _whole(what: str, value: object) -> object:
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise ModelError(f"{what} is {shown(value)}; it must be a whole number")
    return value


CHECKS: dict[str, Callable[[str, Any], object]] = {
    "float": finite_number,
    "int": _whole,
    "bool": switch,
    "str": text,
}
"""Checks by annotation; they return what the function is given. Bodies and markers enter theirs (mbsd/model/body.py).
"""
ORDERED = {"Body | str", "Marker"}
"""Types that are easily given at the wrong place: their errors tell the order of the arguments."""


def annotation_of(parameter: inspect.Parameter) -> str:
    """Return the type of a parameter as it is written, whether or not its file postpones annotations."""
    given = parameter.annotation
    return given.__name__ if isinstance(given, type) else str(given)


def types_of(function: Callable[..., Any]) -> dict[str, tuple[Any, ...]]:
    """Return the types that each parameter may have, by its name: ``float | None`` is (float, NoneType).

    An annotation that is not known where the function stands, as what is imported for type checkers alone, stays text.
    """
    plain = inspect.unwrap(function)
    out: dict[str, tuple[Any, ...]] = {}
    for p in inspect.signature(plain).parameters.values():
        given = p.annotation
        if isinstance(given, str):
            try:
                given = eval(given, plain.__globals__)
            except (NameError, AttributeError, SyntaxError, TypeError):
                given = p.annotation
        united = isinstance(given, types.UnionType) or typing.get_origin(given) is typing.Union
        out[p.name] = typing.get_args(given) if united else (given,)
    return out


def checked(function: F) -> F:
    """Return ``function`` with its arguments checked by their annotations, before it runs."""
    if getattr(function, "arguments_checked", False):
        return function
    signature = inspect.signature(function)
    parameters = list(signature.parameters.values())
    method = bool(parameters) and parameters[0].name in ("self", "m")
    checks = {p.name: check for p in parameters if (check := _check_of(annotation_of(p), signature)) is not None}
    places = [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    rest = next((p for p in parameters if p.kind is p.VAR_POSITIONAL), None)
    named = next((p for p in parameters if p.kind is p.VAR_KEYWORD), None)
    own = {p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)}
    needed = [p.name for p in parameters if p.name in own and p.default is p.empty]

    @functools.wraps(function)
    def inner(*given: Any, **keywords: Any) -> Any:
        of_one = bool(given) and (method or hasattr(given[0], "bodies"))  # a method, or a function of a mechanism
        owner = getattr(given[0], "name", None) if of_one else None
        where = function.__name__ if owner is None else f"{owner}: {function.__name__}"
        _refuse_misnamed(where, given, keywords)
        given_name = given[1] if len(given) > 1 else keywords.get("name")
        what = (
            f"{where} '{given_name}'" if method and places[1:2] == ["name"] and isinstance(given_name, str) else where
        )
        positional: list[Any] = list(given)
        for k, value in enumerate(given):
            check = checks.get(places[k]) if k < len(places) else checks.get(rest.name) if rest is not None else None
            if check is not None:
                name = places[k] if k < len(places) else f"argument {k + 1 - method}"
                positional[k] = check(f"{what}: {name}", value)
        for name, value in keywords.items():
            check = checks.get(name) if name in own else checks.get(named.name) if named is not None else None
            if check is not None:
                keywords[name] = check(f"{what}: {name}", value)
        try:
            return function(*positional, **keywords)
        except (ArithmeticError, np.linalg.LinAlgError, MemoryError, RecursionError) as error:
            if from_user(error):
                raise
            raise ModelError(
                f"{what}: numbers go beyond what can be computed ({described(error)}). Look at the largest and "
                "smallest lengths, masses and stiffnesses, and at how much is asked for at once"
            ) from error

    def _refuse_misnamed(where: str, given: tuple[Any, ...], keywords: dict[str, Any]) -> None:
        if len(given) > len(places) and rest is None:
            most = len(places) - method
            if not most and named is not None:
                raise ModelError(f"{where} takes values by names alone: {function.__name__}({_word(given[1])}=...)")
            raise ModelError(
                f"{where} takes {most} arguments at most, got {len(given) - method}; "
                f"{in_order(function.__name__, signature)}"
            )
        if named is None:
            for name in keywords:
                if name not in own:
                    raise ModelError(
                        f"{where}: {no_such('argument', name, [p for p in own_names if p not in ('self', 'm')])}"
                    )
        for name in places[: len(given)]:
            if name in keywords:
                raise ModelError(f"{where}: {name} is given twice")
        for name in needed:
            if name not in keywords and name not in places[: len(given)]:
                raise ModelError(f"{where}: {name} is missing; {in_order(function.__name__, signature)}")

    own_names = [p.name for p in parameters if p.name in own]
    inner.arguments_checked = True  # pyright: ignore[reportAttributeAccessIssue]
    return inner  # pyright: ignore[reportReturnType]


def _check_of(annotation: str, signature: inspect.Signature) -> Callable[[str, Any], object] | None:
    words = [word.strip() for word in annotation.split("|")]
    wanted = " | ".join(word for word in words if word != "None")
    check = CHECKS.get(wanted)
    if check is None:
        return None
    if wanted in ORDERED:
        check = _telling_order(check, signature)
    if "None" not in words:
        return check
    return lambda what, value: None if value is None else check(what, value)


def _telling_order(check: Callable[[str, Any], object], signature: inspect.Signature) -> Callable[[str, Any], object]:
    def inner(what: str, value: Any) -> object:
        try:
            return check(what, value)
        except ModelError as error:
            raise ModelError(f"{error}; {in_order('', signature)}") from None

    return inner


def in_order(name: str, signature: inspect.Signature) -> str:
    """Return the arguments of a method or function of the mechanism, as they are written."""
    parameters = [p for p in signature.parameters.values() if p.name not in ("self", "m")]
    words = [f"*{p.name}" if p.kind is p.VAR_POSITIONAL else p.name for p in parameters]
    return f"the arguments are {name}({', '.join(words)})"


def _word(given: object) -> str:
    """Return the words about a missing name that a value given without one stands for."""
    name = getattr(given, "name", given)
    return name if isinstance(name, str) and name.isidentifier() else "name"


def checked_methods(cls: C) -> C:
    """Return a class whose public methods, inherited ones too, are :func:`checked`.

    They name the object's ``name``.
    """
    for name, member in inspect.getmembers(cls, inspect.isfunction):
        if not name.startswith("_") and not isinstance(inspect.getattr_static(cls, name), staticmethod):
            setattr(cls, name, checked(member))
    return cls


def adding(function: F) -> F:
    """Return ``function(m, name, ...)``, which adds a joint, driver, force or contact, with checks.

    Its arguments are checked.

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
