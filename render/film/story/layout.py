"""Where words, strip and captions of a story stand, in parts of the picture's shorter side."""

from __future__ import annotations

from render.film.composing.layout import sides

EDGE = 0.04
STRIP = 0.17
"""Height of the strip under the picture, with its edge."""
SIDE = 0.56
"""Width of the strip where it stands beside the machine, ..."""
UNDER = 0.18
"""... the height that it leaves to captions under it, ..."""
PANEL = 0.3
"""... and the height of each of its panels at most."""
CAPTION = 0.095
"""Height that a caption takes above it."""
LETTER, SMALL = 0.047, 0.034
"""Heights of letters: of captions, and of rates, names and numbers of the strip."""
LINES = 2
"""Lines of a caption at most."""


def below(aspect: float, strip: bool) -> float:
    """The part of the picture's height that a camera leaves empty for caption and strip."""
    return (CAPTION + (STRIP if strip else 0.0)) / sides(aspect)[1]


def beside(aspect: float) -> float:
    """The part of the picture's width that a camera leaves empty at the right for a strip that stands there."""
    return SIDE / sides(aspect)[0]


def above(aspect: float) -> float:
    """The same of the rate of time at the top."""
    return 0.05 / sides(aspect)[1]
