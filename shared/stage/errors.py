"""Exceptions that a stage reports as a sentence without a traceback, and hints for unknown names."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

# Exceptions that a stage reports as a sentence instead of a traceback.


BUSY = 75
"""Exit code of a stage whose files another process has just now; EX_TEMPFAIL of <sysexits.h>."""


class UserError(Exception):
    """Error that the user can cause and cure; the message says what, where and how."""

    code = 1
    """Exit code of a process that ends by it."""


class Busy(UserError):
    """Error for files that another process uses; the same command works when that one has ended."""

    code = BUSY


# Suggestions for an unknown name: the known name that was probably meant.


ALIKE = 0.6
"""Least similarity (0..1, difflib) of a name that is suggested."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return ``; did you mean 'crank'?`` for the end of an error; empty if no known name is alike.

    Case is ignored.
    """
    by_lower = {other.lower(): other for other in known}
    matches = get_close_matches(name.lower(), by_lower, n=1, cutoff=ALIKE)
    return f"; did you mean '{by_lower[matches[0]]}'?" if matches else ""
