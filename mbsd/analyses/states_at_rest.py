"""Forces with states of their own, such as pressures, have no force that follows from a pose."""

from __future__ import annotations

from mbsd.base.errors import ModelError
from mbsd.model.mechanism import Model


def refuse_states(m: Model, what: str) -> None:
    """Raise ModelError where a force carries states; ``what`` would have to know them."""
    for force in m.forces.values():
        if force.kind.states is not None:
            raise ModelError(
                f"{m.name}: force '{force.name}' ({force.kind.name}) carries {' and '.join(force.kind.states.names)}, "
                f"which no pose tells, and {what} looks at poses alone. Simulate until it rests, or put "
                f"m.distance(...) of its length or m.actuator(...) of its force in its place"
            )
