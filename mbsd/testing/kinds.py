"""All kinds that are registered, those of mbsd and those of the user, and comparisons of arrays."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from typing import Any

import numpy as np

import mbsd.dynamics.integrators
from mbsd.base.errors import ModelError
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.mechanism import Mechanism
from mbsd.model.change import given
from mbsd.model.force import FORCE_KINDS, Force, ForceKind
from mbsd.model.joint import CONTACT_KINDS, KINDS, ContactKind, Joint, JointKind
from mbsd.saving.document import build, document


def compare(
    what: str,
    given: np.ndarray,
    expected: np.ndarray,
    tolerance: float | np.ndarray,
    place: Callable[..., str] = lambda *index: f"at {index}",
) -> None:
    """Raise AssertionError if ``given`` is too far from ``expected``, or is no number.

    ``place`` puts the index of the worst element into words.
    """
    given, expected = np.broadcast_arrays(given, expected)
    distance = np.abs(given - expected)
    excess = np.where(np.isfinite(distance), distance - tolerance, np.inf)
    if not excess.size or excess.max() <= 0.0:
        return
    worst = tuple(int(k) for k in np.unravel_index(int(excess.argmax()), excess.shape))
    raise AssertionError(
        f"{what}, {place(*worst)}: {given[worst]:.9g} instead of {expected[worst]:.9g} "
        f"({np.count_nonzero(excess > 0.0)} of {excess.size} numbers differ)"
    )


def coordinate(bodies: list[str], column: int) -> str:
    """The name of a coordinate by its number, ground's three included."""
    return f"{('x', 'y', 'theta')[column % 3]} of '{bodies[column // 3]}'"


def joint_kinds() -> list[JointKind]:
    """Kinds of joints and drivers."""
    return list(KINDS.values())


def force_kinds() -> list[ForceKind]:
    """Kinds of forces."""
    return list(FORCE_KINDS.values())


def contact_kinds() -> list[ContactKind]:
    """Kinds of rigid contacts."""
    return list(CONTACT_KINDS.values())


def integrators() -> list[Integrator]:
    """Methods of simulate(), those whose package is not installed included."""
    for module in pkgutil.iter_modules(mbsd.dynamics.integrators.__path__):
        importlib.import_module(f"mbsd.dynamics.integrators.{module.name}")
    return list(INTEGRATORS.values())


def check_kept(m: Mechanism) -> None:
    """Change each number of the joining entry of ``m`` to itself, then write the model and read it back.

    Raises AssertionError where something else comes of it. Functions of the user are left out: no file holds them.
    """
    for table in ("joints", "drivers", "contacts", "forces"):
        for name, old in list(getattr(m, table).items()):
            kind = old.kind
            if kind.add is None:
                raise AssertionError(f"{kind.name}: decorate the function that adds one with @{kind.name.upper()}.adds")
            if not kind.saved:
                continue
            for key, value in given(old).items():
                _change(m, name, kind.name, key, value)
            _compare(kind.name, "change()", old, getattr(m, table)[name])
            try:
                loaded = build(document(m), Mechanism)
            except ModelError as error:
                raise AssertionError(f"{kind.name}: the example cannot be saved: {error}") from error
            _compare(kind.name, "a saved file", old, getattr(loaded, table)[name])


def _change(m: Mechanism, name: str, kind: str, key: str, value: Any) -> None:
    try:
        m.change(name, **{key: value})
    except (ModelError, TypeError) as error:
        raise AssertionError(
            f"{kind}: params hold '{key}', with which change() fails: {error}; keep the arguments of the function that "
            "adds one under their names"
        ) from error


def _compare(kind: str, after: str, old: Joint | Force, new: Joint | Force) -> None:
    if new.params != old.params or new.kind is not old.kind:
        raise AssertionError(f"{kind}: after {after} params are {dict(new.params)} instead of {dict(old.params)}")
    for side in "ij":
        here, there = (
            (marker.body.name, marker.x, marker.y, marker.angle) for marker in (getattr(old, side), getattr(new, side))
        )
        if here != there:
            raise AssertionError(f"{kind}: after {after} marker {side} is {there} instead of {here}")
