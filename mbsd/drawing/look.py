"""Colours and strokes of the drawings. Colours of bodies are dark enough for text and apart for colour-blind eyes."""

from __future__ import annotations

INK = "#20252b"
QUIET = "#6b747e"
FAINT = "#e9ecef"
PAPER = "#ffffff"
MOVED = "#c2410c"
"""Drivers."""
LOAD = "#4b5563"
"""Forces."""
WRONG = "#c81e1e"
"""Open joints, redundant joints."""
AXIS_X, AXIS_Y = "#d0453a", "#2f8f4e"
PALETTE = ("#0b62a8", "#00805e", "#a83a82", "#8a6d00", "#5a4fcf", "#3b7d8c", "#8f4a1d", "#4d6b1f")


def colour(index: int) -> str:
    """The colour of the body with this number, ground not counted."""
    return PALETTE[index % len(PALETTE)]
