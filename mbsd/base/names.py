"""Words for a name that is not known: what there is, and the name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown

LISTED = 30
"""Known names that a message lists."""
ALIKE = 0.6
"""Least likeness of difflib at which a name is offered."""


def no_such(what: str, name: object, known: Iterable[object]) -> str:
    """``there is no body 'crnk', did you mean 'crank'? There is: ground, crank``.

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
    """``value``, one name or a list of names, as a list; raises ModelError naming ``what`` it is for."""
    parts = [value] if isinstance(value, str) else list(value) if isinstance(value, list | tuple) else [None]
    if not all(isinstance(part, str) for part in parts):
        raise ModelError(f"{what} are {shown(value)}; give a list of names")
    return parts  # pyright: ignore[reportReturnType]


def _meant(name: object, names: list[str]) -> str | None:
    """The known name that is most like ``name``, in whatever case it is written; None if none is."""
    if not isinstance(name, str) or not 0 < len(name) <= 200:
        return None
    small: dict[str, str] = {}
    for known_name in names:
        small.setdefault(known_name.lower(), known_name)
    near = get_close_matches(name.strip().lower(), small, n=1, cutoff=ALIKE)
    return small[near[0]] if near else None
