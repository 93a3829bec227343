"""Text that comes in pieces, as lines of a bounded length: longer ones are cut, the rest is skipped."""

from __future__ import annotations

LONGEST = 2000
"""Characters of a line."""
CUT = " ..."


class Lines:
    """Cutter of text into lines; no piece is too long, and no more than one line is kept."""

    def __init__(self) -> None:
        self._begun, self._over = "", False

    def add(self, text: str) -> list[str]:
        """Add text and return the lines that it ends."""
        *whole, rest = text.split("\n")
        lines = []
        for piece in whole:
            self._append(piece)
            lines.append(self.rest())
        self._append(rest)
        return lines

    def rest(self) -> str:
        """Return the line that has no end yet; a new one begins."""
        line = self._begun.rstrip("\r") + CUT * self._over
        self._begun, self._over = "", False
        return line

    def _append(self, piece: str) -> None:
        room = LONGEST - len(self._begun)
        self._over = self._over or len(piece) > room
        self._begun += piece[:room]
