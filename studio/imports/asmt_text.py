"""Text of an .asmt file, read by its tabs: entries with their values and the entries below."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from shared.stage.errors import UserError
from studio.imports.limits import check_depth


@dataclass
class Entry:
    """One word with the lines indented below it; numbers and texts are entries with nothing below."""

    word: str
    line: int
    below: list[Entry] = field(default_factory=list)

    def all_named(self, word: str) -> Iterator[Entry]:
        """Return the entries below that are called so."""
        return (entry for entry in self.below if entry.word == word)

    def named(self, word: str) -> Entry | None:
        """Return the first entry below of this name, None if there is none."""
        return next(self.all_named(word), None)

    def text(self, word: str) -> str:
        """Return the one line below an entry; raises UserError if it is missing."""
        entry = self.named(word)
        if entry is None or not entry.below:
            raise UserError(f"line {self.line}: {self.word} has no {word}")
        return entry.below[0].word.strip()

    def number(self, word: str, usual: float | None = None) -> float:
        """Return the number below an entry; ``usual`` if it is missing."""
        if usual is not None and self.named(word) is None:
            return usual
        return _numbers(self.text(word), self.line)[0]

    def vector(self, word: str) -> np.ndarray:
        """Return three numbers of a line, zeros if they are missing."""
        entry = self.named(word)
        if entry is None or not entry.below:
            return np.zeros(3)
        return np.array(_numbers(entry.below[0].word, entry.line, 3))

    def matrix(self) -> np.ndarray:
        """Return the rotation matrix; the identity if it is missing."""
        entry = self.named("RotationMatrix")
        if entry is None:
            return np.eye(3)
        if len(entry.below) < 3:
            raise UserError(f"line {entry.line}: RotationMatrix has {len(entry.below)} rows; it needs three")
        return np.array([_numbers(row.word, row.line, 3) for row in entry.below[:3]])


def parsed(text: str) -> Entry:
    """Return the whole file. Raises UserError if it is not indented by tabs."""
    root = Entry("", 0)
    path = [root]
    for number, line in enumerate(text.splitlines(), 1):
        word = line.strip("\t ")
        if not word:
            continue
        depth = len(line) - len(line.lstrip("\t"))
        if depth >= len(path):
            raise UserError(f"line {number} is indented by {depth} tabs below one with {len(path) - 2}")
        check_depth(depth, f"line {number}")
        del path[depth + 1 :]
        entry = Entry(word, number)
        path[-1].below.append(entry)
        path.append(entry)
    return root


def _numbers(text: str, line: int, count: int = 1) -> list[float]:
    """Return ``count`` finite numbers or more. Raises UserError with the line."""
    try:
        numbers = [float(word.replace("d", "e") if word.count("d") == 1 else word) for word in text.split()]
    except ValueError:
        raise UserError(f"line {line}: {text.strip()[:60]!r} are no numbers") from None
    if len(numbers) < count or not all(math.isfinite(number) for number in numbers):
        raise UserError(f"line {line}: {text.strip()[:60]!r} should be {count} finite numbers")
    return numbers[:count]
