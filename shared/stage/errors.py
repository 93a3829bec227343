"""The one exception that a stage reports as a sentence instead of a traceback."""

from __future__ import annotations


class UserError(Exception):
    """Something the user can cause and cure; the message says what, where and how."""
