"""Which pins hang the bodies on one another as a tree from the ground, and which ones close its loops."""

from __future__ import annotations

from benchmarks.dynamics.pins import GROUND, Pin, Pinned


def spanning_tree(model: Pinned) -> tuple[dict[int, tuple[int, Pin]], list[Pin]]:
    """The parent of each body and the pin between them, parents first; and the pins left over."""
    parents: dict[int, tuple[int, Pin]] = {}
    waiting = list(model.pins)
    reached = [GROUND]
    for body in reached:
        for pin in list(waiting):
            if body not in (pin.i, pin.j):
                continue
            child = pin.j if body == pin.i else pin.i
            if child != GROUND and child not in parents:
                parents[child] = body, pin
                reached.append(child)
                waiting.remove(pin)
    return parents, waiting
