"""The crank of a motion: what turns round and round on ground, by whose angle engineers draw everything else."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shared.contract import Motion

WHOLE = 1e-6
"""Turns: what misses a whole number by less is one."""


@dataclass(frozen=True)
class Crank:
    """A body that a revolute joint holds on ground and that turns one way from row ``first`` on."""

    body: str
    angle: np.ndarray
    """(T,) turned since the start, counted positive in the direction of the last turn (rad)."""
    first: int
    at: tuple[float, float]
    """Its axis (m)."""

    @property
    def turns(self) -> int:
        """Whole turns from ``first`` on."""
        return int((self.angle[-1] - self.angle[self.first]) / (2 * np.pi) + WHOLE)


def crank_of(motion: Motion) -> Crank | None:
    """The crank; of several the one that a driver turns, else the first in the file. None where nothing turns so."""
    cranks = [crank for body, at in _on_ground(motion).items() if (crank := _crank(motion, body, at)) is not None]
    driven = driven_bodies(motion)
    return min(cranks, key=lambda crank: crank.body not in driven, default=None)


def driven_bodies(motion: Motion) -> set[str]:
    """Bodies that drivers act between, without ground."""
    return {body for driver in motion.drivers.values() for body in driver.bodies or () if body != "ground"}


def _on_ground(motion: Motion) -> dict[str, tuple[float, float]]:
    """Bodies that revolute joints hold on ground, with the axis."""
    pins: dict[str, tuple[float, float]] = {}
    for joint in motion.joints.values():
        if joint.pair == "pin" and "ground" in joint.bodies:
            for body in joint.bodies:
                if body != "ground":
                    pins.setdefault(body, (joint.x[0], joint.y[0]))
    return pins


def _crank(motion: Motion, body: str, at: tuple[float, float]) -> Crank | None:
    angle = np.asarray(motion.bodies[body].theta)
    steps = np.diff(angle) * (1.0 if angle[-1] >= angle[len(angle) // 2] else -1.0)
    back = np.flatnonzero((steps <= 0) & (np.diff(motion.time) > 0))
    crank = Crank(
        body,
        np.abs(angle - angle[0]) if not len(back) else np.concatenate([[0.0], np.cumsum(steps)]),
        int(back[-1]) + 1 if len(back) else 0,
        at,
    )
    return crank if crank.turns else None
