"""Outcome of the parts of one mechanism."""

from __future__ import annotations

import re

BUILT, REFUSED, STUCK = "built", "refused", "no motion"
COLLIDES, UNSOUND, ERROR, HUNG = "collides", "unsound", "error", "hung"
"""no motion: the mechanism itself cannot follow. unsound: a solid that is open, in pieces, or overlaps another one of
its body. error: what a user would see as a traceback."""
STATES = (BUILT, REFUSED, STUCK, COLLIDES, UNSOUND, ERROR, HUNG)
WRONG = (COLLIDES, UNSOUND, ERROR, HUNG)

_NAMED = re.compile(r"'[^']*'")
_NUMBER = re.compile(r"[-+]?\d[\d.e+-]*")
_REASONS = ("no order of layers", "has no automatic parts", "have no automatic parts", "must hang from a bridge")
_PROVEN, _GIVEN_UP = "between two samples of data.json", "was given up: their"


def reason(text: str) -> str:
    """A refusal without the names and numbers of the case, so that equal ones are counted together."""
    for words in _REASONS:
        if words in text:
            kind = re.search(r"is an? ([\w -]+?), which|a part on (ground)", text)
            return f"{words}: {next(word for word in kind.groups() if word)}" if kind else words
    if _PROVEN in text:
        return "the motion is too quick for its samples to prove it"
    if _GIVEN_UP in text:
        return "the search for the least gap was given up"
    text = text.partition(": ")[2] or text
    return _NUMBER.sub("0", _NAMED.sub("'...'", text))[:110]
