"""What a story stops for: an event or a peak of the motion, as plain data; ``render/report/reasons.py`` has them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

Kind = Literal["impact", "turns_back", "event", "effort", "reaction", "speed"]


@dataclass(frozen=True)
class Reason:
    """Something that is worth a stop."""

    time: float
    """s"""
    kind: Kind
    name: str
    """What it happens to: a contact, a follower, an event, a driver or force, a joint, a point."""
    amount: str = ""
    """How much, with its unit."""
    joint: str = ""
    """The joint that carries most at that time, if joints carry anything ..."""
    force: str = ""
    """... and how much."""
    words: tuple[str, ...] = field(default=())
    """By which an author may ask for it."""
