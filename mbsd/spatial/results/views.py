"""Views of a solution in space: a frame and a joint. Arrays are (T, ...) in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting
from mbsd.spatial.model.rotation import rotation_matrix


@dataclass(frozen=True, eq=False)
class FrameView(Suggesting):
    """Motion of a frame of a body."""

    other_words = MappingProxyType(
        {"position": "place", "quaternion": "orientation", "omega": "w", "angular_velocity": "w", "v": "velocity"}
        | {"a": "acceleration", "angular_acceleration": "alpha"}
    )

    place: np.ndarray
    """(T, 3) in the world (m)."""
    orientation: np.ndarray
    """(T, 4) Euler parameters (w, x, y, z) from the frame to the world, their signs continuous."""
    velocity: np.ndarray
    """(T, 3) m/s"""
    w: np.ndarray
    """(T, 3) angular velocity in the world (rad/s)."""
    acceleration: np.ndarray
    """(T, 3) m/s^2"""
    alpha: np.ndarray
    """(T, 3) angular acceleration in the world (rad/s^2)."""

    @cached_property
    def rotation(self) -> np.ndarray:
        """Rotations (T, 3, 3) from the frame to the world."""
        return rotation_matrix(self.orientation)

    @property
    def x(self) -> np.ndarray:
        """(T,) m"""
        return self.place[..., 0]

    @property
    def y(self) -> np.ndarray:
        """(T,) m"""
        return self.place[..., 1]

    @property
    def z(self) -> np.ndarray:
        """(T,) m"""
        return self.place[..., 2]

    @property
    def w_body(self) -> np.ndarray:
        """(T, 3) angular velocity in the axes of the frame (rad/s)."""
        return np.einsum("tji,tj->ti", self.rotation, self.w)


@dataclass(frozen=True, eq=False)
class JointView(Suggesting):
    """Place and reaction of a joint: force and moment on its second body, about ``place``."""

    other_words = MappingProxyType({"reaction": "force", "torque": "moment", "angle": "turn"})

    name: str
    kind: str
    place: np.ndarray
    """(T, 3) of the second body's marker, in the world (m)."""
    axes: np.ndarray
    """(T, 3, 3) axes x, y, z of the first body's marker by column, in the world."""
    force: np.ndarray
    """(T, 3) in the world (N)."""
    moment: np.ndarray
    """(T, 3) in the world (N m)."""
    turns: tuple[np.ndarray, np.ndarray, np.ndarray] | None
    """(T,) rad, rad/s, rad/s^2 about the axis; None of joints without a turn."""
    slides: tuple[np.ndarray, np.ndarray, np.ndarray] | None
    """(T,) m, m/s, m/s^2 along the axis; None of joints without a slide."""

    @property
    def axis(self) -> np.ndarray:
        """(T, 3) the joint's axis, in the world."""
        return self.axes[:, :, 2]

    @property
    def local_force(self) -> np.ndarray:
        """(T, 3) force in the joint's axes x, y, z (N)."""
        return np.einsum("tij,ti->tj", self.axes, self.force)

    @property
    def local_moment(self) -> np.ndarray:
        """(T, 3) moment in the joint's axes x, y, z (N m)."""
        return np.einsum("tij,ti->tj", self.axes, self.moment)

    @property
    def along(self) -> np.ndarray:
        """(T,) force along the joint's axis (N)."""
        return self.local_force[:, 2]

    @property
    def magnitude(self) -> np.ndarray:
        """(T,) size of the force (N)."""
        return np.linalg.norm(self.force, axis=1)

    @property
    def turn(self) -> np.ndarray:
        """(T,) turn of the second body about the axis, counted from the design pose (rad)."""
        return self._measure(self.turns, "turn")[0]

    @property
    def turn_rate(self) -> np.ndarray:
        """(T,) rad/s"""
        return self._measure(self.turns, "turn")[1]

    @property
    def turn_acceleration(self) -> np.ndarray:
        """(T,) rad/s^2"""
        return self._measure(self.turns, "turn")[2]

    @property
    def slide(self) -> np.ndarray:
        """(T,) slide of the second body along the axis, 0 in the design pose (m)."""
        return self._measure(self.slides, "slide")[0]

    @property
    def slide_rate(self) -> np.ndarray:
        """(T,) m/s"""
        return self._measure(self.slides, "slide")[1]

    @property
    def slide_acceleration(self) -> np.ndarray:
        """(T,) m/s^2"""
        return self._measure(self.slides, "slide")[2]

    def _measure(
        self, values: tuple[np.ndarray, np.ndarray, np.ndarray] | None, what: str
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        if values is None:
            raise ModelError(f"joint '{self.name}' is {self.kind} and has no {what}")
        return values

    def __repr__(self) -> str:
        return f"<{self.kind} '{self.name}': {len(self.place)} outputs, force up to {self.magnitude.max():.4g} N>"
