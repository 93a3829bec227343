"""Forces in place of joints, as a pin with play: joints hold at the start, then forces alone.

What closes is a copy of the mechanism with these joints; what its closed pose decides about the others is taken over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.relative import FIRST_OWN
from mbsd.arrays.starts import copied
from mbsd.base.errors import AssemblyError
from mbsd.equations.relative.equation import ACTIVE, ARM, AT
from mbsd.model.mechanism import Model

Start = TypeVar("Start")
"""Initial conditions."""


def with_ideal_joints(m: Model) -> Model | None:
    """Return the mechanism with the joints that hold at its start; None where all its joints are there."""
    ideal = {name: force.kind.ideal(force) for name, force in m.forces.items() if force.kind.ideal is not None}
    joints = {name: joint for name, joint in ideal.items() if joint is not None}
    if not joints:
        return None
    out = copied(m)
    out.joints = {**m.joints, **joints}
    out.forces = {name: force for name, force in m.forces.items() if name not in joints}
    return out


@contextmanager
def closing_as(m: Model, joined: Model) -> Iterator[None]:
    """Yield where ``joined`` does not close, the error says what may start open. Raises AssemblyError."""
    try:
        yield
    except AssemblyError as error:
        names = ", ".join(f"'{name}'" for name in joined.joints if name not in m.joints)
        raise AssemblyError(
            f"{error} {names} {'starts' if names.count(',') == 0 else 'start'} closed, without play; with start=None "
            "bodies start where start_near puts them"
        ) from error


def packed_like(joined: Model, packed: Packed) -> Packed:
    """Return ``joined`` as arrays, with the laws of ``packed``, which are ready for its times."""
    out = pack(joined)
    out.motions = packed.motions
    return out


def take_from(packed: Packed, joined: Packed) -> None:
    """Copy phases and turns to ``packed`` from a packing with more joints, whose start is closed."""
    own = {joint.name for joint in packed.joints}
    special, numbers = packed.system.special.copy(), packed.system.numbers.copy()
    common = [
        row for row, joint in zip(joined.system.special, joined.specials.joints, strict=True) if joint.name in own
    ]
    for row, decided in zip(special, common, strict=True):
        row[[ARM, ACTIVE]] = decided[[ARM, ACTIVE]]
        numbers[row[AT] : row[AT] + FIRST_OWN] = joined.system.numbers[decided[AT] : decided[AT] + FIRST_OWN]
    packed.system = packed.system.changed(
        special=special, numbers=numbers, angle_offset=joined.system.angle_offset.copy()
    )


def closed_ideally(m: Model, packed: Packed, initial_of: Callable[[Model, Packed], Start]) -> tuple[Start, bool]:
    """Return the start by ``initial_of`` with the joints that hold then, and True if there are any.

    Raises AssemblyError where it does not close.
    """
    joined = with_ideal_joints(m)
    if joined is None:
        return initial_of(m, packed), False
    whole = packed_like(joined, packed)
    with closing_as(m, joined):
        start = initial_of(joined, whole)
    take_from(packed, whole)
    return start, True
