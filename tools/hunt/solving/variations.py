"""Where variations of a case stand by name."""

from __future__ import annotations

from collections.abc import Callable

from tools.hunt.outcome import Outcome


class Variations[Case](dict[str, Callable[[Case], Outcome]]):
    """By name, in the order in which they are run."""

    def enter(self, name: str) -> Callable[[Callable[[Case], Outcome]], Callable[[Case], Outcome]]:
        """Decorates a variation, which takes a case and gives its outcome."""

        def entered(run: Callable[[Case], Outcome]) -> Callable[[Case], Outcome]:
            self[name] = run
            return run

        return entered
