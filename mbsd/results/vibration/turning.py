"""A vector in the plane that swings harmonically: one part turns with the crank, one against it.

fx + i fy = forward e^(i k phi) + backward e^(-i k phi)        an ellipse; k its order, phi the crank's angle
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Turning:
    """Both parts of harmonic vectors, (K,) complex: real part along x, imaginary part along y at phi = 0."""

    forward: np.ndarray
    """(K,) turns with the crank."""
    backward: np.ndarray
    """(K,) turns against the crank."""

    @property
    def largest(self) -> np.ndarray:
        """(K,) size where the vector is largest on the turn."""
        return np.abs(self.forward) + np.abs(self.backward)

    @property
    def smallest(self) -> np.ndarray:
        """(K,) size where the vector is smallest on the turn; 0 where it swings along a line."""
        return np.abs(np.abs(self.forward) - np.abs(self.backward))

    @property
    def along_x(self) -> np.ndarray:
        """(K,) amplitude of the component along x."""
        return np.abs(self.forward + self.backward.conj())

    @property
    def along_y(self) -> np.ndarray:
        """(K,) amplitude of the component along y."""
        return np.abs(self.forward - self.backward.conj())
