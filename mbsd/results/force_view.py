"""Results of a force along a motion: wrenches, points of action, what it measures, power.

effort > 0 makes the measured value grow: it pushes points apart, turns the second body counter-clockwise,
pushes along the axis, opens the gap;  power = effort * rate where the force is nothing but its effort
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting
from mbsd.results.views import Wrench

UNITS: Mapping[str, str] = {"length": "m", "angle": "rad", "coordinate": "m", "gap": "m"}
"""Units of what a force may measure."""


@dataclass(frozen=True)
class Action(Wrench):
    """The action of a force on one body."""

    body: str


@dataclass(frozen=True)
class ForceView(Suggesting):
    """Force along a motion, (T, ...) arrays; x, y, fx, fy, force and torque are on the second body.

    So is the magnitude.

    A load from outside acts on one body, which is the second. One that acts on several bodies (a user's function, a
    rotating frame) has no second body: ask ``on(body)``.
    """

    name: str
    kind: str
    bodies: tuple[str, ...]
    """Bodies that feel it: first and second of a pair, else those on which it acts."""
    points: np.ndarray
    """(T, bodies, 2) where it acts on each (m, world)."""
    wrenches: np.ndarray
    """(T, bodies, 3) fx, fy (N, world axes) and torque (N m) about the point, on each."""
    power: np.ndarray
    """(T,) what it gives to the motion (W); negative where it takes."""
    potential: np.ndarray
    """(T,) potential energy (J) that it holds; 0 of a force without."""
    measures: str | None
    """``length``, ``angle`` (second body against first), ``coordinate`` (along the x axis of marker i), ``gap`` (of a
    contact or tyre, negative where pressed in), or None: there is no one such value."""
    value: np.ndarray | None
    """(T,) what it measures (m or rad); None where ``measures`` is None."""
    rate: np.ndarray | None
    """(T,) of the value (m/s or rad/s); of a load in one direction the speed of its point that way; else None."""
    effort: np.ndarray | None
    """(T,) its size with a sign (N or N m): positive where it makes the value grow, or acts in its direction; of a
    contact or tyre the normal force, without friction. None where neither value nor direction is one."""
    several: bool = False
    """True if it acts on several bodies, none of which is the second."""

    def on(self, body: str) -> Action:
        """Return its action on the body of this name. Raises ModelError for one that does not feel it."""
        if body not in self.bodies:
            raise ModelError(f"force '{self.name}' does not act on '{body}'; it acts on: {', '.join(self.bodies)}")
        return self._action(self.bodies.index(body))

    @property
    def second(self) -> Action:
        """Its action on the second body. Raises ModelError for one without."""
        if self.several:
            raise ModelError(
                f"force '{self.name}' ({self.kind}) acts on {', '.join(self.bodies)} and has no second body; "
                f"ask sol.force('{self.name}').on(body)"
            )
        return self._action(len(self.bodies) - 1)

    @property
    def x(self) -> np.ndarray:
        """(T,) of its point on the second body (m)."""
        return self.second.x

    @property
    def y(self) -> np.ndarray:
        """(T,) of its point on the second body (m)."""
        return self.second.y

    @property
    def fx(self) -> np.ndarray:
        """(T,) on the second body (N)."""
        return self.second.fx

    @property
    def fy(self) -> np.ndarray:
        """(T,) on the second body (N)."""
        return self.second.fy

    @property
    def force(self) -> np.ndarray:
        """(T, 2) on the second body, world axes (N)."""
        return self.second.force

    @property
    def torque(self) -> np.ndarray:
        """(T,) on the second body about (x, y) (N m)."""
        return self.second.torque

    @property
    def magnitude(self) -> np.ndarray:
        """(T,) of the force (N), never negative; the sign is that of ``effort``."""
        return self.second.magnitude

    @property
    def length(self) -> np.ndarray:
        """(T,) distance of its points (m). Raises ModelError for a force that measures another value or none."""
        return self._measured("length")

    @property
    def angle(self) -> np.ndarray:
        """(T,) of the second body against the first (rad). Raises ModelError as ``length`` does."""
        return self._measured("angle")

    @property
    def coordinate(self) -> np.ndarray:
        """(T,) of marker j along the x axis of marker i (m). Raises ModelError as ``length`` does."""
        return self._measured("coordinate")

    @property
    def gap(self) -> np.ndarray:
        """(T,) between disc and surface (m), negative where pressed in. Raises ModelError as ``length`` does."""
        return self._measured("gap")

    def columns(self, title: str) -> dict[str, np.ndarray]:
        """Return its results as (T,) arrays named with units: ``spring.fx [N]``, ``wind on cart.fx [N]``.

        The body is named if there are several.
        """
        out: dict[str, np.ndarray] = {}
        if self.measures is not None and self.value is not None:
            out[f"{title}.{self.measures} [{UNITS[self.measures]}]"] = self.value
        if self.effort is not None:
            out[f"{title}.effort [{'N m' if self.measures == 'angle' else 'N'}]"] = self.effort
        for action in [self.on(body) for body in self.bodies] if self.several else [self.second]:
            whole = f"{title} on {action.body}" if self.several else title
            out |= {f"{whole}.fx [N]": action.fx, f"{whole}.fy [N]": action.fy, f"{whole}.torque [N m]": action.torque}
        return out | {f"{title}.power [W]": self.power}

    def _action(self, k: int) -> Action:
        point, wrench = self.points[..., k, :], self.wrenches[..., k, :]
        return Action(point[..., 0], point[..., 1], wrench[..., 0], wrench[..., 1], wrench[..., 2], self.bodies[k])

    def _measured(self, what: str) -> np.ndarray:
        if self.measures != what or self.value is None:
            has = f"has {_article(self.measures)}" if self.measures else "measures no one value"
            raise ModelError(f"force '{self.name}' ({self.kind}) {has}, not {_article(what)}")
        return self.value


def _article(what: str) -> str:
    return f"an {what}" if what[0] in "aeiou" else f"a {what}"
