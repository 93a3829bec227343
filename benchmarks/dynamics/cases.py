"""The dynamics problems by name, in one shape for every code and for the table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.dynamics import chain, n_four_bar, pendulum, squeezer
from benchmarks.dynamics.pins import Pinned, Record


@dataclass(frozen=True)
class Case:
    """A problem; ``limits`` and ``errors`` go by the same names.

    ``bar``: times our time the best peer takes at least.
    """

    name: str
    model: Pinned
    duration: float
    limits: dict[str, float]
    bar: float
    errors: Callable[[Record], dict[str, float]]

    def met(self, errors: dict[str, float]) -> bool:
        """Return True if all errors are within their limits."""
        return all(errors[name] <= limit for name, limit in self.limits.items())

    def excess(self, errors: dict[str, float]) -> float:
        """The worst error as a multiple of its limit."""
        return max(errors[name] / limit for name, limit in self.limits.items())


def _n_four_bar(loops: int) -> Case:
    return Case(
        n_four_bar.name(loops), n_four_bar.model(loops), n_four_bar.DURATION, n_four_bar.LIMITS, n_four_bar.BAR,
        lambda record: n_four_bar.errors(loops, record),
    )  # fmt: skip


def case(name: str) -> Case:
    """Return a problem by its name, as "A02 N=10" with any number of loops.

    The others are "A01 pendulum", "A03 squeezer" and "chain of 100 links".
    """
    if name.startswith("A02 N="):
        return _n_four_bar(int(name.removeprefix("A02 N=")))
    module = {pendulum.NAME: pendulum, squeezer.NAME: squeezer, chain.NAME: chain}[name]
    return Case(name, module.model(), module.DURATION, module.LIMITS, module.BAR, module.errors)


BESIDE_PEERS = (pendulum.NAME, "A02 N=1", "A02 N=10", "A02 N=40", squeezer.NAME, chain.NAME)
ALONE = ("A02 N=40", "A02 N=400", "A02 N=4000")
"""Where only the growth of our own cost with the number of bodies is looked at."""
