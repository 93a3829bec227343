"""Errors for unknown names: they list the known names and suggest the one that was probably meant.

:func:`no_such` words them, :class:`Named` raises them for a key, :class:`Suggesting` for an attribute.
"""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any, ClassVar, Generic, NoReturn, TypeVar

from mbsd.base.errors import ModelError

Value = TypeVar("Value")

LISTED = 30
"""Known names that a message lists."""
ALIKE = 0.6
"""Least likeness of difflib at which a name is offered."""


def no_such(what: str, name: object, known: Iterable[object]) -> str:
    """Return ``there is no body 'crnk', did you mean 'crank'? There is: ground, crank``.

    ``what`` says what was looked for; ``known`` are the names that there are, of which thirty are listed.
    """
    names = [str(known_name) for known_name in known]
    listed = ", ".join(names[:LISTED]) or "none"
    if len(names) > LISTED:
        listed += f" and {len(names) - LISTED} more"
    plain = isinstance(name, str) and len(name) < 60
    said = f"there is no {what} '{name}'" if plain else f"there is no {what} {shown(name)}"
    meant = _meant(name, names)
    return f"{said}; there is: {listed}" if meant is None else f"{said}, did you mean '{meant}'? There is: {listed}"


def names_in(what: str, value: object) -> list[str]:
    """Return one name or a list of names as a list; raises ModelError naming ``what`` it is for."""
    parts = [value] if isinstance(value, str) else list(value) if isinstance(value, list | tuple) else [None]
    if not all(isinstance(part, str) for part in parts):
        raise ModelError(f"{what} are {shown(value)}; give a list of names")
    return parts  # pyright: ignore[reportReturnType]


def _meant(name: object, names: list[str]) -> str | None:
    """Return the known name that is most like ``name``, in whatever case it is written; None if none is."""
    if not isinstance(name, str) or not 0 < len(name) <= 200:
        return None
    small: dict[str, str] = {}
    for known_name in names:
        small.setdefault(known_name.lower(), known_name)
    near = get_close_matches(name.strip().lower(), small, n=1, cutoff=ALIKE)
    return small[near[0]] if near else None


class UnknownNameError(ModelError, KeyError):
    """No item of a :class:`Named` has this name."""

    def __str__(self) -> str:
        return str(self.args[0])  # a KeyError shows the repr of its message


class Named(dict[str, Value], Generic[Value]):
    """A dictionary by name: ``d["crnk"]`` raises UnknownNameError with the names that there are.

    ``kind`` says what its values are: ``body``, ``joint``.
    """

    def __init__(self, kind: str, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(values or {})
        self.kind = kind

    def __missing__(self, name: object) -> NoReturn:
        raise UnknownNameError(no_such(self.kind, name, self))


class UnknownAttributeError(AttributeError):
    """An object has no attribute of this name; its text is made when it is shown, as few are."""

    def __str__(self) -> str:
        thing, name = self.args
        kind = type(thing)
        if name.startswith("_"):
            return f"{kind.__name__} has no attribute '{name}'"
        public = [known for known in {**vars(thing), **dict.fromkeys(dir(kind))} if not known.startswith("_")]
        public.remove("other_words")
        word = kind.other_words.get(name)
        meant = word if word in public else _meant(name, public)
        hint = f", did you mean '{meant}'?" if meant else ""
        if not meant and len(public) <= LISTED:
            hint = f"; it has: {', '.join(public)}"
        return f"{kind.__name__} has no attribute '{name}'{hint}"

    def __reduce__(self) -> tuple[Any, ...]:
        return AttributeError, (str(self),)  # the object may not go along


class Suggesting:
    """Raises AttributeErrors that suggest the attribute which was probably meant."""

    other_words: ClassVar[Mapping[str, str]] = {}
    """Attributes by other common words for them: ``pin`` is ``revolute``."""

    def __getattr__(self, name: str) -> Any:
        raise UnknownAttributeError(self, name)


LONGEST = 80
"""Characters."""

_short = reprlib.Repr()
_short.maxlevel, _short.maxlist, _short.maxtuple, _short.maxdict, _short.maxset = 3, 6, 6, 4, 4
_short.maxarray, _short.maxstring, _short.maxother = 6, 60, 60


def shown(value: object) -> str:
    """Return ``repr(value)``, cut if it is long.

    It is the type alone if repr fails, as for a number of 5000 digits.
    """
    try:
        text = " ".join(_short.repr(value).split())
    except Exception:
        return f"a {type(value).__name__}"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
