"""Views of a solution: a frame, a joint, a driver and energy, (T,) arrays in SI units; its residuals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.results.shown_view import ShownView


@dataclass(frozen=True, repr=False)
class FrameView(ShownView):
    """Motion of a frame: (T,) arrays, m and rad by s."""

    x: np.ndarray
    y: np.ndarray
    theta: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    omega: np.ndarray
    ax: np.ndarray
    ay: np.ndarray
    alpha: np.ndarray


@dataclass(frozen=True, repr=False)
class Wrench(ShownView):
    """A force and a torque on a body, (T,) arrays: N along the world's axes, N m about the point (m)."""

    x: np.ndarray
    y: np.ndarray
    fx: np.ndarray
    fy: np.ndarray
    torque: np.ndarray

    @property
    def force(self) -> np.ndarray:
        """(T, 2) world axes (N)."""
        return np.stack([self.fx, self.fy], axis=-1)

    @property
    def magnitude(self) -> np.ndarray:
        """(T,) of the force (N), never negative."""
        return np.hypot(self.fx, self.fy)


@dataclass(frozen=True, repr=False)
class JointView(Wrench):
    """The wrench of a joint on its second body, at its second marker."""

    acts: Wrench
    """The same at the place where it acts: beside the marker where wheels, cams or curves touch; the torque is that
    about this place."""

    @property
    def place(self) -> np.ndarray:
        """(T, 2) where it acts, world (m)."""
        return np.stack([self.acts.x, self.acts.y], axis=-1)

    @property
    def reaction(self) -> np.ndarray:
        """(T, 2) force on the second body, world axes (N)."""
        return self.force


@dataclass(frozen=True, repr=False)
class DriverView(ShownView):
    """A driver: imposed value and its rates (m or rad by s), effort (N or N m), power (W), (T,) arrays."""

    name: str
    angular: bool
    value: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray
    effort: np.ndarray

    @property
    def power(self) -> np.ndarray:
        """(T,) effort times rate: what the driver puts into the mechanism."""
        return self.effort * self.rate

    @property
    def torque(self) -> np.ndarray:
        """(T,) the effort of an angle driver (N m)."""
        if not self.angular:
            raise ModelError(f"driver '{self.name}' imposes a length: it has a force, not a torque")
        return self.effort

    @property
    def force(self) -> np.ndarray:
        """(T,) the effort of a length driver (N)."""
        if self.angular:
            raise ModelError(f"driver '{self.name}' imposes an angle: it has a torque, not a force")
        return self.effort


@dataclass(frozen=True, repr=False)
class EnergyView(ShownView):
    """(T,) J."""

    kinetic: np.ndarray
    potential: np.ndarray

    @property
    def total(self) -> np.ndarray:
        """(T,) J."""
        return self.kinetic + self.potential


@dataclass(frozen=True)
class Stats:
    """How well the motion fulfils its equations: largest residuals over all times and rows."""

    position_residual: float
    """|Phi| of joints, drivers and closed contacts (m or rad); what sticks by friction has no position to keep."""
    velocity_residual: float
    """|J v - nu| (m/s or rad/s)."""
    acceleration_residual: float
    """|J a - gamma| (m/s^2 or rad/s^2)."""
    power_residual: float
    """|d(T + V)/dt - power of the drivers| (W)."""
    steps: int
    inserted_steps: int
    """Steps added between outputs to stay on the branch."""
    independent: bool = False
    """Whether a simulation was integrated in independent coordinates (mbsd/dynamics/independent)."""
