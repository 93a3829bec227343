"""Where markers are along given poses, for potentials of forces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd.model.body import Marker
    from mbsd.model.force import Masses


def marker_place(marker: Marker, masses: Masses, q: np.ndarray) -> np.ndarray:
    """(T, 2) of a marker (m) at poses q (T, 3 nb)."""
    b = list(masses.names).index(marker.body.name)
    x, y = marker.x - masses.com[b, 0], marker.y - masses.com[b, 1]
    c, s = np.cos(q[:, 3 * b + 2]), np.sin(q[:, 3 * b + 2])
    return q[:, 3 * b : 3 * b + 2] + np.stack([c * x - s * y, s * x + c * y], axis=1)
