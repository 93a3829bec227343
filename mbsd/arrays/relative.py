"""Constraints of relative pose as arrays, and the functions of the user among them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.model.joint import SPECIALS, Joint

if TYPE_CHECKING:
    from mbsd.compiling.callback import Callback
    from mbsd.equations.system import System


FIRST_OWN = 4
"""Numbers of a special constraint that every equation has, before its own."""


@dataclass
class Specials:
    """The special constraints of a mechanism in the order of the table ``System.special``."""

    mechanism: str
    names: list[str] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    places: list[tuple[int, int, int, int]] = field(default_factory=list)
    """Marker i, marker j, row, motion."""
    callbacks: list[Callback] = field(default_factory=list)
    """Functions of the user; kept alive here."""

    def add(self, constraint: str, joint: Joint, place: tuple[int, int, int, int]) -> None:
        """Add a constraint of relative pose."""
        self.names.append(constraint)
        self.joints.append(joint)
        self.places.append(place)

    @property
    def angular_rows(self) -> list[int]:
        """Rows whose residual is an angle."""
        entries = zip(self.names, self.joints, self.places, strict=True)
        return [place[2] for name, joint, place in entries if joint.params.get("unit", SPECIALS[name].unit) == "rad"]

    @property
    def phased(self) -> list[int]:
        """Entries whose constant comes from the start pose."""
        return [k for k, name in enumerate(self.names) if SPECIALS[name].phased]

    def arrays(self, marker_body: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the table (k, 7), addresses (k,) and all numbers, for System; ``size`` of the mechanism (m)."""
        if not self.names:
            return np.zeros((0, 7), np.int64), np.zeros(0, np.int64), np.zeros(0)
        from mbsd.equations.relative.equation import address_of

        rows, numbers, at = [], [], 0
        for joint, place in zip(self.joints, self.places, strict=True):
            own = self._own_numbers(joint, place, size)
            block = [joint.j.angle - joint.i.angle, 0.0, 0.0, 1.0, *own]
            rows.append((*place, at, marker_body[place[0]], 1))
            numbers.append(block)
            at += len(block)
        addresses = [address_of(SPECIALS[name].equation) for name in self.names]
        return np.array(rows, np.int64), np.array(addresses, np.int64), np.concatenate(numbers)

    def _own_numbers(self, joint: Joint, place: tuple[int, int, int, int], size: float) -> list[float]:
        if "function" in joint.params:
            from mbsd.arrays.user_constraint import derivatives

            self.callbacks.append(
                derivatives(joint.params["function"], f"{self.mechanism}: joint '{joint.name}'", size)
            )
            return [float(self.callbacks[-1].address), size]
        nth = sum(1 for other in self.places if other[:2] == place[:2] and other[2] < place[2])
        assert joint.kind.numbers is not None
        return [float(number) for number in joint.kind.numbers(joint.params)[nth]]

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields without functions, whose addresses are of this process; see :meth:`connected`."""
        return self.__dict__ | {"callbacks": []}

    def connected(self, system: System, size: float) -> System:
        """Return a system that came from elsewhere, with the addresses of this process."""
        if not self.names:
            return system
        from mbsd.equations.relative.equation import AT, address_of

        numbers = system.numbers.copy()
        for joint, place, row in zip(self.joints, self.places, system.special, strict=True):
            if "function" in joint.params:
                own = self._own_numbers(joint, place, size)
                numbers[row[AT] + FIRST_OWN : row[AT] + FIRST_OWN + len(own)] = own
        address = np.array([address_of(SPECIALS[name].equation) for name in self.names], np.int64)
        return system.changed(numbers=numbers, address=address)

    def callback(self, what: str, make: Callable[[str], Callback]) -> Callback:
        """Return the function of the user that errors call ``what``: made once, and kept."""
        for made in self.callbacks:
            if made.what == what:
                return made
        self.callbacks.append(make(what))
        return self.callbacks[-1]

    def check(self) -> None:
        """Raise what a user's function raised since the last check."""
        for callback in self.callbacks:
            callback.check()

    def check_trials(self, before: float = math.inf) -> None:
        """Check functions, but forget overflows and the like before a time (s) that was accepted."""
        for callback in self.callbacks:
            callback.forget(before)
            callback.check()
