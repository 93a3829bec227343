"""Exceptions that a stage reports as a sentence instead of a traceback."""

from __future__ import annotations

BUSY = 75
"""Exit code of a stage whose files another process has just now; EX_TEMPFAIL of <sysexits.h>."""


class UserError(Exception):
    """Error that the user can cause and cure; the message says what, where and how."""

    code = 1
    """Exit code of a process that ends by it."""


class Busy(UserError):
    """Error for files that another process uses; the same command works when that one has ended."""

    code = BUSY
