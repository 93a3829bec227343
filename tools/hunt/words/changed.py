"""A number of a mechanism changed and changed back, with a solution between."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd import Mechanism
from tools.hunt.outcome import attempt


def there_and_back(m: Mechanism, rng: np.random.Generator, solve: Callable[[], Any]) -> bool:
    """Change a random number by up to a half, solve whatever comes of it, change it back; False if there is none."""
    changes: list[tuple[str, str, float]] = []
    for name, body in m.bodies.items():
        if name != "ground" and body.mass > 0:
            changes += [(name, "mass", body.mass), (name, "inertia", body.inertia)]
    for table in (m.joints, m.drivers, m.forces, m.contacts):
        for name, entry in table.items():
            changes += [
                (name, key, value)
                for key, value in entry.params.items()
                if isinstance(value, float) and value > 0 and key != "direction"
            ]
    if not changes:
        return False
    name, key, value = changes[int(rng.integers(len(changes)))]
    _, error = attempt(lambda: m.change(name, **{key: value * float(rng.uniform(0.6, 1.4))}))
    if error is None:
        attempt(solve)
        m.change(name, **{key: value})
    return True
