"""Result of ``parts()``: the solids of each body, and facts about bodies beyond their solids."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from shared.shapes.solid import Solid, at_scale
from shared.stage.errors import UserError

type Place = tuple[str, float, float]
"""A body, x, y (mm) in its frame."""


class Bodies(dict[str, list[Solid]]):
    """Solids by body, as a dict; the first of each list is the body's main piece.

    A plain dict does where nothing else is to be said::

        made = Bodies(ground=[...], cam=[...], follower=[...])
        made.may_touch("cam", "follower")
        made.pieces_may_touch("tyre", "road")
        made.leave_out("string")
        made.dress("ground", Solid("block", ...))  # what the machine works on
        made.join_places("rod", ("cam", 10.0, 0.0), ("follower", 0.0, -5.0))  # made["rod"] is between them
        made.mount = ("stand", (0.0, 1.0, 0.0))  # how ground stands, and what points up; else it lies on a desk
        made.along = True  # heights of the solids are places z of mechanism.py: masses have them, too
        return made

    ``made | {...}`` keeps what was said.
    """

    def __init__(self, *args: Mapping[str, list[Solid]], **bodies: list[Solid]) -> None:
        super().__init__(*args, **bodies)
        self.along = False
        """True if heights of the solids are the places z of the model, so that what masses have along z counts."""
        self.space = False
        """True of a mechanism in space: masses have their whole inertia."""
        self.links: dict[str, tuple[str, str, tuple[float, float, float]]] = {}
        """Joint in space whose massless link each of these is, the body to which its z axis is nearly fixed, and where
        that axis points in the body's frame (shared/contract/parts.py)."""
        self.stand: Callable[[Mapping[str, list[Solid]]], list[Solid]] | None = None
        """Makes the solids of ground with a stand, once all solids are there; None where ground has what it needs."""
        self.mount: tuple[str, tuple[float, float, float]] | None = None
        """Kind and up of shared/contract/parts.py: how ground stands in the world; None where nobody says."""
        self.schematic = ""
        """Sentence on plates that may overlap, which are shown and not built; empty for parts that can be built."""
        self.notes: list[str] = []
        """Sentences for the user, which the parts stage prints."""
        self._touching: set[tuple[str, str]] = set()
        self._pieces_touching: set[tuple[str, str]] = set()
        self._left_out: set[str] = set()
        self._rods: dict[str, tuple[Place, Place]] = {}

    def may_touch(self, first: str, second: str) -> None:
        """Let solids of these two bodies touch: the clearance stage does not compare them.

        Raises UserError where both are one.
        """
        self._touching.add(pair_of(first, second))

    def pieces_may_touch(self, first: str, second: str) -> None:
        """Let two solids of different bodies, by their names, touch; others are still compared.

        Raises UserError where both are one.
        """
        self._pieces_touching.add(pair_of(first, second, "pieces_may_touch", "solid"))

    def dress(self, body: str, *solids: Solid) -> None:
        """Add solids (mm, the frame of ``body``) that show the workpiece or surroundings of the machine.

        ``body`` is ground or a body that moves.

        They are made, proven clear and filmed as all others, but are none of its mass: a load, a cup on a table. Raises
        UserError for a body that has no solids yet, whose main piece they would be.
        """
        if not self.get(body):
            raise UserError(f"dress('{body}'): it has no solids to dress; there are: {', '.join(self)}")
        self[body] = [*self[body], *(replace(solid, dressing=True) for solid in solids)]

    def leave_out(self, body: str) -> None:
        """Leave ``body`` of mechanism.py without solids; its mass is estimated unless given there."""
        self._left_out.add(body)

    def join_places(self, rod: str, first: Place, second: Place) -> None:
        """Let the solids of ``rod``, no body of mechanism.py, join two places.

        Each place is (body, x, y), in mm in its frame.

        They are drawn with their origin on the first place and the x axis towards the second. Raises UserError where
        both are one.
        """
        if first == second:
            raise UserError(f"join_places('{rod}'): both ends are {first}; name two places")
        self._rods[rod] = first, second

    def at_scale(self, ratio: float) -> Bodies:
        """Return a model of all bodies, ``ratio`` times as large."""
        made = self | {body: [at_scale(solid, ratio) for solid in solids] for body, solids in self.items()}
        made._rods = {
            rod: ((first, x * ratio, y * ratio), (second, u * ratio, v * ratio))
            for rod, ((first, x, y), (second, u, v)) in self._rods.items()
        }
        return made

    def on_stand(self) -> Bodies:
        """Return the bodies with a stand under all of them; the parts stage adds it to ``parts()``."""
        if self.stand is None:
            return self
        stood = self | {"ground": self.stand(self)}
        stood.stand = None
        return stood

    @property
    def rods(self) -> dict[str, tuple[Place, Place]]:
        """Two places that each rod joins, by its name."""
        return dict(self._rods)

    @property
    def touching(self) -> frozenset[tuple[str, str]]:
        """Pairs of bodies that may touch, each in the order of the alphabet."""
        return frozenset(self._touching)

    @property
    def pieces_touching(self) -> frozenset[tuple[str, str]]:
        """Pairs of solids that may touch, each in the order of the alphabet."""
        return frozenset(self._pieces_touching)

    @property
    def left_out(self) -> frozenset[str]:
        """Bodies without solids."""
        return frozenset(self._left_out)

    def __or__(self, other: Mapping[str, list[Solid]]) -> Bodies:  # pyright: ignore[reportIncompatibleMethodOverride]
        joined = Bodies(self)
        joined.update(other)
        for operand in (self, other):
            if isinstance(operand, Bodies):
                joined._touching |= operand.touching
                joined._pieces_touching |= operand.pieces_touching
                joined._left_out |= operand.left_out
                joined._rods |= operand.rods
                joined.along |= operand.along
                joined.space |= operand.space
                joined.links |= operand.links
                joined.schematic = joined.schematic or operand.schematic
                joined.notes = list(dict.fromkeys([*joined.notes, *operand.notes]))
                joined.mount = joined.mount or operand.mount
                joined.stand = joined.stand or operand.stand
        return joined

    def __ror__(self, other: Mapping[str, list[Solid]]) -> Bodies:  # pyright: ignore[reportIncompatibleMethodOverride]
        return Bodies(other) | self


def pair_of(first: str, second: str, wish: str = "may_touch", what: str = "body") -> tuple[str, str]:
    """Return two bodies, or two solids, in the order of the alphabet.

    Raises UserError if both are one.
    """
    if first == second:
        both = {"body": "bodies"}.get(what, f"{what}s")
        raise UserError(f"{wish}('{first}', '{second}'): a {what} may touch itself anyway; name two {both}")
    return (first, second) if first < second else (second, first)
