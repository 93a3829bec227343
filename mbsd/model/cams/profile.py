"""The disc of a cam: what it looks like, how it presses, and the numbers for its joint.

Undercut: where a roller's pitch curve is bent tighter than the roller, or a flat face asks for a negative radius of
curvature, the outline crosses itself; cutting it takes away what the follower needs, and the lift is lost.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.model.cams.lift import Lift

STEEP = {"translating": math.radians(30), "oscillating": math.radians(45)}
"""Pressure angles beyond which a follower is said to jam. Source: Norton, Design of Machinery, ch. 8."""


@dataclass(frozen=True, eq=False)
class CamProfile:
    """Disc cam for one follower, turning counter-clockwise; (N,) arrays over one turn, in its frame.

    Made by roller_cam, flat_cam, oscillating_roller_cam and oscillating_flat_cam.
    """

    follower: str
    """roller, flat, oscillating_roller or oscillating_flat."""
    lift: Lift
    sizes: Mapping[str, float]
    """Radii and distances as they were given (m)."""
    angle: np.ndarray
    """Angle of the cam (rad)."""
    pitch: np.ndarray
    """(N, 2) the roller's centre (m); for a flat face the same as the outline."""
    outline: np.ndarray
    """(N, 2) the disc's edge where it touches (m)."""
    pressure_angle: np.ndarray
    """Between the common normal and the way the follower moves there (rad), signed."""
    curvature_radius: np.ndarray
    """Radius of curvature of the outline (m): positive where it is convex, infinite where it is straight."""
    numbers: np.ndarray
    """Numbers of the joint's constraint."""

    @property
    def flat(self) -> bool:
        """True if the follower has a flat face."""
        return self.follower.endswith("flat")

    @property
    def undercut(self) -> bool:
        """True if the outline crosses itself, so that the lift cannot be cut."""
        return bool(self._undercut.any())

    @property
    def largest_pressure_angle(self) -> float:
        """rad."""
        return float(np.abs(self.pressure_angle).max())

    @property
    def problems(self) -> list[str]:
        """Return the faults of this cam, with remedies; empty if it can be made and should run."""
        faults = []
        if self.undercut:
            where = np.degrees(self.angle[self._undercut])
            remedy = "" if self.flat else " or a smaller roller"
            faults.append(
                f"the outline is undercut between cam angles {where.min():.4g} and {where.max():.4g} degrees; take a "
                f"larger base circle{remedy}"
            )
        limit = STEEP["oscillating" if self.follower.startswith("oscillating") else "translating"]
        if self.largest_pressure_angle > limit:
            at = math.degrees(self.angle[int(np.argmax(np.abs(self.pressure_angle)))])
            faults.append(
                f"the pressure angle reaches {math.degrees(self.largest_pressure_angle):.4g} degrees at cam angle "
                f"{at:.4g}, above {math.degrees(limit):.4g}; take a larger base circle or a longer rise"
            )
        return faults

    @property
    def data(self) -> dict[str, Any]:
        """Plain data, from which mbsd.model.cams.cam_from makes the same cam."""
        return {"follower": self.follower, "lift": self.lift.data, **self.sizes}

    @property
    def _undercut(self) -> np.ndarray:
        if self.flat:
            return self.curvature_radius <= 0
        pitch_radius = self.curvature_radius + self.sizes["roller_radius"]
        return (pitch_radius > 0) & (self.curvature_radius <= 0)
