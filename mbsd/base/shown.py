"""A value of the user in a message: short, on one line, whatever it is."""

from __future__ import annotations

import reprlib

LONGEST = 80
"""Characters."""

_short = reprlib.Repr()
_short.maxlevel, _short.maxlist, _short.maxtuple, _short.maxdict, _short.maxset = 3, 6, 6, 4, 4
_short.maxarray, _short.maxstring, _short.maxother = 6, 60, 60


def shown(value: object) -> str:
    """``repr(value)``, cut where it is long; the type alone where that fails, as of a number of 5000 digits."""
    try:
        text = " ".join(_short.repr(value).split())
    except Exception:
        return f"a {type(value).__name__}"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
