"""Messages about workers, and the error that ends a deal; studies and stages each give their own words."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple


class Voice(NamedTuple):
    """Words of one program, with ``{where}`` the scheduler is, ``{shown}`` workers and why they do nothing, and others
    that stand in these texts.
    """

    say: Callable[[str], None]
    warn: Callable[[str], None]
    error: Callable[[str], Exception]
    """The error of which a user can cure the cause."""
    duration: Callable[[float], str]
    no_scheduler: str
    gone: str
    silent: str
    """The scheduler has been so for too long."""
    nobody: str
    """No worker is left, and none comes."""
    without: str
    """No worker is there that can do it now."""
    one_comes: str
    """What is waited for then."""
    lied: str
    failed: str
    left_out: str
    """A worker failed for the last time."""
