"""Directory of the numbers of each force in the tables of a packed mechanism.

It is the one place that counts them.

    law         rows of Laws: 0 is the constant zero, then drivers, then the laws of forces
    element     rows of Loads.element and Loads.place
    term        rows of Loads.term and Loads.number
    interaction rows of Loads.interaction; block: of each of these, its part of Loads.given
    user        rows of Loads.user; user_body: of Loads.user_body and Loads.user_com
    friction    rows of Loads.friction and Loads.friction_number

Packing (loads.py) writes where the directory says. Whoever puts another number into tables, or reads one, asks it too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mbsd.equations.loads import Loads
from mbsd.model.force import Element, Force, Interaction, Masses, Term

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

FRAME = 7
"""Numbers of an interaction before its own: arm and axis of i, arm of j, angle between both."""


class ForceRows(NamedTuple):
    """A force, what it is made of, and the rows of the tables that are its own."""

    force: Force
    markers: Sequence[int]
    """Numbers of i and j."""
    elements: tuple[Element, ...]
    interactions: Sequence[Interaction]
    blocks: Sequence[range]
    """Rows of Loads.given, of each interaction its numbers."""
    law: range
    element: range
    term: range
    interaction: range
    user: range
    user_body: range
    friction: range

    def law_row(self, name: str | None) -> int:
        """Return the row of one of its laws; that of the constant zero for None."""
        return 0 if name is None else self.law[list(self.force.laws).index(name)]

    def entries(self, loads: Loads) -> Iterator[tuple[np.ndarray, tuple[int, ...]]]:
        """Yield array and index of each number that :func:`numbers_of` gives."""
        yield from ((loads.number, (row, column)) for row in self.term for column in range(3))
        for own, block in zip(self.interactions, self.blocks, strict=True):
            yield from ((loads.given, (place,)) for place in block[len(block) - len(own.numbers) :])

    def alone(self, loads: Loads) -> Loads:
        """Return the loads of this force and of no other."""
        element, interaction, user, friction = map(slice_of, (self.element, self.interaction, self.user, self.friction))
        return loads._replace(
            element=loads.element[element],
            place=loads.place[element],
            interaction=loads.interaction[interaction],
            user=loads.user[user],
            friction=loads.friction[friction],
            friction_number=loads.friction_number[friction],
            total=len(self.element) + len(self.interaction) + len(self.user),
        )


def slice_of(rows: range) -> slice:
    """Return rows as the slice that takes them."""
    return slice(rows.start, rows.stop)


def directory(packed: Packed) -> dict[str, ForceRows]:
    """Return the rows of each force by its name, in the order of packing."""
    out: dict[str, ForceRows] = {}
    masses = packed.masses
    ends = [len(packed.motions) + 1, 0, 0, 0, 0, 0, 0]
    given = 0
    for force, markers in zip(packed.forces, packed.force_markers.tolist(), strict=True):
        kind, params = force.kind, force.params
        elements, interactions = kind.elements(force), kind.interactions(force, masses)
        blocks: list[range] = []
        for own in interactions:
            blocks.append(range(given, given := given + FRAME + own.calls_law + len(own.numbers)))
        users = "function" in params
        counts = (
            len(force.laws), len(elements), sum([len(part.terms) for part in elements]), len(interactions),
            int(users), len(params["bodies"]) if users else 0, int(kind.of_reactions),
        )  # fmt: skip
        rows = [range(end, end + count) for end, count in zip(ends, counts, strict=True)]
        ends = [own.stop for own in rows]
        out[force.name] = ForceRows(force, markers, elements, interactions, blocks, *rows)
    return out


def terms_of(elements: Sequence[Element]) -> list[Term]:
    """Return the terms of elements in the order of packing."""
    return [addend for element in elements for addend in element.terms]


def made_of_masses(packed: Packed) -> list[str]:
    """Return the names of the forces whose numbers change with masses of bodies."""
    masses = packed.masses
    other = masses._replace(mass=2.0 * masses.mass + 1.0, inertia=2.0 * masses.inertia + 1.0)

    def numbers(force: Force, of: Masses) -> list[list[float]]:
        return [list(interaction.numbers) for interaction in force.kind.interactions(force, of)]

    return [force.name for force in packed.forces if numbers(force, masses) != numbers(force, other)]


def numbers_of(force: Force, masses: Masses) -> list[Any]:
    """Return a, b and c of all terms of a force, then its interactions' numbers, in packing order."""
    out = [value for addend in terms_of(force.kind.elements(force)) for value in (addend.a, addend.b, addend.c)]
    return out + [value for interaction in force.kind.interactions(force, masses) for value in interaction.numbers]
