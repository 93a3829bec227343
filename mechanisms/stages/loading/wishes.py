"""Wishes of parts.py for all parts: the mount and the scale."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from mechanisms.stages.loading.loading import has, load
from shared.contract.parts import Kind
from shared.contract.shot import Shot, refuse_unsound
from shared.stage.paths import shown_file
from shared.stage.scale import Scale

# How the author of shot.py has a mechanism stand: the one field of shot.py that parts follow from.

_WISHED: ContextVar[Kind | None] = ContextVar("wished", default=None)
"""Mount of the mechanism whose parts are being made."""


def of_shot(name: str) -> Kind | None:
    """``mount`` of a mechanism's shot.py; None where there is none, or none is said.

    Modules that shot.py loads are forgotten again, so that whatever runs next loads and records what it reads by
    itself. Raises UserError where shot.py cannot be imported or its shot is unsound.
    """
    if not has(name, "shot"):
        return None
    before = dict(sys.modules)
    try:
        shot = load(name, "shot").shot
    finally:
        for module in [loaded for loaded in sys.modules if loaded.startswith("mechanisms.") and loaded not in before]:
            if not module.startswith("mechanisms.stages"):
                del sys.modules[module]
    if not isinstance(shot, Shot):
        return None  # the shot stage refuses it
    return refuse_unsound(shot, shown_file(name, "shot")).mount


@contextmanager
def wishing(kind: Kind | None) -> Iterator[None]:
    """Have parts that are made in this block stand as their author wishes."""
    token = _WISHED.set(kind)
    try:
        yield
    finally:
        _WISHED.reset(token)


def wished() -> Kind | None:
    """Return how the mechanism whose parts are being made is to stand; None where nobody says."""
    return _WISHED.get()


# The scale at which the parts of a mechanism are being made, for automatic parts that a parts.py asks for.

_SCALE: ContextVar[Scale | None] = ContextVar("scale", default=None)


@contextmanager
def scaling(scale: Scale | None) -> Iterator[None]:
    """Have parts that are made in this block fit a model of this scale; None for the machine itself."""
    token = _SCALE.set(scale)
    try:
        yield
    finally:
        _SCALE.reset(token)


def wished_scale() -> Scale | None:
    """Return the scale of the parts that are being made; None where they are those of the machine itself."""
    return _SCALE.get()
